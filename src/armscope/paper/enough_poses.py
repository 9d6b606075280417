"""How many identification poses are enough? ("self-calibration with minimum experimental data", pp. 957 and 965).

Poses fill the same joint ranges as the study's, as a low-discrepancy sequence does: its first n are well spread for
every n. The first-degree Cartesian model is fitted to each number of them by least squares and judged on the test
trajectories, beside the largest number.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from armscope.errormodels.features import FDP_CI
from armscope.paper.identification_poses import candidate_poses
from armscope.paper.virtual import StudyPlan, VirtualStudy, identification_ranges
from armscope.robot import forward_kinematics

COUNTS = (6, 8, 10, 12, 15, 20, 30, 40, 60, 85, 120, 170, 340)
PRINTED_COUNT = 85
TOLERATED = 1.1  # A number of poses suffices if the error is at most this many times that with the largest number


def enough_poses(plan: StudyPlan, study: VirtualStudy) -> pd.DataFrame:
    """The error left on the test trajectories against the number of poses, for every robot of a study. Returns
    Columns robot, model, poses, rms_mm (3D, over the test trajectories together, held out)."""
    paths = study.measurements.held_out
    followed = np.concatenate([each.motor_angles for each in paths])
    ranges = identification_ranges(plan.errors, followed, plan.poses)
    angles = candidate_poses(*ranges, COUNTS[-1], plan.seed)
    rng = np.random.default_rng(plan.seed)
    nominal = forward_kinematics(plan.arm, angles)
    noise = plan.tracker.measurement_errors(nominal, rng) + plan.repeat_m * rng.standard_normal(nominal.shape)
    errors = 1e3 * (plan.errors.positions(angles, study.robots.in_sigmas) + noise - nominal)
    inputs = 1e3 * nominal
    tables = []
    for count in COUNTS:
        features = FDP_CI.features(inputs[:count])
        terms = features.matrix(inputs[:count])
        scale = np.linalg.norm(terms, axis=0)
        coefficients = (np.linalg.pinv(terms / scale) @ errors[:, :count]) / scale[:, None]
        left = [each.errors_mm - features.matrix(each.inputs(FDP_CI)) @ coefficients for each in paths]
        mean_squares = [np.mean(np.sum(each**2, axis=2), axis=1) for each in left]
        rms = np.sqrt(np.mean(mean_squares, axis=0))
        tables.append(pd.DataFrame({"robot": study.robots.names, "model": FDP_CI.name, "poses": count, "rms_mm": rms}))
    return pd.concat(tables, ignore_index=True)


def smallest_sufficient(table: pd.DataFrame) -> pd.Series:
    """By robot, the smallest number of poses whose error is within `TOLERATED` of that with the most."""
    wide = table.pivot_table(index="robot", columns="poses", values="rms_mm", sort=False)
    sufficient = wide.le(TOLERATED * wide[wide.columns.max()], axis=0)
    return sufficient.idxmax(axis=1)
