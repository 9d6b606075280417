"""One arm as standard D-H, modified D-H and URDF; written-out matrices and MuJoCo as oracles that share no code."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from armscope.core.inputs import InputError
from armscope.robot import chain, forward_kinematics, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from tests.robot.arms import SK120, STANDARD, TOOL_MM, as_modified, as_urdf, dh_arm, random_rows, standard_transform


@pytest.fixture
def angles():
    return np.random.default_rng(1).uniform(-3, 3, (200, 6))


def urdf_arm(folder, rows, text=None, **more):
    file = folder / "arm.urdf"
    file.write_text(text or as_urdf(rows))
    return build_arm(RobotDescription(name="u", urdf=str(file), tip="flange", **more))


def test_three_forms_of_one_arm_agree_to_a_nanometre(angles, tmp_path):
    standard = forward_kinematics(dh_arm(STANDARD, tool_mm=TOOL_MM), angles)
    modified = forward_kinematics(dh_arm(as_modified(STANDARD), "modified", tool_mm=TOOL_MM), angles)
    urdf = forward_kinematics(urdf_arm(tmp_path, STANDARD, tool_mm=TOOL_MM), angles)
    assert np.abs(modified - standard).max() < 1e-9
    assert np.abs(urdf - standard).max() < 1e-9
    assert np.ptp(standard, axis=0).min() > 1  # the poses do go places


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), n_joints=st.integers(1, 8))
def test_any_standard_table_is_the_product_of_its_written_out_matrices(seed, n_joints):
    rng = np.random.default_rng(seed)
    rows = random_rows(rng, n_joints)
    arm = dh_arm(rows, tool_mm=TOOL_MM)
    for q in rng.uniform(-3, 3, (3, n_joints)):
        pose = np.eye(4)
        for row, angle in zip(rows, q, strict=True):
            pose = pose @ standard_transform(row, angle)
        expected = pose @ [*(np.array(TOOL_MM) * 1e-3), 1]
        assert np.abs(forward_kinematics(arm, q)[0] - expected[:3]).max() < 1e-12


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), n_joints=st.integers(1, 8))
def test_any_modified_table_agrees_with_craigs_matrix(seed, n_joints):
    rng = np.random.default_rng(seed)
    rows = random_rows(rng, n_joints)
    arm = dh_arm(rows, "modified", tool_mm=TOOL_MM)
    q = rng.uniform(-3, 3, n_joints)
    pose = np.eye(4)
    for (a, alpha, d, offset), angle in zip(rows, q, strict=True):
        theta, alpha = angle + np.radians(offset), np.radians(alpha)
        ct, s, ca, sa, d = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha), d * 1e-3
        pose = pose @ [
            [ct, -s, 0, a * 1e-3],
            [s * ca, ct * ca, -sa, -sa * d],
            [s * sa, ct * sa, ca, ca * d],
            [0, 0, 0, 1],
        ]
    assert np.abs(forward_kinematics(arm, q)[0] - (pose @ [*(np.array(TOOL_MM) * 1e-3), 1])[:3]).max() < 1e-12


def mujoco_arm(rows, tool_mm):
    """MJCF of a standard D-H table: a hinge about z, then the fixed rest of the row as the next body's place."""

    def place(row):
        a, alpha, d, theta = row
        turn = Rotation.from_euler("z", theta, degrees=True)
        x, y, z, w = (turn * Rotation.from_euler("x", alpha, degrees=True)).as_quat()
        xyz = turn.apply([a, 0, d]) * 1e-3
        return 'pos="{} {} {}" quat="{} {} {} {}"'.format(*map(float, (*xyz, w, x, y, z)))

    body, last = "", 'pos="0 0 0"'
    for number, row in enumerate(rows):
        body += f'<body {last}><joint name="j{number}" axis="0 0 1"/><geom size="0.01" mass="1"/>'
        last = place(row)
    site = " ".join(repr(value * 1e-3) for value in tool_mm)
    body += f'<body {last}><geom size="0.01" mass="1"/><site name="tool" pos="{site}"/></body>' + "</body>" * len(rows)
    return mujoco.MjModel.from_xml_string(f"<mujoco><compiler angle='radian'/><worldbody>{body}</worldbody></mujoco>")


def test_mujoco_puts_the_tool_where_we_do():
    rng = np.random.default_rng(3)
    for n_joints in (2, 6, 7):
        rows = random_rows(rng, n_joints)
        model = mujoco_arm(rows, TOOL_MM)
        data = mujoco.MjData(model)
        angles = rng.uniform(-3, 3, (20, n_joints))
        ours = chain(dh_arm(rows, tool_mm=TOOL_MM), angles)
        for row, q in enumerate(angles):
            data.qpos[:] = q
            mujoco.mj_kinematics(model, data)
            assert np.abs(ours.tool[row] - data.site_xpos[0]).max() < 1e-9
            assert np.abs(ours.tool_rotation[row] - data.site_xmat[0].reshape(3, 3)).max() < 1e-9


def test_a_wrong_row_is_seen_by_the_oracle():
    rows = [list(row) for row in STANDARD]
    model = mujoco_arm(rows, TOOL_MM)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    rows[2][0] += 0.001
    assert np.abs(forward_kinematics(dh_arm(rows, tool_mm=TOOL_MM), np.zeros(6))[0] - data.site_xpos[0]).max() > 1e-7


def test_joint_axes_of_a_urdf_may_point_anywhere(tmp_path):
    text = (
        '<robot name="r"><link name="base"/><link name="a"/><link name="flange"/>'
        '<joint name="one" type="continuous"><parent link="base"/><child link="a"/>'
        '<origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/>'
        '<axis xyz="0 0.6 -0.8"/></joint>'
        '<joint name="two" type="revolute"><parent link="a"/><child link="flange"/>'
        '<origin xyz="0.5 0 0.1"/><axis xyz="-1 0 0"/>'
        '<limit lower="-1" upper="2" effort="1" velocity="1"/></joint></robot>'
    )
    arm = urdf_arm(tmp_path, None, text, tool_mm=(30, 40, 50))
    q = np.array([[0.3, -1.1], [0, 0], [-2.5, 0.7]])
    place = Rotation.from_euler("xyz", [0.1, 0.2, 0.3])
    for (one, two), tool in zip(q, forward_kinematics(arm, q), strict=True):
        first = place * Rotation.from_rotvec(one * np.array([0, 0.6, -0.8]))
        second = Rotation.from_rotvec(two * np.array([-1, 0, 0]))
        expected = np.array([0.1, 0.2, 0.3]) + first.apply(np.array([0.5, 0, 0.1]) + second.apply([0.03, 0.04, 0.05]))
        assert np.abs(tool - expected).max() < 1e-12


def test_motors_move_the_chain_through_the_actuation_map():
    arm = load_arm(SK120)
    plain = dh_arm(STANDARD, tool_mm=(205.32, 0, 0))
    q = np.random.default_rng(4).uniform(-1, 1, (20, 6))
    theta = q.copy()
    theta[:, 2] = q[:, 2] - q[:, 1]
    assert np.abs(forward_kinematics(arm, q) - forward_kinematics(plain, theta)).max() < 1e-12


def test_reach_is_an_upper_bound():
    rng = np.random.default_rng(5)
    arm = dh_arm(random_rows(rng, 6), tool_mm=TOOL_MM)
    distances = np.linalg.norm(forward_kinematics(arm, rng.uniform(-3, 3, (2000, 6))), axis=1)
    assert distances.max() <= arm.reach
    assert arm.reach < 2 * distances.max()


def test_a_urdf_without_the_tip_names_the_nearest_frame(tmp_path):
    file = tmp_path / "arm.urdf"
    file.write_text(as_urdf(STANDARD))
    with pytest.raises(InputError, match=r"flage.*Did you mean 'flange'"):
        build_arm(RobotDescription(name="u", urdf=str(file), tip="flage"))


def test_a_sliding_joint_is_refused_and_can_be_held(tmp_path):
    text = (
        '<robot name="r"><link name="base"/><link name="a"/><link name="flange"/>'
        '<joint name="rail" type="prismatic"><parent link="base"/><child link="a"/><axis xyz="1 0 0"/>'
        '<limit lower="0" upper="2" effort="1" velocity="1"/></joint>'
        '<joint name="two" type="revolute"><parent link="a"/><child link="flange"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="2" effort="1" velocity="1"/></joint></robot>'
    )
    with pytest.raises(InputError, match="rail"):
        urdf_arm(tmp_path, None, text)
    held = urdf_arm(tmp_path, None, text, hold_joints={"rail": 0.5}, tool_mm=(100, 0, 0))
    assert np.abs(forward_kinematics(held, [[0.0]]) - [0.6, 0, 0]).max() < 1e-12
