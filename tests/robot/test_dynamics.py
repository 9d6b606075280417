"""Torques of an arm in motion against Newton-Euler, energy, and what robot.yaml states."""

import numpy as np
import pinocchio as pin
import pytest

from armscope.core.inputs import InputError
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm, moved_centre
from tests.motion.moving import ROBOT, robot


def test_the_regressor_times_the_masses_is_newton_euler() -> None:
    arm, rng = robot(), np.random.default_rng(0)
    q, dq, ddq = rng.normal(size=(3, 20, 3))
    data = arm.model.createData()
    expected = np.array([pin.rnea(arm.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
    assert arm.regressor(q, dq, ddq) @ arm.inertial == pytest.approx(expected, abs=1e-9)
    assert arm.gravity_torques(q, np.array([0, 0, -9.81])) == pytest.approx(
        arm.regressor(q, 0 * q, 0 * q) @ arm.inertial, abs=1e-9
    )


def test_power_is_the_rate_of_energy() -> None:
    arm = robot()
    time = np.linspace(0, 1, 4001)
    q = np.column_stack([np.sin(3 * time), 0.5 * np.cos(2 * time), np.sin(time)])
    dq = np.column_stack([3 * np.cos(3 * time), -np.sin(2 * time), np.cos(time)])
    ddq = np.column_stack([-9 * np.sin(3 * time), -2 * np.cos(2 * time), -np.sin(time)])
    data = arm.model.createData()
    energy = [
        pin.computeKineticEnergy(arm.model, data, a, b) + pin.computePotentialEnergy(arm.model, data, a)
        for a, b in zip(q, dq, strict=True)
    ]
    power = np.sum((arm.regressor(q, dq, ddq) @ arm.inertial) * dq, axis=1)
    assert np.gradient(energy, time)[5:-5] == pytest.approx(power[5:-5], abs=2e-3 * np.abs(power).max())


def test_motors_that_move_several_joints_do_the_work_of_all() -> None:
    coupled = robot(actuation=[{"q1": 1}, {"q2": 1}, {"q2": -1, "q3": 1}])
    rng = np.random.default_rng(1)
    q, dq, ddq = rng.normal(size=(3, 5, 3))
    joints = robot().regressor(q @ coupled.actuation.T, dq @ coupled.actuation.T, ddq @ coupled.actuation.T)
    torque = joints @ coupled.inertial
    motors = coupled.regressor(q, dq, ddq) @ coupled.inertial
    assert motors == pytest.approx(torque @ coupled.actuation, abs=1e-9)


def test_a_kilogram_at_the_tool_weighs_what_it_weighs() -> None:
    arm, heavier = robot(tool_mm=[50, 0, 0]), robot(tool_load={"mass_kg": 1, "com_mm": [50, 0, 0]})
    assert arm.inertial + arm.point_load() == pytest.approx(heavier.inertial, abs=1e-9)


def test_an_arm_without_masses_is_refused() -> None:
    with pytest.raises(InputError, match="needs masses"):
        build_moving_arm(RobotDescription.model_validate({**ROBOT, "links": None}))


def test_what_drives_state_is_known_and_the_rest_is_not() -> None:
    arm = robot(drives=[{"coulomb_nm": 2.0}, {"gain_nm_per_a": 9.0}, {"rotor_inertia_kg_m2": 0.3}])
    assert np.array_equal(np.isfinite(arm.stated_background), [[0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]])
    assert arm.gains[1] == 9.0
    assert np.isnan(arm.gains[[0, 2]]).all()


def test_a_centre_of_mass_that_moves_takes_the_inertia_about_the_joint_along() -> None:
    """By pinocchio: bodies whose centre lies elsewhere, with the same mass and the same inertia about it."""
    rng = np.random.default_rng(5)
    body = pin.Inertia.Random()
    slopes = moved_centre(body.toDynamicParameters())
    for _ in range(4):
        off = 1e-6 * rng.normal(size=3)
        moved = pin.Inertia(body.mass, body.lever + off / body.mass, body.inertia)
        changed = moved.toDynamicParameters() - body.toDynamicParameters()
        np.testing.assert_allclose(slopes @ off, changed, atol=1e-10)
        far = 1e6 * off
        moved = pin.Inertia(body.mass, body.lever + far / body.mass, body.inertia)
        changed = moved.toDynamicParameters() - body.toDynamicParameters()
        np.testing.assert_allclose(moved_centre(body.toDynamicParameters(), far) @ far, changed, atol=1e-8)
    np.testing.assert_array_equal(moved_centre(np.zeros(10))[4:], 0)
