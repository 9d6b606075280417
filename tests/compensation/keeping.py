"""Arms whose tool keeps its attitude, zeros off: recorded, diagnosed, commanded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.compensation.compensate import compensate_physical
from armscope.compensation.path import as_path
from armscope.compensation.physical import identified_on
from armscope.compensation.task import Options
from armscope.diagnosis import Settings, diagnose
from armscope.robot import chain
from tests.calibration.worlds import UR_LIKE, far_away, measured
from tests.robot.arms import dh_arm

from .arms import table_of

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_M = 2e-5
LOWER, UPPER = np.array([-2.5, -0.6, -0.2, -2.5]), np.array([2.5, 1.2, 1.6, 2.5])


def palletiser(tool_mm=(180.0, 60.0, -150.0)):
    """Four motors; a rod keeps the flange level."""
    rows = [(350, -90, 800, 0), (1250, 0, 0, -90), (1350, 0, 0, 90), (250, -90, 0, 0), (0, 0, -200, 0)]
    rod = [{"q1": 1}, {"q2": 1}, {"q3": 1}, {"q2": -1, "q3": -1}, {"q4": 1}]
    return dh_arm(rows, tool_mm=list(tool_mm), actuation=rod)


def six_axes(tool_mm=(30.0, -45.0, 80.0)):
    """An arm like a UR."""
    return dh_arm(UR_LIKE, tool_mm=list(tool_mm))


def level_poses(rng, count):
    """(N, 4) of the palletiser."""
    return rng.uniform(LOWER, UPPER, (count, 4))


def downward_poses(rng, count):
    """(N, 6) of the arm like a UR with its flange down, but for what a display rounds away."""
    angles = rng.uniform([-2, -2.4, 0.6, 0, 0, -2.5], [2, -0.6, 2.2, 0, 0, 2.5], (count, 6))
    angles[:, 3], angles[:, 4] = -np.pi / 2 - angles[:, 1] - angles[:, 2], -np.pi / 2
    return np.radians(np.round(np.degrees(angles), 2))


def recordings(arm, angles, rng, zeros=None, tool=None, noise=NOISE_M):
    """What an instrument far away would say of the arm whose zeros are off, of its tool as stated unless given."""
    real = angles + (0.0 if zeros is None else zeros)
    table = measured(arm, real, far_away(rng), {"": arm.tool if tool is None else tool}, noise, rng, run="")
    return replace(table, motor_angles=angles)


def commanded(arm, rows, angles, **options):
    """The commands for the points where the arm as drawn would be, in its base frame, and what they are of."""
    found = diagnose(arm, rows, QUICK)
    path = as_path(
        table_of(chain(arm, angles).tool, **{f"q{j + 1}_rad": angles[:, j] for j in range(angles.shape[1])}),
        "path",
        arm,
    )
    settings = Options(separate_points=True, allowed_outside=1.0, **options)
    return found, compensate_physical(found.model, identified_on(arm, rows), path, settings)


def missed_mm(arm, angles, commands, zeros):
    """RMS of the distance by which the real arm, its zeros off, misses its own base frame's points."""
    miss = chain(arm, commands + zeros).tool - chain(arm, angles).tool
    return 1e3 * float(np.sqrt(np.nanmean(np.sum(miss**2, axis=1))))
