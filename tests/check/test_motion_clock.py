"""Torque that another clock recorded is told with its lag; what a drive lags is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.motions import check_moving
from armscope.recordings.motions import Motions
from tests.motion.moving import moved, robot


def put_off(motions: Motions, late: float, joints: tuple[int, ...]) -> Motions:
    effort = motions.effort.copy()
    for run in motions.runs:
        there = np.flatnonzero(motions.run == run)
        for j in joints:
            effort[there, j] = np.interp(motions.time[there] - late, motions.time[there], effort[there, j])
    return replace(motions, effort=effort)


@pytest.mark.parametrize(
    ("late", "joints", "told"),
    [
        (0.2, (0, 1, 2), "of all joints lies 200 ms after"),
        (-0.2, (0, 1, 2), "of all joints lies 200 ms before"),
        (0.2, (1,), "of joint 2 lies 200 ms after"),
        (-0.1, (1,), "of joint 2 lies 100 ms before"),
        (0.036, (0, 1, 2), ""),
        (0.0, (), ""),
    ],
)
def test_torque_of_another_clock_is_told_with_its_lag(late: float, joints: tuple[int, ...], told: str) -> None:
    """A lag of a drive is the diagnosis's to name; one that is many times as long was "unknown" there."""
    seen = check_moving(put_off(moved(robot(), 3), late, joints), robot()).suspicions
    found = [each for each in seen if "the motion" in each.statement]
    assert len(found) == bool(told)
    assert all(told in each.statement and each.weight == "problem" for each in found)
    assert all(f"{abs(late):g} s {'earlier' if late > 0 else 'later'}" in each.cure for each in found)
