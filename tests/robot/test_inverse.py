"""Inverse kinematics, judged by forward kinematics (which other engines judge)."""

import itertools

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.robot import chain, forward_kinematics, load_arm, position_jacobian
from armscope.robot.inverse import follow_path
from tests.robot.arms import SK120, STANDARD, TOOL_MM, dh_arm

HELD = {4: 0.0, 5: 0.0}
HOME = np.zeros(6)


@pytest.fixture
def arm():
    return load_arm(SK120)


def line(start, end, count=100):
    return np.linspace(start, end, count)


def test_a_path_is_followed_exactly_smoothly_and_with_held_motors_at_rest(arm):
    targets = line([1.2, -0.6, 0.6], [1.4, 0.5, 1.2])
    found = follow_path(arm, targets, HOME, HELD)
    assert found.reached.all()
    assert np.abs(forward_kinematics(arm, found.motor_angles) - targets).max() < 1e-8
    assert np.all(found.motor_angles[:, 3:5] == 0)
    assert np.abs(np.diff(found.motor_angles, axis=0)).max() < 0.05
    assert np.all((found.motor_angles >= arm.limits[:, 0]) & (found.motor_angles <= arm.limits[:, 1]))


@pytest.mark.parametrize("held", [None, {6: 0.3}, {4: 0.1, 5: -0.2, 6: 0.3}])
def test_whatever_is_held_the_targets_are_met(arm, held):
    targets = line([1.4, -0.3, 0.9], [1.6, 0.4, 1.1], 30)
    found = follow_path(arm, targets, [0, 0, 0.4, 0, 0, 0], held)
    assert found.reached.all()
    assert np.abs(forward_kinematics(arm, found.motor_angles) - targets).max() < 1e-8
    for motor, angle in (held or {}).items():
        assert np.all(found.motor_angles[:, motor - 1] == angle)


def test_the_motion_is_the_least_that_reaches_the_next_point(arm):
    """At a minimum of |dq|^2 under f(q) = target, dq has no part in the Jacobian's null space; and any other
    solution near by, found by moving along the null space, is farther away."""
    found = follow_path(arm, line([1.2, -0.6, 0.6], [1.4, 0.5, 1.2], 12), HOME, HELD).motor_angles
    free = [0, 1, 2, 5]
    for before, after in itertools.pairwise(found):
        jacobian = position_jacobian(arm, chain(arm, after[None]))[0][:, free]
        null = np.linalg.svd(jacobian)[2][3]
        assert abs(null @ (after - before)[free]) < 1e-6
        for along in (-0.02, 0.02):
            other = after.copy()
            other[free] += along * null
            assert np.linalg.norm(other - before) > np.linalg.norm(after - before)


def test_a_point_out_of_reach_is_named_and_the_path_goes_on(arm):
    targets = np.vstack(
        [line([1.4, 0, 1.0], [1.6, 0, 1.0], 20), [[9.0, 0, 0], [3.4, 0, 0.2]], line([1.61, 0, 1.0], [1.7, 0, 1.0], 5)]
    )
    found = follow_path(arm, targets, HOME, HELD)
    assert found.reasons[20] == "beyond reach"
    assert found.reasons[21] == "beyond reach"
    assert np.isnan(found.motor_angles[20:22]).all()
    assert found.reached.sum() == 25


def test_a_point_that_a_limit_forbids_names_the_joint():
    planar = dh_arm(
        [(0, -90, 0, 0), (1000, 0, 0, 0), (800, 0, 0, 0)], joint_limits_deg=[[-90, 90], [-150, 150], [10, 150]]
    )
    found = follow_path(planar, [[1.5, 0, 0], [1.5, 0.2, 0], [-1.4, 0.3, 0.9], [1.797, 0.0, 0.0]], [0, -0.3, 0.6])
    assert found.reached[:2].all()
    assert found.reasons[3] == "limit of joint 3"  # almost stretched: the elbow would open to less than 10 degrees


def test_a_path_that_teleports_is_a_jump_and_not_followed(arm):
    targets = np.vstack([line([1.4, -0.8, 0.9], [1.4, -0.7, 0.9], 5), line([1.4, 0.7, 0.9], [1.4, 0.8, 0.9], 2)])
    found = follow_path(arm, targets, HOME, HELD)
    assert found.reached[:5].all()
    assert found.reasons[5] == "jump of joint 1"


def test_points_that_are_no_path_may_each_have_a_branch_of_their_own(arm):
    behind = [[1.4, -0.7, 0.9], [-1.4, 0.1, 0.9], [1.4, 0.7, 0.9], [0.3, 1.3, 1.1]]
    found = follow_path(arm, behind, HOME, HELD, np.inf)
    assert found.reached.all()
    np.testing.assert_allclose(forward_kinematics(arm, found.motor_angles), behind, atol=1e-9)


def test_the_first_point_may_be_far_from_the_start(arm):
    found = follow_path(arm, [[0.5, 0.5, 1.4]], [2.0, 1.0, -1.0, 0, 0, 0], HELD)
    assert found.reached.all()


def test_an_unreachable_path_is_one_clear_error(arm):
    found = follow_path(arm, line([2.0, 0, 1.0], [4.0, 0, 1.0]), HOME, HELD)
    with pytest.raises(InputError, match=r"trajectory II: point \d+: found '\(.*, 0, 1000\) mm: beyond reach'.*held"):
        found.require_all("trajectory II")


def test_a_seven_axis_arm_without_limits_follows_too():
    rows = [
        (0, -90, 340, 0),
        (0, 90, 0, 0),
        (0, -90, 400, 180),
        (0, 90, 0, 0),
        (0, -90, 400, 180),
        (0, 90, 0, 0),
        (0, 0, 126, 0),
    ]
    arm = dh_arm(rows, tool_mm=(20, 10, 30))
    q = np.array([0.1, 0.4, 0.2, 0.9, 0.1, 0.5, 0.0])
    begin = forward_kinematics(arm, q)[0]
    targets = line(begin, begin + np.array([0.05, 0.1, -0.1]))
    found = follow_path(arm, targets, q)
    assert found.reached.all()
    assert np.abs(forward_kinematics(arm, found.motor_angles) - targets).max() < 1e-8


def test_targets_made_by_the_arm_itself_are_reached():
    rng = np.random.default_rng(7)
    arm = dh_arm(STANDARD, tool_mm=TOOL_MM)
    for q in rng.uniform(-1.5, 1.5, (20, 6)):
        target = forward_kinematics(arm, q)
        found = follow_path(arm, target, q + rng.uniform(-0.1, 0.1, 6))
        assert found.reached.all()
        assert np.abs(forward_kinematics(arm, found.motor_angles) - target).max() < 1e-8


@pytest.mark.long
def test_ten_thousand_points_are_reached_every_one(arm):
    path = line([1.2, -0.6, 0.6], [1.4, 0.5, 1.2], 10_000)
    found = follow_path(arm, path, HOME, HELD)
    assert found.reached.all()
    assert np.abs(forward_kinematics(arm, found.motor_angles) - path).max() < 1e-8
