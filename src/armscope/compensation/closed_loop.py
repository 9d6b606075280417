"""What models leave of the error: on the rows they were fitted to, on others, and on an arm that obeys them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.compensation.black_box import ErrorModel
from armscope.compensation.compensate import compensate_black_box, compensate_physical
from armscope.compensation.path import WantedPath, as_path
from armscope.compensation.physical import Identified
from armscope.compensation.result import Compensated
from armscope.compensation.task import Options
from armscope.core.types import Array
from armscope.physics.model import FittedModel, predict, predict_orientation
from armscope.recordings.columns import ERROR_COLUMNS, angle_columns
from armscope.recordings.table import unmeasured
from armscope.robot import Arm

NO_MODEL = "Uncompensated"  # The negative control: the nominal commands


@dataclass(frozen=True, eq=False)
class Corrector:
    """A model that predicts and compensates."""

    # tool points (N, 3), m, and orientations (N, 3, 3) at motor angles (N, m) rad, in the frame of the measurements
    tool_pose: Callable[[Array], tuple[Array, Array]]
    compensate: Callable[[WantedPath], Compensated]  # commands for a path in that frame


@dataclass(frozen=True, eq=False)
class MeasuredPath:
    """N points of a trajectory, measured at the nominal commands; base frame."""

    motor_angles: Array  # (N, m) nominal commands, rad
    wanted_mm: Array  # (N, 3) mm
    errors_mm: Array  # (N, 3) measured minus wanted


def black_box_candidate(model: ErrorModel, pose: bool = False) -> Corrector:
    """A black-box error model, which corrects full poses if asked; measurements stand in the arm's base frame."""
    return Corrector(model.tool_pose, lambda path: compensate_black_box(model, path, Options(pose=pose)))


def physical_candidate(model: FittedModel, identified: Identified, pose: bool = False) -> Corrector:
    """Diagnosed physics; measurements stand in the measurement frame that it was diagnosed in.

    Args:
        model: as diagnosed.
        identified: where.
        pose: full poses are corrected.

    Returns:
        It, to predict and to correct.
    """
    run, options = list(model.bases)[-1], Options(frame="measurement", pose=pose)

    def tool_pose(angles: Array) -> tuple[Array, Array]:
        rows = unmeasured(angles, run)
        return predict(model, rows), predict_orientation(model, rows)

    return Corrector(tool_pose, lambda path: compensate_physical(model, identified, path, options))


def remaining_errors(
    arm: Arm,
    candidates: Mapping[str, Corrector],
    identification: MeasuredPath,
    trajectories: Mapping[str, MeasuredPath],
    true_points: Callable[[Array], Array],
) -> pd.DataFrame:
    """What is left of the error at every point, by model, trajectory and stage.

    Args:
        arm: the nominal arm.
        candidates: models by name.
        identification: the rows that they were fitted to.
        trajectories: test paths by name.
        true_points: where the real arm's tool is, (N, 3) m, at commands (N, m) rad; without measurement noise.

    Returns:
        Columns model, trajectory, stage, point (from 1), dx_mm, dy_mm, dz_mm. Stages: "fit" (measured minus predicted
        on the identification rows), "prediction" (the same on a test path), "closed loop" (true points at the corrected
        commands minus wanted points; empty where the command was refused). The model "Uncompensated" gives the errors
        themselves; its closed loop is the true arm at the nominal commands.
    """
    parts = [vectors(NO_MODEL, "identification", "fit", identification.errors_mm)]
    for name, path in trajectories.items():
        parts.append(vectors(NO_MODEL, name, "prediction", path.errors_mm))
        parts.append(vectors(NO_MODEL, name, "closed loop", true_points(path.motor_angles) * 1e3 - path.wanted_mm))
    for model, candidate in candidates.items():
        parts.append(vectors(model, "identification", "fit", _left(candidate, identification)))
        for name, path in trajectories.items():
            parts.append(vectors(model, name, "prediction", _left(candidate, path)))
            result = candidate.compensate(_as_wanted(arm, path, name))
            error = np.full_like(path.wanted_mm, np.nan)
            error[result.reached] = true_points(result.commands[result.reached]) * 1e3 - path.wanted_mm[result.reached]
            parts.append(vectors(model, name, "closed loop", error))
    return pd.concat(parts, ignore_index=True)


def cross_table(left: pd.DataFrame) -> pd.DataFrame:
    """Model by trajectory by stage: the RMS of what is left of the error.

    Args:
        left: see `remaining_errors`.

    Returns:
        Columns model, trajectory, stage, axis ("x", "y", "z", "3D"), points, refused, rms_mm, rss_mm; points without a
        number are counted as refused and left out.
    """
    rows = []
    for (model, trajectory, stage), part in left.groupby(["model", "trajectory", "stage"], sort=False):
        rows += _rows(str(model), str(trajectory), str(stage), part[ERROR_COLUMNS].to_numpy())
    return pd.DataFrame(rows)


def _as_wanted(arm: Arm, path: MeasuredPath, name: str) -> WantedPath:
    """Points wanted on the branch of the nominal commands."""
    columns = angle_columns(path.motor_angles)
    columns |= {f"{axis}_mm": path.wanted_mm[:, n] for n, axis in enumerate("xyz")}
    return as_path(pd.DataFrame(columns), f"trajectory {name}", arm)


def _left(candidate: Corrector, path: MeasuredPath) -> Array:
    return path.wanted_mm + path.errors_mm - candidate.tool_pose(path.motor_angles)[0] * 1e3


def vectors(model: str, trajectory: str, stage: str, error_mm: Array) -> pd.DataFrame:
    """One part of `remaining_errors`'s table.

    Args:
        model: the model's name.
        trajectory: the trajectory's name.
        stage: before or after compensation, and by what.
        error_mm: (N, 3).

    Returns:
        One row per point.
    """
    keys = {"model": model, "trajectory": trajectory, "stage": stage, "point": np.arange(1, len(error_mm) + 1)}
    return pd.DataFrame(keys | dict(zip(ERROR_COLUMNS, error_mm.T, strict=True)))


def _rows(model: str, trajectory: str, stage: str, error_mm: Array) -> list[dict[str, object]]:
    known = np.isfinite(error_mm.sum(axis=1))
    by_axis = np.sum(error_mm[known] ** 2, axis=0)
    squares: Sequence[float] = [*by_axis, by_axis.sum()]
    count = int(known.sum())
    return [
        {
            "model": model,
            "trajectory": trajectory,
            "stage": stage,
            "axis": axis,
            "points": count,
            "refused": int(len(known) - count),
            "rms_mm": float(np.sqrt(total / count)) if count else float("nan"),
            "rss_mm": float(np.sqrt(total)) if count else float("nan"),
        }
        for axis, total in zip((*"xyz", "3D"), squares, strict=True)
    ]
