"""What is exported simulates the arm: in MuJoCo the gap closes; a URDF is read back; a table holds every number."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import yaml

from armscope.core.types import Array
from armscope.motion.export import corrected_urdf, export_motion, parameter_table
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.simulated_bodies import bodies
from armscope.robot.constants import WRITTEN
from armscope.robot.description import Drive
from armscope.robot.dynamics import build_moving_arm, load_moving_arm
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, moved, path, robot

LOAD = {"mass_kg": 1.5, "com_mm": [0, 0, 0]}


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    """An arm with a payload that nobody stated."""
    return diagnose_motion(robot(), moved(robot(tool_load=LOAD), 3, seconds=15.0), MotionSettings(cutoff=10.0))


@pytest.fixture(scope="module")
def folder(found: MotionDiagnosis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("export")
    export_motion(found.model, found.selected, found.sure.factor, out)
    return out


def simulated(model: mujoco.MjModel, q: Array, dq: Array, ddq: Array) -> Array:
    """Torque by MuJoCo's inverse dynamics."""
    data, torque = mujoco.MjData(model), np.empty_like(q)
    for row in range(len(q)):
        data.qpos[:], data.qvel[:], data.qacc[:] = q[row], dq[row], ddq[row]
        mujoco.mj_inverse(model, data)
        torque[row] = data.qfrc_inverse
    return torque


def test_simulated_in_mujoco_the_gap_closes(found: MotionDiagnosis, folder: Path) -> None:
    _, q, dq, ddq = (each[::20] for each in path(np.random.default_rng(99), 3, 15.0, 200.0))  # a path nobody has seen
    actual = robot(tool_load=LOAD)
    data = actual.model.createData()
    rigid = np.array([pin.rnea(actual.model, data, *row).copy() for row in zip(q, dq, ddq, strict=True)])
    torque = rigid + COULOMB * np.sign(dq) + VISCOUS * dq + ROTOR * ddq
    plain = replace(found.model, joints=np.zeros_like(found.model.joints), causes=(), inertial=found.arm.inertial)
    export_motion(plain, found.selected, found.sure.factor, folder / "stated")
    moving = np.abs(dq).min(axis=1) > 0.05  # MuJoCo's dry friction is soft where a joint turns back
    stated, fitted = (mujoco.MjModel.from_xml_path(str(at / "mujoco.xml")) for at in (folder / "stated", folder))
    before, after = (torque - simulated(model, q, dq, ddq) for model in (stated, fitted))
    size = np.linalg.norm(torque[moving])
    assert np.linalg.norm(before[moving]) > 0.2 * size
    assert np.linalg.norm(after[moving]) < 0.02 * size


def test_the_urdf_simulates_as_the_mjcf_does_but_for_rotors(folder: Path) -> None:
    q, dq, ddq = np.random.default_rng(4).uniform(-1, 1, (3, 20, 3))
    dq += 0.2 * np.sign(dq)  # MuJoCo's dry friction is soft near rest, and the softer the more a rotor weighs
    whole = mujoco.MjModel.from_xml_path(str(folder / "mujoco.xml"))
    urdf = mujoco.MjModel.from_xml_path(str(folder / "corrected.urdf"))
    expected = simulated(whole, q, dq, ddq) - whole.dof_armature * ddq
    np.testing.assert_allclose(simulated(urdf, q, dq, ddq), expected, atol=1e-6)
    assert np.abs(whole.dof_armature * ddq).max() > 1e-3


def test_limits_of_drives_are_those_stated_or_none_that_binds(found: MotionDiagnosis) -> None:
    drives = (Drive(torque_nm=100.0, speed_deg_s=180.0), Drive(torque_nm=101.0, speed_deg_s=180.0), Drive())
    limits = [(-100.0, 100.0)] * 3
    description = found.arm.description.model_copy(update={"drives": drives, "joint_limits_deg": limits})
    model = replace(found.model, arm=replace(found.arm, description=description))
    told = [each.attrib for each in ET.fromstring(corrected_urdf(model, Path())).iter("limit")]
    assert [float(each["effort"]) for each in told] == [100.0, 101.0, WRITTEN.effort]
    np.testing.assert_allclose([float(each["velocity"]) for each in told], [np.pi, np.pi, WRITTEN.speed])


def test_the_urdf_is_an_arm_with_the_fitted_masses(found: MotionDiagnosis, folder: Path) -> None:
    content = {"name": "again", "urdf": "corrected.urdf", "tip": "flange"}
    (folder / "robot.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    again = load_moving_arm(folder / "robot.yaml")
    expected = np.concatenate([body.toDynamicParameters() for body in bodies(found.model)[0]])
    np.testing.assert_allclose(again.inertial, expected, atol=1e-9)
    assert again.joint_names == found.arm.joint_names
    # an arm that came from a URDF keeps it: the same numbers written once more
    export_motion(
        replace(found.model, arm=again, inertial=again.inertial, causes=()),
        found.selected,
        found.sure.factor,
        folder / "kept",
    )
    (folder / "kept" / "robot.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    np.testing.assert_allclose(load_moving_arm(folder / "kept" / "robot.yaml").inertial, again.inertial, atol=1e-9)


WITH_A_HAND = """<robot name="hand"><link name="base"/>
{moving}
<link name="wrist"/>
<joint name="wrist" type="fixed"><parent link="l2"/><child link="wrist"/><origin xyz=".3 0 0"/></joint>
{held}</robot>"""
LINK = """<link name="{0}"><inertial><origin xyz=".1 .02 .01"/><mass value="{1}"/>
<inertia ixx=".02" iyy=".03" izz=".03" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{2}" type="{3}"><parent link="{4}"/><child link="{0}"/><origin xyz="{5}" rpy="0.1 0 0.2"/><axis xyz="{6}"/>
<limit lower="-3" upper="3" effort="9" velocity="9"/></joint>"""


@pytest.fixture
def hand(tmp_path: Path) -> Path:
    """robot.yaml of two joints that carry a finger, which slides, and a thumb, which turns; both are held elsewhere."""
    moving = LINK.format("l1", 8, "j1", "revolute", "base", "0 0 .3", "0 0 1")
    moving += LINK.format("l2", 5, "j2", "revolute", "l1", ".4 0 0", "0 1 0")
    held = LINK.format("finger", 0.5, "slide", "prismatic", "wrist", ".05 .03 0", "0 1 0")
    held += LINK.format("thumb", 0.4, "turn", "revolute", "wrist", ".05 -.03 0", "0 0.6 0.8")
    (tmp_path / "arm.urdf").write_text(WITH_A_HAND.format(moving=moving, held=held), encoding="utf-8")
    content = {"name": "hand", "urdf": "arm.urdf", "tip": "wrist", "hold_joints": {"slide": 0.02, "turn": 0.7}}
    (tmp_path / "robot.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    return tmp_path / "robot.yaml"


def test_what_the_arm_holds_is_fixed_where_it_is_held(found: MotionDiagnosis, hand: Path) -> None:
    """Fingers without mass slid freely: no simulator took them."""
    arm = load_moving_arm(hand)
    fitted = {"inertial": arm.inertial, "causes": (), "joints": np.ones((2, 7)), "gains": np.zeros(2)}
    model = replace(found.model, arm=arm, width_of_sides=None, order_of_sides=None, **fitted)
    (hand.parent / "corrected.urdf").write_text(corrected_urdf(model, hand.parent), encoding="utf-8")
    (hand.parent / "again.yaml").write_text(yaml.safe_dump({"name": "a", "urdf": "corrected.urdf", "tip": "thumb"}))
    again = load_moving_arm(hand.parent / "again.yaml")
    whole = mujoco.MjModel.from_xml_path(str(hand.parent / "corrected.urdf"))
    np.testing.assert_allclose(again.inertial, arm.inertial, atol=1e-12)
    assert whole.nv == 2
    poses = [each.model.frames[each.model.getFrameId("thumb")].placement.homogeneous for each in (arm, again)]
    np.testing.assert_allclose(poses[1], poses[0], atol=1e-12)


def test_a_motor_that_turns_its_joint_the_other_way_has_its_friction(found: MotionDiagnosis) -> None:
    """One sign in `actuation` took friction and rotors off all joints; its limits are its motor's, turned."""
    turned = found.arm.description.model_copy(
        update={"actuation": [{"q1": 1.0}, {"q2": -1.0}, {"q3": 1.0}], "joint_limits_deg": [(-100.0, 20.0)] * 3}
    )
    model = replace(found.model, arm=build_moving_arm(turned))
    robot_file = ET.fromstring(corrected_urdf(model, Path()))
    dry = [float(each.get("friction", 0)) for each in robot_file.iter("dynamics")]
    np.testing.assert_allclose(dry, model.joints[:, 1])
    within = [(float(each.get("lower", 0)), float(each.get("upper", 0))) for each in robot_file.iter("limit")]
    np.testing.assert_allclose(np.degrees(within), [(-100, 20), (-20, 100), (-100, 20)])


def test_limits_of_motors_that_turn_several_joints_are_no_joints(found: MotionDiagnosis) -> None:
    coupled = found.arm.description.model_copy(
        update={"actuation": [{"q1": 1.0}, {"q2": 1.0}, {"q3": 1.0, "q2": -1.0}], "joint_limits_deg": [(-9.0, 9.0)] * 3}
    )
    assert "<limit" not in corrected_urdf(replace(found.model, arm=build_moving_arm(coupled)), Path())


def test_the_table_holds_every_parameter_with_its_error(found: MotionDiagnosis, folder: Path) -> None:
    table = parameter_table(found.model, found.selected, found.sure.factor)
    assert len(table) == 3 * 10 + 3 * 4
    told = {(row["place"], row["parameter"]): row for row in table.to_dict("records")}
    assert told["link 3", "m"]["stated"] == pytest.approx(4.0)
    assert told["link 3", "m"]["fitted"] == pytest.approx(5.5, abs=0.2)
    for joint in range(3):
        dry = told[f"joint {joint + 1}", "coulomb"]
        assert dry["fitted"] == pytest.approx(COULOMB[joint], rel=0.05)
        assert 0 < dry["stderr"] < 0.05 * COULOMB[joint]
    assert re.match(r"place,parameter,unit,stated,fitted,stderr\n", (folder / "parameters.csv").read_text())
