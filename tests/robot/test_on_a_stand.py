"""What a stand feels of an arm, and joints of their stand: by gravity and by inverse dynamics of a base that moves."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from armscope.robot.on_a_stand import on_a_stand
from tests.motion.moving import robot


@pytest.mark.parametrize("axis", [0, 1])
def test_joints_feel_a_stand_that_leans_and_turns(axis: int) -> None:
    arm, rng, step = robot(), np.random.default_rng(3), 1e-5
    q, dq, ddq = (rng.uniform(-1, 1, (20, arm.n_motors)) for _ in range(3))
    found, about = on_a_stand(arm, (q, dq, ddq), arm.inertial), np.eye(3)[axis]
    down = arm.model.gravity.linear
    leaning = [arm.gravity_torques(q, down - side * np.cross(step * about, down)) for side in (1, -1)]
    assert found.per_turn[:, :, axis] == pytest.approx((leaning[0] - leaning[1]) / (2 * step), abs=1e-5)
    model = arm.model.copy()
    model.gravity = pin.Motion(np.zeros(3), -about)
    data = model.createData()
    turning = np.array([pin.rnea(model, data, row, 0 * row, 0 * row).copy() for row in q])
    assert found.per_turning[:, :, axis] == pytest.approx(turning, abs=1e-9)


def test_a_stand_holds_what_the_arm_weighs_where_that_is() -> None:
    """At rest its moment is mass times gravity times the way from the base to the centre of mass."""
    arm, rng = robot(), np.random.default_rng(4)
    q = rng.uniform(-1, 1, (10, arm.n_motors))
    found = on_a_stand(arm, (q, 0 * q, 0 * q), arm.inertial)
    data = arm.model.createData()
    for row, moment in zip(q, found.moment, strict=True):
        pin.centerOfMass(arm.model, data, row)
        weight = np.cross(data.com[0], data.mass[0] * arm.model.gravity.linear)
        assert moment == pytest.approx(-weight[:2], abs=1e-9)
