"""Any chain of hinges has D-H rows that move its tool and load its motors alike."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armscope.core.inputs import InputError
from armscope.robot import Arm, chain, forward_kinematics, load_arm, twist_jacobian
from armscope.robot.arm import build_arm
from armscope.robot.denavit_hartenberg import as_dh, row_twist
from armscope.robot.description import RobotDescription
from armscope.robot.gravity import gravity_torques
from tests.robot.arms import CONFIG
from tests.robot.test_three_forms import urdf_arm


def chain_urdf(steps):
    """A URDF of joints at (xyz, rpy, axis), each link with a mass off its axis."""
    parts, parent = ['<robot name="r"><link name="base"/>'], "base"
    for number, (xyz, rpy, axis) in enumerate(steps, start=1):
        child = "flange" if number == len(steps) else f"l{number}"
        numbers = [" ".join(repr(float(value)) for value in each) for each in (xyz, rpy, axis)]
        parts.append(
            f'<link name="{child}"><inertial><mass value="{number}"/><origin xyz="0.1 0.02 0.{number}"/>'
            '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="j{number}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{numbers[0]}" rpy="{numbers[1]}"/><axis xyz="{numbers[2]}"/>'
            '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        )
        parent = child
    return "".join(parts) + "</robot>"


def same(arm, seed=0, tolerance=1e-9):
    description, base = as_dh(arm)
    rows = build_arm(description)
    q = np.random.default_rng(seed).uniform(-3, 3, (20, arm.n_motors))
    placed = forward_kinematics(rows, q) @ base[:3, :3].T + base[:3, 3]
    assert np.abs(placed - forward_kinematics(arm, q)).max() < tolerance
    loads = gravity_torques(arm, chain(arm, q))
    assert np.abs(gravity_torques(rows, chain(rows, q)) - loads).max() < 100 * tolerance


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 7))
def test_rows_of_random_chains_move_the_tool_alike(tmp_path_factory, seed, n_joints):
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(n_joints, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    steps = [(rng.uniform(-1, 1, 3), rng.uniform(-1.5, 1.5, 3), axis) for axis in axes]
    more = {"tool_mm": (20, -10, 80), "tool_load": {"mass_kg": 3, "com_mm": (0, 10, 40)}, "gravity_m_s2": (1, 2, -9)}
    arm = urdf_arm(tmp_path_factory.mktemp("u"), None, chain_urdf(steps), **more)
    # axes that nearly meet or nearly run parallel lose digits, as D-H rows do
    try:
        same(arm, seed, 1e-7)
    except InputError:  # a common normal that is 20 m away, of axes a few degrees apart
        assert most_parallel(arm) < 0.2


def most_parallel(arm):
    """Sine of the angle between those neighbouring axes that are most nearly parallel."""
    q = np.zeros((1, arm.n_motors))
    axes = [chain(arm, q).frame(f"joint {j}")[0][0][:, 2] for j in range(1, arm.n_motors + 1)]
    return min(np.linalg.norm(np.cross(a, b)) for a, b in itertools.pairwise(axes))


def test_axes_too_nearly_parallel_for_rows_are_one_clear_error(tmp_path):
    steps = ([0, 0, 0.3], [0, 0, 0], [0, 0, 1]), ([0.4, 0.2, 0.1], [0, 0, 0], [1e-5, 0, 1])
    with pytest.raises(InputError, match=r"joints 1 and 2.*nearly parallel.*exactly parallel"):
        as_dh(urdf_arm(tmp_path, None, chain_urdf(steps)))


PARALLEL = ([0, 0, 0.3], [0, 0, 0], [0, 0, 1]), ([0.4, 0, 0.1], [0, 0, 0.2], [0, 0, 1])
OPPOSITE = (*PARALLEL, ([0.3, 0.1, 0], [0, 0, 0], [0, 0, -1]))
CROSSING = (
    ([0, 0, 0.3], [0, 0, 0], [0, 0, 1]),
    ([0, 0, 0.2], [0, 0, 0], [0, 1, 0]),
    ([0, 0.1, 0], [0, 0, 0], [0, 1, 0]),
)


@pytest.mark.parametrize("steps", [PARALLEL, OPPOSITE, CROSSING])
def test_parallel_opposite_crossing_and_coinciding_axes(steps, tmp_path):
    same(urdf_arm(tmp_path, None, chain_urdf(steps), tool_mm=(30, 40, 50)))


@pytest.mark.parametrize("robot", ["sk120", "six-axis", "seven-axis"])
def test_an_arm_of_rows_becomes_the_same_arm(robot):
    same(load_arm(CONFIG / "robots" / f"{robot}.yaml"))


def test_limits_and_couplings_of_motors_stay():
    arm = load_arm(CONFIG / "robots" / "sk120.yaml")
    description, _ = as_dh(arm)
    assert np.allclose(build_arm(description).actuation, arm.actuation)
    low, high = build_arm(description).limits.T
    assert np.allclose(low, arm.limits[:, 0])
    assert np.allclose(high, arm.limits[:, 1])


def test_a_joint_that_mimics_another_is_refused_and_can_be_held(tmp_path):
    text = chain_urdf(CROSSING).replace(
        '<joint name="j3" type="revolute">', '<joint name="j3" type="revolute"><mimic joint="j2"/>'
    )
    from armscope.core.inputs import InputError

    with pytest.raises(InputError, match=r"joint j3: found 'mimic of j2'.*hold_joints: \{j3: 0\}"):
        urdf_arm(tmp_path, None, text)
    assert urdf_arm(tmp_path, None, text, hold_joints={"j3": 0.0}).n_motors == 2


def test_a_joint_without_limits_can_be_held_at_an_angle(tmp_path):
    text = chain_urdf(CROSSING).replace('name="j1" type="revolute"', 'name="j1" type="continuous"')
    held = urdf_arm(tmp_path, None, text, hold_joints={"j1": 0.7}, tool_mm=(30, 40, 50))
    free = build_arm(RobotDescription(name="u", urdf=str(tmp_path / "arm.urdf"), tip="flange", tool_mm=(30, 40, 50)))
    q = np.array([[0.2, -0.4], [1.0, 0.5]])
    expected = forward_kinematics(free, np.column_stack([[0.7, 0.7], q]))
    assert np.abs(forward_kinematics(held, q) - expected).max() < 1e-12
    assert (
        np.abs(
            Rotation.from_rotvec([0, 0, -0.7]).apply(expected) - forward_kinematics(free, np.insert(q, 0, 0, 1))
        ).max()
        < 1e-12
    )


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("beta_deg", [0.0, 7.0])
def test_a_constant_moves_the_tool_as_a_row_written_anew_does(convention: str, beta_deg: float) -> None:
    rng = np.random.default_rng(0)
    fields = {"a": "a_mm", "alpha": "alpha_deg", "d": "d_mm", "theta": "theta_offset_deg", "beta": "beta_deg"}
    row = {"a_mm": 300.0, "alpha_deg": 40.0, "d_mm": 200.0, "theta_offset_deg": 10.0, "beta_deg": beta_deg}

    def arm(joint: int = 1, **more: float) -> Arm:
        joints = [row | (more if j == joint else {}) for j in range(1, 4)]
        content = {"name": "test", "dh": {"convention": convention, "joints": joints}, "tool_mm": [50, 60, 70]}
        return build_arm(RobotDescription.model_validate(content))

    angles, nominal, step = rng.uniform(-2, 2, (5, 3)), arm(), 1e-6
    for joint in (1, 2, 3):
        for kind, field in fields.items():
            in_file = 1e3 if field.endswith("mm") else np.degrees(1.0)
            two = [
                forward_kinematics(arm(joint, **{field: row[field] + side * step * in_file}), angles)
                for side in (1, -1)
            ]
            location, twist = row_twist(nominal, joint, kind)
            moved = twist_jacobian(chain(nominal, angles), location) @ twist
            np.testing.assert_allclose(moved, (two[0] - two[1]) / (2 * step), atol=1e-7, err_msg=f"{kind} {joint}")
