"""A link whose centre of mass lies far from where it is stated: its inertia about its joint goes with the square."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from tests.motion.moving import moved, robot

OFF_M = np.array([0.0, 0.12, 0.0])
"""Of link 3; its square is a fifth of what the link's inertia about its joint is."""


def test_a_centre_far_off_is_one_cause_and_no_inertia_beside_it() -> None:
    arm = robot()
    stated = arm.inertial[20:30]
    body = pin.Inertia.FromDynamicParameters(stated)
    true = pin.Inertia(body.mass, body.lever + OFF_M, body.inertia).toDynamicParameters()
    inertial = arm.inertial.copy()
    inertial[20:30] = true

    def off_centre(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return np.asarray(arm.torques(q, dq, ddq, inertial) - rigid)

    motions = moved(arm, 7, off_centre, noise=0.005)
    (cause,) = diagnose_motion(arm, motions, MotionSettings(cutoff=10.0)).verdict.effects
    assert (cause.effect, cause.location) == ("link_first_moment", "link 3")
    found = {each.name: each for each in cause.parameters}
    assert found["my"].value == pytest.approx(body.mass * OFF_M[1], rel=0.02)
    low, high = found["my"].interval
    assert low < body.mass * OFF_M[1] < high
