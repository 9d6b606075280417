import numpy as np
import pytest

from armscope.report.figures.arm_shape import arm_shape, has_parallelogram, typical_pose, upright, view_from
from armscope.robot import chain, forward_kinematics, load_arm
from tests.report.verdicts import ROBOTS

ARMS = ["six-axis", "seven-axis", "parallelogram-120kg", "sk120"]


@pytest.fixture(params=ARMS)
def arm(request):
    return load_arm(ROBOTS / f"{request.param}.yaml")


@pytest.fixture
def angles(arm):
    return np.random.default_rng(3).uniform(-1, 1, (40, arm.n_motors))


def test_the_centre_line_leads_unbroken_from_the_base_to_the_measured_tool_point(arm, angles):
    shape = arm_shape(arm, angles[0])
    ends = [line[-1] for _, line in shape.parts[:-1]]
    starts = [line[0] for _, line in shape.parts[1:]]
    assert np.allclose(shape.parts[0][1][0], 0)
    assert np.allclose(ends, starts)
    assert np.allclose(shape.parts[-1][1][-1], shape.to_world @ forward_kinematics(arm, angles[:1])[0])


def test_every_disc_sits_on_its_own_joints_axis(arm, angles):
    frames = chain(arm, angles[:1])
    shape = arm_shape(arm, angles[0])
    origins = frames.joint_origin[0] @ shape.to_world.T
    away = np.cross(shape.centres - origins, shape.axes)
    assert np.abs(away).max() < 1e-9


def test_no_two_discs_hide_each_other(arm, angles):
    """Joints 5 and 6 of a wrist share their origin: their discs must not."""
    shape = arm_shape(arm, angles[0])
    gaps = np.linalg.norm(shape.centres[:, None] - shape.centres, axis=2)[np.triu_indices(len(shape.centres), 1)]
    size = np.linalg.norm(np.ptp(shape.points, axis=0))
    assert gaps.min() > 0.02 * size


def test_each_link_of_the_robot_is_drawn_once(arm, angles):
    places = [place for place, _ in arm_shape(arm, angles[0]).parts]
    assert [p for p in places if p.startswith("link")] == [f"link {j}" for j in range(1, arm.n_joints + 1)]


def test_the_pose_is_a_recorded_one_and_more_legible_than_most(arm, angles):
    row, view = typical_pose(arm, angles)

    def nearest_pair(which):
        shape = arm_shape(arm, angles[which])
        nodes = view.flat(np.vstack([np.zeros(3), shape.centres, shape.tool]))
        gaps = np.linalg.norm(nodes[:, None] - nodes, axis=2)
        return gaps[np.triu_indices(len(nodes), 1)].min() / gaps.max()

    others = [nearest_pair(which) for which in range(len(angles))]
    assert 0 <= row < len(angles)
    assert nearest_pair(row) >= np.median(others)


@pytest.mark.parametrize("gravity", [[0, 0, -9.81], [0, 0, 9.81], [9.81, 0, 0], [3, -4, 5.0], [0, 0, 0]])
def test_gravity_points_down_in_the_picture_however_the_arm_is_mounted(gravity):
    turn = upright(np.array(gravity, dtype=float))
    assert np.allclose(turn @ turn.T, np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1)
    assert np.allclose(turn @ gravity, [0, 0, -np.linalg.norm(gravity)])


def test_a_view_keeps_distances_across_the_line_of_sight():
    view = view_from(0.7, 0.3)
    basis = np.array([view.right, view.up, view.towards])
    assert np.allclose(basis @ basis.T, np.eye(3))
    assert view.up[2] > 0


def test_only_a_parallelogram_arm_gets_a_rod(arm, angles):
    shape = arm_shape(arm, angles[0])
    assert (shape.rod is not None) == has_parallelogram(arm) == (arm.actuation[2, 1] == -1)


def test_the_rod_is_as_long_as_the_upper_arm_in_every_pose():
    """An ideal parallelogram: opposite sides are equal."""
    arm = load_arm(ROBOTS / "sk120.yaml")
    for angles in np.random.default_rng(1).uniform(-0.6, 0.6, (5, arm.n_motors)):
        shoulder, crank_pin, rocker_pin, elbow = arm_shape(arm, angles).rod
        assert np.linalg.norm(rocker_pin - crank_pin) == pytest.approx(np.linalg.norm(elbow - shoulder))
        assert np.linalg.norm(crank_pin - shoulder) == pytest.approx(np.linalg.norm(rocker_pin - elbow))
