"""Jacobians against central differences of the exact forward model."""

import numpy as np
import pytest

from armscope.robot import chain, forward_kinematics, load_arm, position_jacobian, twist_jacobian
from armscope.robot.kinematics import joint_jacobian
from tests.robot.arms import SK120, STANDARD, TOOL_MM, as_modified, dh_arm

STEP = 1e-6
LOCATIONS = ["base", "tool", *(f"{kind} {j}" for kind in ("joint", "link") for j in range(1, 7))]


@pytest.fixture(params=["standard", "modified", "parallelogram"])
def arm(request):
    if request.param == "parallelogram":
        return load_arm(SK120)
    rows = STANDARD if request.param == "standard" else as_modified(STANDARD)
    return dh_arm(rows, request.param, tool_mm=TOOL_MM)


@pytest.fixture
def q():
    return np.random.default_rng(0).uniform(-2, 2, (15, 6))


def test_position_jacobian_is_the_slope_by_each_motor(arm, q):
    slopes = [
        (forward_kinematics(arm, q + STEP * unit) - forward_kinematics(arm, q - STEP * unit)) / (2 * STEP)
        for unit in np.eye(6)
    ]
    assert np.abs(position_jacobian(arm, chain(arm, q)) - np.stack(slopes, axis=2)).max() < 1e-8


@pytest.mark.parametrize("location", LOCATIONS)
def test_twist_jacobian_is_the_slope_by_a_small_twist_there(arm, q, location):
    slopes = [
        (forward_kinematics(arm, q, {location: STEP * unit}) - forward_kinematics(arm, q, {location: -STEP * unit}))
        / (2 * STEP)
        for unit in np.eye(6)
    ]
    assert np.abs(twist_jacobian(chain(arm, q), location) - np.stack(slopes, axis=2)).max() < 1e-8


def test_a_turn_about_the_joints_axis_is_the_joint_itself(arm, q):
    """Commanding more, and a twist about z of the joint's frame, are the same motion, also far from zero."""
    angles = np.zeros((len(q), 6))
    for joint in range(6):
        angles[:] = 0
        angles[:, 5] = 0.7
        spin = np.linalg.solve(arm.actuation, np.eye(6)[joint]) * 0.3  # the motors that turn this joint alone
        turned = chain(arm, q + spin)
        twisted = chain(arm, q, {f"joint {joint + 1}": np.array([0, 0, 0, 0, 0, 0.3])})
        assert np.abs(turned.tool - twisted.tool).max() < 1e-12


def test_twists_add_up_in_the_linear_model(arm, q):
    rng = np.random.default_rng(1)
    twists = {location: 1e-6 * rng.normal(size=(len(q), 6)) for location in LOCATIONS}
    frames = chain(arm, q)
    linear = sum(np.einsum("nij,nj->ni", twist_jacobian(frames, where), twist) for where, twist in twists.items())
    assert np.abs(forward_kinematics(arm, q, twists) - frames.tool - linear).max() < 1e-10


def test_joint_jacobian_turns_about_the_axes(arm, q):
    frames = chain(arm, q)
    for joint in range(6):
        about_z = twist_jacobian(frames, f"joint {joint + 1}")[:, :, 5]
        assert np.abs(joint_jacobian(frames)[:, :, joint] - about_z).max() < 1e-12


def test_a_link_twist_is_a_change_of_the_rows_length(q):
    rows = [list(row) for row in STANDARD]
    nominal = dh_arm(rows, tool_mm=TOOL_MM)
    rows[1][0] += 2.0
    rows[1][1] += np.degrees(0.001)
    changed = dh_arm(rows, tool_mm=TOOL_MM)
    twist = {"link 2": np.array([0.002, 0, 0, 0.001, 0, 0])}
    assert np.abs(forward_kinematics(changed, q) - forward_kinematics(nominal, q, twist)).max() < 1e-12
