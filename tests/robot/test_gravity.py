"""Gravity loads against pinocchio's recursive Newton-Euler, its torque regressor, and hand calculation."""

import numpy as np
import pinocchio as pin
import pytest

from armscope.robot import chain, forward_kinematics
from armscope.robot.gravity import (
    gravity_torques,
    gravity_wrenches,
    mass_moment_regressor,
    weight_at_tool,
    weight_of_link,
)
from tests.robot.arms import STANDARD, TOOL_MM, as_modified, dh_arm, random_masses
from tests.robot.test_three_forms import urdf_arm

ACTUATION = [{"q1": 1}, {"q2": 1}, {"q3": 1, "q2": -1}, {"q4": 1}, {"q5": 1}, {"q6": 1, "q5": 0.5}]


@pytest.fixture(params=["standard", "modified", "urdf", "parallelogram, tilted"])
def arm(request, tmp_path):
    masses = random_masses(np.random.default_rng(2), 6)
    load = {"mass_kg": 30, "com_mm": [10, 20, 100]}
    if request.param == "urdf":
        return urdf_arm(tmp_path, STANDARD, tool_mm=TOOL_MM, tool_load=load)
    if request.param == "modified":
        return dh_arm(as_modified(STANDARD), "modified", tool_mm=TOOL_MM, links=masses, tool_load=load)
    more = {} if request.param == "standard" else {"actuation": ACTUATION, "gravity_m_s2": [1, -2.5, -9.4]}
    return dh_arm(STANDARD, tool_mm=TOOL_MM, links=masses, tool_load=load, **more)


@pytest.fixture
def q():
    return np.random.default_rng(3).uniform(-2, 2, (12, 6))


def newton_euler(arm, q):
    """Torques that pinocchio says hold the arm: minus those of gravity."""
    data, zero = arm.model.createData(), np.zeros(6)
    return -np.array([pin.rnea(arm.model, data, row @ arm.actuation.T, zero, zero) @ arm.actuation for row in q])


def test_torques_are_pinocchios(arm, q):
    expected = newton_euler(arm, q)
    assert np.abs(expected).max() > 10
    assert np.abs(gravity_torques(arm, chain(arm, q)) - expected).max() < 1e-9


def test_a_payload_is_a_point_mass_at_the_tool(arm, q):
    frames = chain(arm, q)
    payload = np.linspace(0, 20, len(q))
    payload[3] = np.nan
    more = gravity_torques(arm, frames, payload) - gravity_torques(arm, frames)
    step = 1e-6
    for motor in range(6):  # virtual work of the payload's weight
        unit = np.eye(6)[motor] * step
        rise = (forward_kinematics(arm, q + unit) - forward_kinematics(arm, q - unit)) / (2 * step)
        assert np.abs(more[:, motor] - np.nan_to_num(payload) * (rise @ arm.gravity)).max() < 1e-5
    assert np.all(more[3] == 0)


def test_torques_are_the_slope_of_the_potential_energy(arm, q):
    def energy(angles):
        data = arm.model.createData()
        return np.array([pin.computePotentialEnergy(arm.model, data, row @ arm.actuation.T) for row in angles])

    step = 1e-6
    for motor in range(6):
        unit = np.eye(6)[motor] * step
        slope = (energy(q + unit) - energy(q - unit)) / (2 * step)
        assert np.abs(gravity_torques(arm, chain(arm, q))[:, motor] + slope).max() < 1e-4


def test_force_is_the_weight_of_all_that_hangs_beyond(arm, q):
    force, _ = gravity_wrenches(arm, chain(arm, q))
    for joint in range(6):
        assert np.allclose(force[:, joint], arm.masses[joint:].sum() * arm.gravity, atol=1e-9)


def test_loads_are_the_sum_of_every_link_and_the_payload_alone(arm, q):
    frames, payload = chain(arm, q), np.linspace(0, 20, len(q))
    alone = [weight_of_link(arm, frames, link) for link in range(1, 7)] + [weight_at_tool(arm, frames, payload)]
    for kind, whole in enumerate(gravity_wrenches(arm, frames, payload)):
        np.testing.assert_allclose(sum(each[kind] for each in alone), whole, rtol=1e-12, atol=1e-9)


def test_one_link_is_the_difference_that_its_mass_makes(arm, q):
    frames = chain(arm, q)
    for link in range(1, 7):
        without = arm.masses * (np.arange(1, 7) != link)
        pairs = zip(
            gravity_wrenches(arm, frames),
            gravity_wrenches(arm, frames, masses=without),
            weight_of_link(arm, frames, link),
            strict=True,
        )
        for whole, less, alone in pairs:
            np.testing.assert_allclose(np.broadcast_to(alone, whole.shape), whole - less, atol=1e-9)


def test_moment_about_a_joint_is_that_of_pinocchios_joint_force(arm, q):
    frames = chain(arm, q)
    force, moment = gravity_wrenches(arm, frames)
    data, zero = arm.model.createData(), np.zeros(6)
    for row, angles in enumerate(q @ arm.actuation.T):
        pin.forwardKinematics(arm.model, data, angles)
        pin.rnea(arm.model, data, angles, zero, zero)
        for joint in range(6):
            held = data.oMi[joint + 1].act(data.f[joint + 1])  # about the base's origin
            about_base = moment[row, joint] + np.cross(frames.joint_origin[row, joint], force[row, joint])
            assert np.abs(held.angular + about_base).max() < 1e-9
            assert np.abs(held.linear + force[row, joint]).max() < 1e-9


def test_mass_moment_regressor_is_the_static_part_of_pinocchios(arm, q):
    ours = mass_moment_regressor(arm, chain(arm, q)).reshape(len(q), 6, 6, 4)
    data, zero = arm.model.createData(), np.zeros(6)
    for row, angles in enumerate(q @ arm.actuation.T):
        theirs = pin.computeJointTorqueRegressor(arm.model, data, angles, zero, zero).reshape(6, 6, 10)
        static = -np.einsum("jkp,jm->mkp", theirs[:, :, :4], arm.actuation)
        assert np.abs(ours[row] - static).max() < 1e-9


def test_the_regressor_times_masses_gives_the_torques(arm, q):
    frames = chain(arm, q)
    turns = np.swapaxes(frames.link_rotation @ np.swapaxes(arm.behind[:, :3, :3], 1, 2), 2, 3)
    assert turns.shape == (len(q), 6, 3, 3)
    parameters = np.column_stack([arm.masses, arm.masses[:, None] * arm.centres]).ravel()
    assert np.abs(mass_moment_regressor(arm, frames) @ parameters - gravity_torques(arm, frames)).max() < 1e-9


def test_a_horizontal_arm_by_hand():
    arm = dh_arm([(1000, 0, 0, 0)], links=[{"mass_kg": 10, "com_mm": [-500, 0, 0]}], gravity_m_s2=[0, -10, 0])
    torque = gravity_torques(arm, chain(arm, np.array([[0.0], [np.pi / 2], [np.pi]])))
    assert np.allclose(torque[:, 0], [-50, 0, 50])


def test_an_arm_without_masses_says_so():
    arm = dh_arm(STANDARD)
    assert not arm.has_masses
    assert np.all(gravity_torques(arm, chain(arm, np.zeros((1, 6)))) == 0)
