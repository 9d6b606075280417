"""A model's laws over what they follow: drawn as they were fitted."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np

from armscope.motion.library import catalogue
from armscope.motion.library.causes import Cause, PlacedCause
from armscope.motion.library.clinging import taken_along
from armscope.motion.library.laws import Law
from armscope.motion.library.layout import OWN
from armscope.motion.model.fitted import MotionModel
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.model.shapes import free_curve, friction_over_speed, limits_of, since_reversal
from armscope.motion.samples.preparation import preparation
from tests.motion.moving import COULOMB, VISCOUS, robot


def placed(cause: Cause, law: Law, width: int, is_curve: bool = False) -> PlacedCause:
    names = tuple((f"knot {k + 1}", "N m") for k in range(width))
    return PlacedCause(cause, f"joint {law.joints[0] + 1}", "", names, law.joints, law, is_curve=is_curve)


def test_friction_over_speed_is_all_that_follows_the_joints_own_speed() -> None:
    arm, still = robot(), np.zeros((3, OWN))
    still[:, 1:3] = np.column_stack([COULOMB, VISCOUS])
    stribeck = placed(catalogue.STRIBECK, Law("stribeck", (1,), (0.01, 0.2)), 2)
    cable = placed(catalogue.CABLE, Law("curve over joint angle", (1,), (-1.0, 1.0, 6.0)), 6, is_curve=True)
    values = (np.array([2.0, 0.0]), np.full(6, 2.0))  # of the second parameter: the scanned speed is the true one
    causes = tuple(
        FittedCause(each, value, np.eye(each.width)) for each, value in zip((stribeck, cable), values, strict=True)
    )
    model = MotionModel(arm, preparation(100.0, 5.0, "test"), "torque", still, arm.inertial, np.zeros(3), causes)
    speed = np.array([-0.8, -0.1, 0.1, 0.8])
    plain = np.sign(speed) * COULOMB[0] + VISCOUS[0] * speed
    np.testing.assert_allclose(friction_over_speed(model, 0, speed), plain, atol=1e-6)
    own = np.sign(speed) * (COULOMB[1] + 2 * np.exp(-((speed / 0.2) ** 2))) + VISCOUS[1] * speed
    np.testing.assert_allclose(friction_over_speed(model, 1, speed), own, atol=1e-6)


def test_a_free_curve_is_the_one_that_was_fitted_with_its_error() -> None:
    law = Law("curve over joint angle", (1,), (-1.0, 1.5, 9.0))
    cable = placed(catalogue.CABLE, law, 9, is_curve=True)
    at = np.linspace(-1, 1.5, 40)
    columns = np.array([free_curve(FittedCause(cable, unit, np.eye(9)), at)[0] for unit in np.eye(9)]).T
    values = np.linalg.lstsq(columns, np.sin(2 * at), rcond=None)[0]
    value, stderr = free_curve(FittedCause(cable, values, 0.04 * np.ones((9, 9))), at)
    np.testing.assert_allclose(value, np.sin(2 * at), atol=5e-3)
    np.testing.assert_allclose(stderr, 0.2)  # all knots up or down together: the curve as a whole
    assert limits_of(FittedCause(cable, values, np.eye(9))) == (-1.0, 1.5)


def test_what_clings_over_ways_is_drawn_as_it_goes_on_after_a_reversal() -> None:
    """By hand: two stops, of 0.1 and 0.4 rad, come round from -1 to 1 over twice their way."""
    law = Law("clinging over ways", (0,), (0.1, 0.4))
    placed = SimpleNamespace(columns=law, width=2)
    covariance = np.diag([0.04, 0.01])
    cause = cast(FittedCause, SimpleNamespace(placed=placed, values=np.array([3.0, 1.0]), covariance=covariance))
    way = np.array([0.0, 0.1, 0.2, 0.8, 5.0])
    value, stderr = since_reversal(cause, way)
    np.testing.assert_allclose(value, [-4, -0.75, 2.5, 4, 4])
    np.testing.assert_allclose(stderr[[0, 4]], np.sqrt(0.05))
    angles = np.concatenate([[0.0], -np.linspace(0.01, 3, 300), -3 + way[1:4]])
    np.testing.assert_allclose(taken_along(angles, (0.1, 0.4))[-3:] @ cause.values, value[1:4])
