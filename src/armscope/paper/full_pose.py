"""Full pose on the paper's virtual robot: every model on position and orientation, predicted and in closed loop.

The paper's trajectories keep theta4 = theta5 = 0, a pole of the wrist: there a full pose cannot be corrected. So the
same tool points are followed with a bent wrist, and identification poses of their own cover these joint ranges.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from armscope.compensation.closed_loop import NO_MODEL, Corrector, black_box_candidate
from armscope.compensation.fitting import fit_error_model
from armscope.compensation.path import as_path
from armscope.core.averages import rms_distance
from armscope.core.types import Array
from armscope.errormodels.fitted import ModelSet
from armscope.paper.closed_loop import DIAGNOSED, diagnosed_candidate
from armscope.paper.identification_poses import candidate_poses, choose_identification_poses, joint_ranges
from armscope.paper.measurements import Measurements
from armscope.recordings import Recordings
from armscope.recordings.columns import angle_columns
from armscope.recordings.table import as_recordings
from armscope.robot import Arm, Chain, chain
from armscope.robot.inverse import follow_path
from armscope.world.tolerances import GeometricErrors, geometric_errors

BENT_WRIST = {4: 0.3, 5: 0.7}  # Angles of the wrist's motors along the trajectories, rad (assumed)
MARGIN_RAD = 0.1
WRIST_MARGIN_RAD = 0.3
"""The identification poses' ranges are the trajectories', widened by this (assumed; wrists need room to correct)."""
CANDIDATES = 2000
NOISE_MM, NOISE_MRAD = 0.03, 0.05  # 1-sigma per axis of a tracker with an orientation probe (assumed)


def paper_full_pose(
    arm: Arm, measurements: Measurements, errors: Array, models: ModelSet, seed: int = 0, diagnosed: bool = True
) -> pd.DataFrame:
    """Model by trajectory by stage, position and orientation, for the first robot of a study.

    Args:
        arm: the nominal arm.
        measurements: whose held-out sets give the trajectories' tool points, and the number of identification poses.
        errors: (K,) the robot's true geometric errors, m and rad, in the order of `geometric_errors`.
        models: to fit, plain and extended.
        seed: of the identification poses and the noise.
        diagnosed: add physics diagnosed from the positions alone.

    Returns:
        Columns model, trajectory, stage ("fit", "prediction", "closed loop"), points, refused, rms_mm (of the error
        vector), rms_mrad (of the rotation vector, base axes). All by least squares. The closed loop is the true arm at
        the corrected commands.
    """
    truth = geometric_errors(arm)
    paths = {
        each.name: follow_path(arm, each.nominal_mm * 1e-3, _start(arm), BENT_WRIST).require_all(each.name)
        for each in measurements.held_out
    }
    count = len(measurements.identification.motor_angles)
    identification = _identification(truth, np.concatenate(list(paths.values())), count, seed)
    recordings = _measured(truth, errors, identification, np.random.default_rng(seed))
    fitted = _models(arm, recordings, models)
    if diagnosed:
        fitted[DIAGNOSED] = diagnosed_candidate(arm, recordings, pose=True)
    rows = _rows(NO_MODEL, "identification", "fit", *_gap(_of(recordings), _nominal(arm, identification)))
    for name, angles in paths.items():
        real = _pose(truth.frames(angles, errors / truth.sigmas))
        for stage in ("prediction", "closed loop"):
            rows += _rows(NO_MODEL, name, stage, *_gap(real, _nominal(arm, angles)))
    for title, model in fitted.items():
        rows += _rows(title, "identification", "fit", *_gap(_of(recordings), model.tool_pose(identification)))
        for name, angles in paths.items():
            real = _pose(truth.frames(angles, errors / truth.sigmas))
            rows += _rows(title, name, "prediction", *_gap(real, model.tool_pose(angles)))
            result = model.compensate(as_path(_table(angles, *_nominal(arm, angles)), f"trajectory {name}", arm))
            reached, gap = result.reached, (np.empty((0, 3)), np.empty((0, 3)))
            if reached.any():
                loop = _pose(truth.frames(result.commands[reached], errors / truth.sigmas))
                gap = _gap(loop, _nominal(arm, angles[reached]))
            rows += _rows(title, name, "closed loop", *gap, int(np.sum(~reached)))
    return pd.DataFrame(rows)


def _start(arm: Arm) -> Array:
    start = np.zeros(arm.n_motors)
    for motor, angle in BENT_WRIST.items():
        start[motor - 1] = angle
    return start


def _identification(truth: GeometricErrors, angles: Array, count: int, seed: int) -> Array:
    """(count, m) poses over the trajectories' ranges that show geometric errors best."""
    low, high = joint_ranges(angles, MARGIN_RAD)
    wrist = np.arange(len(low)) >= 3
    low, high = np.where(wrist, low - WRIST_MARGIN_RAD, low), np.where(wrist, high + WRIST_MARGIN_RAD, high)
    poses = candidate_poses(low, high, CANDIDATES, seed)
    jacobian = truth.jacobian(chain(truth.arm, poses))
    return poses[choose_identification_poses(jacobian, count, np.random.default_rng(seed)).rows]


def _measured(truth: GeometricErrors, errors: Array, angles: Array, rng: np.random.Generator) -> Recordings:
    points, rotations = _pose(truth.frames(angles, errors / truth.sigmas))
    points = points + rng.normal(0, NOISE_MM * 1e-3, points.shape)
    noise = Rotation.from_rotvec(rng.normal(0, NOISE_MRAD * 1e-3, points.shape))
    table = _table(angles, points, (noise * Rotation.from_matrix(rotations)).as_matrix())
    return replace(as_recordings(table), source="identification")


def _table(angles: Array, points: Array, rotations: Array) -> pd.DataFrame:
    columns = angle_columns(angles)
    columns |= {f"{axis}_mm": points[:, n] * 1e3 for n, axis in enumerate("xyz")}
    quaternions = Rotation.from_matrix(rotations).as_quat(canonical=True)
    return pd.DataFrame(columns | dict(zip(("qx", "qy", "qz", "qw"), quaternions.T, strict=True)))


def _models(arm: Arm, recordings: Recordings, models: ModelSet) -> dict[str, Corrector]:
    fit = functools.partial(fit_error_model, arm, recordings)
    fitted = {spec.name: fit(spec) for spec in models.plain}
    fitted |= {f"{spec.name} with products": fit(spec, products=True) for spec in models.products}
    fitted |= {f"{spec.name}, {count} regions": fit(spec, regions=count) for spec, count in models.regions}
    return {name: black_box_candidate(model, pose=True) for name, model in fitted.items()}


def _pose(frames: Chain) -> tuple[Array, Array]:
    return frames.tool, frames.tool_rotation


def _nominal(arm: Arm, angles: Array) -> tuple[Array, Array]:
    return _pose(chain(arm, angles))


def _of(recordings: Recordings) -> tuple[Array, Array]:
    return recordings.positions, Rotation.from_quat(recordings.quaternions, scalar_first=True).as_matrix()


def _gap(pose: tuple[Array, Array], other: tuple[Array, Array]) -> tuple[Array, Array]:
    """(displacement (N, 3), m; rotation vector (N, 3), rad) of the first pose from the other."""
    turn = Rotation.from_matrix(pose[1] @ np.swapaxes(other[1], 1, 2)).as_rotvec()
    return pose[0] - other[0], turn


def _rows(
    model: str, trajectory: str, stage: str, displacement: Array, turn: Array, refused: int = 0
) -> list[Mapping[str, object]]:
    def rms(vectors: Array) -> float:
        return rms_distance(vectors) * 1e3 if len(vectors) else float("nan")

    keys = {"model": model, "trajectory": trajectory, "stage": stage, "points": len(turn), "refused": refused}
    return [keys | {"rms_mm": rms(displacement), "rms_mrad": rms(turn)}]
