"""Where an arm will be: by a diagnosed model, by a black-box model, or by its description alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from armscope.core.inputs import InputError, read_yaml
from armscope.core.types import Array
from armscope.physics.model import FittedModel, predict_orientation
from armscope.physics.model import predict as predicted_points
from armscope.physics.model_file import load_model
from armscope.recordings import Recordings, read_recordings
from armscope.recordings.columns import AXES_MM, QUATERNION
from armscope.robot import load_arm, tool_frames
from armscope.robot.urdf_file import is_xml

if TYPE_CHECKING:
    import pandas as pd  # slow to import, and many a model is refused

    from armscope.compensation.physical import Identified

Found = tuple[Array, Array | None, Recordings, list[str]]
"""Points (N, 3), m, orientations (N, 3, 3), the rows they are of, and what a user should know."""


def predict_file(model: Path, poses: Path, pose: bool = False) -> tuple[pd.DataFrame, list[str]]:
    """The tool point by a file, in the measurement frame (by a robot.yaml or a URDF: in the base frame).

    Args:
        model: model.yaml, errormodel.json, robot.yaml or a URDF.
        poses: a table of motor angles and whatever context the model follows.
        pose: whether orientations come, too.

    Returns:
        Columns id, run, x_mm, y_mm, z_mm and, if asked for, qw, qx, qy, qz; and notes.

    Raises:
        InputError: a file that can't be used, or context that the model follows and the table lacks.
    """
    if model.suffix == ".json":
        found = _by_black_box(model, poses, pose)
    elif is_xml(model) or (isinstance(content := read_yaml(model), dict) and {"dh", "urdf"} & set(content)):
        found = _by_description(model, poses, pose)
    else:
        found = _by_physics(model, poses, pose)
    points, rotations, rows, notes = found
    return _points_table(points, rotations, rows), notes


def _points_table(points: Array, rotations: Array | None, rows: Recordings) -> pd.DataFrame:
    """Columns id, run, x_mm, y_mm, z_mm and, where there are rotations (N, 3, 3), qw, qx, qy, qz; points (N, 3), m."""
    import pandas as pd
    from scipy.spatial.transform import Rotation

    table = pd.DataFrame({"id": rows.id, "run": rows.run})
    table[AXES_MM] = points * 1e3
    if rotations is not None:
        table[["qx", "qy", "qz", "qw"]] = Rotation.from_matrix(rotations).as_quat(canonical=True)
        table = table[["id", "run", *AXES_MM, *QUATERNION]]
    return table


def _by_physics(model: Path, poses: Path, pose: bool) -> Found:
    """Points (N, 3), m, and orientations (N, 3, 3) in the measurement frame, and the rows they are of."""
    from armscope.compensation.physical import identified_beside

    fitted = load_model(model)
    rows = read_recordings(poses, fitted.arm.n_motors, measured=False)
    return _by_model(fitted, rows, identified_beside(model), pose)


def predict_rows(
    fitted: FittedModel, rows: Recordings, identified: Identified | None, pose: bool = False
) -> tuple[pd.DataFrame, list[str]]:
    """The tool point of some rows by a diagnosed model, in the measurement frame.

    Args:
        fitted: the model.
        rows: N poses, with whatever context the model follows.
        identified: what the model's recordings held; None where nobody knows.
        pose: whether orientations come, too.

    Returns:
        As `predict_file`.

    Raises:
        InputError: context that the model follows and the rows lack.
    """
    points, rotations, _, notes = _by_model(fitted, rows, identified, pose)
    return _points_table(points, rotations, rows), notes


def _by_model(fitted: FittedModel, rows: Recordings, identified: Identified | None, pose: bool) -> Found:
    from armscope.compensation.known_range import beyond_recorded, held_in_time

    notes = _refuse_missing_context(fitted, rows, identified)
    notes += [
        f"run {run!r} is not in the model: its base is taken from run {list(fitted.bases)[-1]!r}"
        for run in fitted.unknown_runs(rows)
    ]
    notes += _of_now(fitted, rows)
    if identified is not None:
        rows_known, told = held_in_time(fitted, identified, rows)
        notes += [*told, *beyond_recorded(fitted, identified, rows)]
        rows = rows_known
    return predicted_points(fitted, rows), predict_orientation(fitted, rows) if pose else None, rows, notes


def _of_now(fitted: FittedModel, rows: Recordings) -> list[str]:
    """What is told where a model follows the order of rows: of which rows poses are, by ids or without."""
    from armscope.compensation.physical import drivers_of
    from armscope.physics.carried_on import NOW

    told = []
    if "slow wave" in drivers_of(fitted) and (rows.time is None or np.isnan(rows.time).any()):
        told = ["no time_s: what wanders in the course of time stays as at the end of the recordings"]
    kinds = drivers_of(fitted) & {"after row", "rows", "slow wave of rows"}
    if kinds and np.isfinite(rows.number).all():
        taken = (
            "are taken for rows of the recordings" if _are_numbers(rows) else "are no numbers that rise in every run"
        )
        counted = "" if _are_numbers(rows) else ": the poses are counted as the recordings' rows, from 1"
        return [*told, f"ids {taken}{counted}; without the column id, poses are of now"]
    notes = told
    if "after row" in kinds:
        notes.append("no ids: what jumped at a row of the recordings has jumped; ids of the recordings say otherwise")
    if kinds & {"rows", "slow wave of rows"}:
        stays = "stays as the last row found it" if NOW in drivers_of(fitted) else "is left out"
        notes.append(f"no ids: what wanders in the order of rows {stays}")
    return notes


def _are_numbers(rows: Recordings) -> bool:
    """Whether rows are numbered by their ids, not counted."""
    try:
        return np.array_equal(rows.id.astype(np.float64), rows.number)
    except ValueError:
        return False


def _refuse_missing_context(fitted: FittedModel, rows: Recordings, identified: Identified | None) -> list[str]:
    """What an effect follows must be known in every row: nothing is taken for zero; notes where that is not known.
    Raises InputError: it is not."""
    from armscope.compensation.physical import FILE, drivers_of, missing_context
    from armscope.physics.drivers import KINDS

    if identified is None:
        if rows.payload is None and any("payload" in KINDS[kind].follows for kind in drivers_of(fitted)):
            return [f"no payload_kg, and no {FILE} beside the model: the arm carries nothing"]
        return []
    notes = []
    for column, missing in missing_context(fitted, identified, rows).items():
        if column == "payload_kg" and identified.payload_left_out:
            notes.append(
                f"{missing.sum()} rows state no {column}: the arm carries nothing, as in the model's recordings"
            )
            continue
        place = "line 1" if missing.all() else f"line {int(np.argmax(missing)) + 2}, column {column}"
        cure = "Write 0 where the arm carries nothing." if column == "payload_kg" else "Add it to the table."
        rule = "an effect in the model follows it, so it must be known in every row"
        raise InputError(rows.source, place, f"no column {column}" if missing.all() else "nothing", rule, cure)
    return notes


def _by_description(robot: Path, poses: Path, pose: bool) -> Found:
    """As `_by_physics` for an arm that does what its robot.yaml says, nominal or calibrated; in its base frame."""
    arm = load_arm(robot)
    rows = read_recordings(poses, arm.n_motors, measured=False)
    points, rotations = tool_frames(arm, rows.motor_angles)
    return points, rotations if pose else None, rows, []


def _by_black_box(model: Path, poses: Path, pose: bool) -> Found:
    """As `_by_physics` for a black-box model; poses outside the identified range are named."""
    from armscope.compensation.black_box import domain_inputs, load_error_model

    fitted = load_error_model(model)
    rows = read_recordings(poses, fitted.arm.n_motors, measured=False)
    if pose and fitted.turning is None:
        raise InputError(
            model,
            "turning",
            "nothing",
            "the model was fitted to positions only",
            "Fit it to recordings with qw ... qz.",
        )
    points, rotations = fitted.as_measured(rows.motor_angles)
    outside = fitted.domain.outside(domain_inputs(fitted, rows.motor_angles))[0] > fitted.domain.allowed
    notes = [f"{outside.sum()} of {len(rows)} rows lie outside the identified range"] if outside.any() else []
    return points, rotations if pose else None, rows, notes
