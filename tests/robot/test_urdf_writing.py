"""A chain that is written is the chain that pinocchio reads."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from armscope.robot.urdf_writing import (
    WrittenJoint,
    chain_urdf,
    keep_meshes,
    origin_of,
    placement_of,
    set_inertial,
    urdf_text,
)

RNG = np.random.default_rng(5)


def placement() -> np.ndarray:
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = Rotation.random(rng=RNG).as_matrix(), RNG.normal(size=3)
    return made


def test_pinocchio_reads_the_placements_limits_and_masses_that_were_written() -> None:
    joints = [WrittenJoint("a", placement(), (-1.0, 2.0)), WrittenJoint("b", placement(), None)]
    tip, inertia = placement(), np.diag([0.3, 0.2, 0.4]) + 0.01
    robot = chain_urdf("two", joints, "end", tip)
    for number in (1, 2):
        set_inertial(robot.findall("link")[number], 1.5 * number, np.array([0.1, 0.2, 0.3]), inertia)
    model = pin.buildModelFromXML(urdf_text(robot))
    for joint in joints:
        found = model.jointPlacements[model.getJointId(joint.name)].homogeneous
        np.testing.assert_allclose(found, joint.placement, atol=1e-12)
    assert (model.lowerPositionLimit[0], model.upperPositionLimit[0]) == (-1.0, 2.0)
    assert model.joints[2].nq == 2  # without limits
    np.testing.assert_allclose(model.frames[model.getFrameId("end")].placement.homogeneous, tip, atol=1e-12)
    assert model.inertias[2].mass == pytest.approx(3.0)
    np.testing.assert_allclose(model.inertias[1].inertia, inertia)


def test_an_origin_is_read_back_and_a_mass_is_replaced() -> None:
    made = placement()
    np.testing.assert_allclose(placement_of(ET.Element("origin", origin_of(made))), made, atol=1e-12)
    link = ET.Element("link")
    for mass in (1.0, 2.0):
        set_inertial(link, mass, np.zeros(3), np.eye(3))
    assert [each.get("value") for each in link.iter("mass")] == ["2.0"]


def test_meshes_beside_the_file_are_found_from_elsewhere_and_others_stay(tmp_path: Path) -> None:
    robot = ET.Element("robot")
    names = ["meshes/a.stl", "package://arm/b.stl", "/c.stl"]
    for name in names:
        ET.SubElement(robot, "mesh", filename=name)
    keep_meshes(robot, tmp_path / "in" / "arm.urdf", tmp_path / "out")
    assert [mesh.get("filename") for mesh in robot] == ["../in/meshes/a.stl", *names[1:]]
