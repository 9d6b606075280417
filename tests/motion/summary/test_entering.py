"""Errors once numbers are entered one after the other: of all torque, and of each joint's own."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.pipeline import MotionSettings, diagnose_motion
from tests.motion.moving import moved, robot


def test_what_is_wrong_at_one_joint_shows_in_its_error_when_its_cause_is_entered() -> None:
    offset = lambda q, dq, ddq, rigid: np.column_stack([0 * dq[:, :2], np.full(len(dq), 4.0)])
    found = diagnose_motion(robot(), moved(robot(), 7, offset, seconds=6.0), MotionSettings(cutoff=10.0))
    (cause,) = found.verdict.effects
    assert (cause.effect, cause.location) == ("torque_offset", "joint 3")
    _, before, after = found.entered
    assert after.by_joint[:2] == pytest.approx(before.by_joint[:2])
    assert after.by_joint[2] < 0.2 * before.by_joint[2]
    for step in found.entered:
        assert min(step.by_joint) <= step.whole <= max(step.by_joint)
