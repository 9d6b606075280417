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
from armscope.motion.export import bodies, export_motion, joint_numbers, not_in_a_file, parameter_table
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.robot.dynamics import load_moving_arm
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


def simulated(urdf: str, joints: ET.Element | None, q: Array, dq: Array, ddq: Array) -> Array:
    """Torque by MuJoCo's inverse dynamics, with attributes of mujoco.xml on the joints where they are given."""
    spec = mujoco.MjSpec.from_string(urdf)
    for joint in [] if joints is None else joints.findall("joint"):
        named = spec.joint(str(joint.get("name")))
        named.armature, named.frictionloss = (float(str(joint.get(name))) for name in ("armature", "frictionloss"))
        named.damping = [float(str(joint.get("damping"))), 0.0, 0.0]
    model = spec.compile()
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
    corrected = (folder / "corrected.urdf").read_text(encoding="utf-8")
    joints = ET.fromstring((folder / "mujoco.xml").read_text(encoding="utf-8"))
    plain = replace(found.model, joints=np.zeros_like(found.model.joints), causes=(), inertial=found.arm.inertial)
    export_motion(plain, found.selected, found.sure.factor, folder / "stated")
    stated = (folder / "stated" / "corrected.urdf").read_text(encoding="utf-8")
    moving = np.abs(dq).min(axis=1) > 0.05  # MuJoCo's dry friction is soft where a joint turns back
    before = torque - simulated(stated, None, q, dq, ddq)
    after = torque - simulated(corrected, joints, q, dq, ddq)
    size = np.linalg.norm(torque[moving])
    assert np.linalg.norm(before[moving]) > 0.2 * size
    assert np.linalg.norm(after[moving]) < 0.02 * size


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


def test_what_no_simulator_takes_is_mended_and_said(found: MotionDiagnosis) -> None:
    negative = found.model.joints.copy()
    negative[1, 3] = -0.2
    weightless = found.model.inertial.copy()
    weightless[10:20] = 0
    weightless[13] = 0.5
    odd = replace(found.model, joints=negative, inertial=weightless)
    numbers, notes = joint_numbers(odd)
    assert numbers[1, 2] == 0
    assert "joint 2: rotor inertia came out at -0.2" in notes[0]
    made, notes = bodies(odd)
    assert np.linalg.eigvalsh(made[1].inertia).min() > 0
    assert made[1].mass > 0
    assert any(note.startswith("link 2") for note in notes)
    assert not_in_a_file(replace(odd, gains=np.array([0, 0.1, 0]))) == ["gain of joint 2 +0.1"]


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
