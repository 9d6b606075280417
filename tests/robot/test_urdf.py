"""URDFs as they come: what is on the chain, what is held, and one error each for what can't be."""

import math
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from armscope.core.inputs import InputError
from armscope.poses.body import collision_shapes
from armscope.robot import forward_kinematics, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

TORSO_ARM = Path(__file__).with_name("torso_arm.urdf")
LIFTED = {"torso_lift": 0.2}


def build(path=TORSO_ARM, tip="flange", hold_joints=LIFTED, **more):
    content = {"name": "arm", "urdf": str(path), "tip": tip, "hold_joints": hold_joints, **more}
    return build_arm(RobotDescription.model_validate(content))


def changed(folder, *changes):
    """The arm of the file with texts replaced, each of which must be there."""
    text = TORSO_ARM.read_text()
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    (folder / "arm.urdf").write_text(text)
    return folder / "arm.urdf"


def test_the_chain_is_what_turns_between_the_root_and_the_tip():
    arm = build(tool_mm=(10, -20, 30))
    assert arm.joint_names == ("pan", "lift", "elbow", "roll", "bend", "turn")
    full = pin.buildModelFromUrdf(str(TORSO_ARM))
    data, tip = full.createData(), full.getFrameId("flange")
    angles = np.random.default_rng(0).uniform(-2, 2, (20, 6))
    for q, point in zip(angles, forward_kinematics(arm, angles), strict=True):
        stored = pin.neutral(full)
        for name, angle in zip(arm.joint_names, q, strict=True):
            joint = full.joints[full.getJointId(name)]
            both = [math.cos(angle), math.sin(angle)]
            stored[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 1 else both
        stored[full.joints[full.getJointId("torso_lift")].idx_q] = 0.2
        pin.framesForwardKinematics(full, data, stored)
        np.testing.assert_allclose(point, data.oMf[tip].act(np.array([0.01, -0.02, 0.03])), atol=1e-12)


def test_joints_without_end_leave_the_limits_of_the_others_as_they_are():
    limits = build().limits
    np.testing.assert_array_equal(limits[[0, 3]], [[-np.inf, np.inf]] * 2)
    np.testing.assert_array_equal(limits[[1, 2, 4, 5]], [[-1.9, 1.9], [-2.2, 0.4], [-1.8, 1.8], [-3, 3]])


def test_a_joint_without_end_is_held_at_its_angle():
    arm, held = build(), build(hold_joints={**LIFTED, "pan": 0.7})
    angles = np.random.default_rng(1).uniform(-1, 1, (5, 5))
    whole = np.insert(angles, 0, 0.7, axis=1)
    np.testing.assert_allclose(forward_kinematics(held, angles), forward_kinematics(arm, whole), atol=1e-12)


def test_the_shapes_for_collisions_stand_where_the_held_joints_put_them(tmp_path):
    box = '<link name="mount"><collision><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link>'
    file = changed(tmp_path, ('<link name="mount"/>', box))
    description = RobotDescription(name="arm", urdf=str(file), tip="flange", hold_joints={**LIFTED, "pan": 0.7})
    (shape,) = collision_shapes(description)
    assert (shape.start[2] + shape.end[2]) / 2 == pytest.approx(0.6 + 0.2 + 0.2)


def test_a_joint_that_mimics_another_turns_by_actuation(tmp_path):
    limit = '<limit lower="-2.2" upper="0.4" effort="100" velocity="1"/>'
    file = changed(tmp_path, (limit, limit + '<mimic joint="lift" multiplier="-1"/>'))
    with pytest.raises(InputError, match=r"joint elbow.*'mimic of lift'.*motor of its own") as error:
        build(file)
    rows = "[{q1: 1}, {q2: 1}, {q2: -1}, {q3: 1}, {q4: 1}, {q5: 1}]"
    assert f"`actuation: {rows}`" in str(error.value)
    actuation = [{"q1": 1}, {"q2": 1}, {"q2": -1}, {"q3": 1}, {"q4": 1}, {"q5": 1}]
    arm = build(file, actuation=actuation)
    assert (arm.n_joints, arm.n_motors) == (6, 5)
    angles = np.random.default_rng(2).uniform(-1, 1, (5, 5))
    whole = np.insert(angles, 2, -angles[:, 1], axis=1)
    np.testing.assert_allclose(forward_kinematics(arm, angles), forward_kinematics(build(), whole), atol=1e-12)
    # a motor takes the limits of the joint that it turns one to one
    np.testing.assert_array_equal(arm.limits[1:3], [[-1.9, 1.9], [-np.inf, np.inf]])
    # without its own motor, held is the other way
    assert build(file, hold_joints={**LIFTED, "elbow": -0.3}).n_motors == 5
    shifted = changed(tmp_path, (limit, limit + '<mimic joint="lift" offset="0.1"/>'))
    with pytest.raises(InputError, match=r"offset of 0\.1 has no place"):
        build(shifted, actuation=actuation)


@pytest.mark.parametrize("name", ["flange", "wrist_3", "wrist_2", "left_finger"])
@pytest.mark.parametrize("joint", ["turn", "finger_1", "flange_fixed", "torso_lift"])
def test_links_may_be_called_as_joints_are(tmp_path, name, joint):
    """As in URDFs from the field, where pinocchio finds two frames of the name."""
    file = changed(tmp_path, (f'"{name}"', f'"{joint}"'))
    arm, usual = build(file, tip=joint if name == "flange" else "flange"), build()
    assert arm.joint_names == usual.joint_names
    angles = np.random.default_rng(3).uniform(-1, 1, (5, 6))
    np.testing.assert_allclose(forward_kinematics(arm, angles), forward_kinematics(usual, angles), atol=1e-12)


def test_links_without_inertia_weigh_nothing(tmp_path):
    arm = build()
    np.testing.assert_allclose(arm.masses, [3, 4, 2, 1, 0, 0])
    text = TORSO_ARM.read_text()
    while "<inertial>" in text:
        start = text.index("<inertial>")
        text = text[:start] + text[text.index("</inertial>") + len("</inertial>") :]
    (tmp_path / "light.urdf").write_text(text)
    assert not build(tmp_path / "light.urdf").has_masses


def test_a_urdf_named_relative_to_its_robot_yaml_is_found_from_anywhere(tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "arm.urdf").write_text(TORSO_ARM.read_text())
    (tmp_path / "robot.yaml").write_text("name: a\nurdf: sub/arm.urdf\ntip: flange\nhold_joints: {torso_lift: 0.1}\n")
    monkeypatch.chdir(tmp_path)
    description = load_arm("robot.yaml").description
    monkeypatch.chdir("/")
    assert build_arm(description).n_motors == 6


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"tip": "flang"}, ["tip", "'flang'", "Did you mean 'flange'"]),
        ({"tip": "floor"}, ["tip", "no joint moves"]),
        ({"tip": "torso"}, ["hold_joints", "every joint of the chain is held"]),
        ({"hold_joints": {}}, ["joint torso_lift", "a sliding joint", "hold_joints: {torso_lift: 0}"]),
        ({"hold_joints": {"torso_lft": 0}}, ["'torso_lft'", "Did you mean 'torso_lift'"]),
        ({"hold_joints": {**LIFTED, "mount_fixed": 0}}, ["'mount_fixed'", "does not move"]),
        ({"hold_joints": {"torso_lift": 200}}, ["torso_lift", "200", "0 and 0.35 m"]),
        ({"hold_joints": {**LIFTED, "lift": 45}}, ["lift", "45", "-1.9 and 1.9 rad"]),
        ({"joint_limits_deg": [[-1, 1]] * 7}, ["pan, lift, elbow", "6 motors", "has 7"]),
        ({"joint_limits_deg": [[1, -1]] * 6}, ["low < high"]),
        ({"actuation": [{"q1": 1}] * 5}, ["6 joints of the chain", "has 5"]),
        ({"actuation": [{"q1": 1}] * 5 + [{"q3": 1}]}, ["up to q3", "q2 turns no joint"]),
    ],
)
def test_what_robot_yaml_says_of_a_urdf_must_fit_it(more, words):
    with pytest.raises(InputError) as error:
        build(**more)
    for word in words:
        assert word in str(error.value), error.value


PAN = '<joint name="pan" type="continuous">'
FINGER = '<joint name="finger_1" type="prismatic">'
LIMIT = '<limit lower="-3" upper="3" effort="100" velocity="1"/>'


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ([("</robot>", "")], ["line", "no XML"]),
        ([(TORSO_ARM.read_text(), "")], ["line 1", "no XML"]),
        ([("<robot name", "<sdf name"), ("</robot>", "</sdf>")], ["<sdf>", "one <robot>"]),
        ([("0.35 0 0.03", "${length} 0 0.03")], ["<origin>", "xacro"]),
        ([("<link ", "<lnk "), ("</link>", "</lnk>")], ["no <link>"]),
        ([(LIMIT, "")], ["joint turn", "no <limit>", "continuous"]),
        ([(LIMIT, '<limit lower="-3" upper="3"/>')], ["joint turn", "no effort"]),
        ([(PAN, PAN.replace("continuous", "continous"))], ["joint pan, type", "'continuous'"]),
        ([(PAN, PAN.replace("continuous", "planar"))], ["joint pan", "a planar joint", "Make it a fixed joint"]),
        ([(PAN, PAN.replace("continuous", "floating"))], ["joint pan", "a floating joint"]),
        ([('<axis xyz="0 -1 0"/>\n    <limit lower="-2.2"', '<axis xyz="0 0 0"/>\n    <limit lower="-2.2"')],
         ["joint elbow, axis", "direction"]),
        ([("0.35 0 0.03", "0.35 nan 0.03")], ["joint roll, origin xyz", "0.35 nan 0.03", "three finite numbers"]),
        ([("0.35 0 0.03", "0,35 0 0,03")], ["joint roll, origin xyz", "three finite numbers"]),
        ([('<child link="mount"/>', '<child link="mont"/>')], ["mount_fixed, child", "'mont'", "'mount'"]),
        ([('<child link="right_finger"/>', '<child link="left_finger"/>')], ["left_finger", "2 joints"]),
        ([('<link name="floor"/>', '<link name="floor"/><link name="lost"/>')], ["floor, lost", "one root"]),
        ([(FINGER, FINGER.replace("finger_1", "elbow"))], ["joint elbow", "2 of that name"]),
    ],
)  # fmt: skip
def test_one_error_says_what_is_wrong_in_a_urdf(tmp_path, changes, words):
    with pytest.raises(InputError) as error:
        build(changed(tmp_path, *changes))
    assert str(error.value).startswith(str(tmp_path / "arm.urdf"))
    for word in words:
        assert word in str(error.value), error.value


def test_a_joint_of_several_coordinates_is_not_held_by_one_number(tmp_path):
    with pytest.raises(InputError, match=r"pan.*several coordinates.*fixed joint"):
        build(changed(tmp_path, (PAN, PAN.replace("continuous", "planar"))), hold_joints={**LIFTED, "pan": 0.1})


def test_a_linkage_belongs_to_dh_rows():
    bars = {"crank_mm": 100, "rocker_mm": 100, "rod_mm": 300, "upper_arm_mm": 300}
    with pytest.raises(ValueError, match="`parallelogram` needs `dh` rows"):
        build(parallelogram=bars)
