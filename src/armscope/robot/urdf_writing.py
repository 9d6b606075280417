"""URDF as XML that is written: a chain of hinges, origins, masses, and meshes that stay where they are."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from armscope.core.types import Array
from armscope.robot.constants import AXIS, WRITTEN

if TYPE_CHECKING:
    from armscope.robot.arm import Arm
    from armscope.robot.description import RobotDescription

BASE = "base"


class WrittenJoint(NamedTuple):
    """A hinge of a chain."""

    name: str
    placement: Array  # (4, 4) its frame in that of the joint before; it turns about z
    limits: tuple[float, float] | None  # (low, high) rad; None where it has none
    # effort, speed: N m and rad/s, the most that its drive can
    effort: float = WRITTEN.effort
    speed: float = WRITTEN.speed


def chain_urdf(name: str, joints: Sequence[WrittenJoint], flange: str, tip: Array) -> ET.Element:
    """A chain as a URDF: every link in the frame of its joint, whose z is the axis; a flange at its end.

    Args:
        name: of the arm.
        joints: from the base on.
        flange: what the link at its end is called.
        tip: (4, 4) where that is in the last joint's frame.

    Returns:
        The root; links are called link_1, link_2, ...
    """
    robot = ET.Element("robot", name=name)
    # MuJoCo takes no body without mass and inertia, and would melt the flange into the last link; others skip this
    ET.SubElement(ET.SubElement(robot, "mujoco"), "compiler", boundmass="1e-9", boundinertia="1e-9", fusestatic="false")
    ET.SubElement(robot, "link", name=BASE)
    parent = BASE
    for number, joint in enumerate(joints, start=1):
        link = f"link_{number}"
        ET.SubElement(robot, "link", name=link)
        element = _add_joint(robot, joint.name, "continuous", (parent, link), joint.placement)
        ET.SubElement(element, "axis", xyz="0 0 1")
        if joint.limits is not None:
            element.set("type", "revolute")
            low, high = (repr(float(limit)) for limit in joint.limits)
            ET.SubElement(
                element, "limit", lower=low, upper=high, effort=_said(joint.effort), velocity=_said(joint.speed)
            )
        parent = link
    add_frame(robot, parent, flange, tip)
    return robot


def what_drives_can(description: RobotDescription) -> list[dict[str, float]]:
    """`effort` and `speed` of a `WrittenJoint` by motor, as far as robot.yaml states them."""
    found = []
    for drive in description.drives or ():
        stated = {"effort": drive.torque_nm, "speed": drive.speed_deg_s and float(np.radians(drive.speed_deg_s))}
        found.append({name: value for name, value in stated.items() if value is not None})
    return found


def _said(number: float) -> str:
    return f"{number:.9g}"


def add_frame(robot: ET.Element, parent: str, name: str, placement: Array) -> None:
    """A frame that is fixed to a link, as a link without mass.

    Args:
        robot: the root, which is changed.
        parent: the link that it is fixed to.
        name: of the frame.
        placement: (4, 4) where it is in the link's frame.
    """
    ET.SubElement(robot, "link", name=name)
    _add_joint(robot, f"{name}_fixed", "fixed", (parent, name), placement)


def _add_joint(robot: ET.Element, name: str, kind: str, links: tuple[str, str], placement: Array) -> ET.Element:
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=links[0])
    ET.SubElement(joint, "child", link=links[1])
    ET.SubElement(joint, "origin", origin_of(placement))
    return joint


def fix_joint(joint: ET.Element, moved: Array) -> None:
    """Let a joint (changed) stay where it has moved to, (4, 4), from its origin."""
    origin = joint.find("origin")
    placement = moved if origin is None else placement_of(origin) @ moved
    joint.set("type", "fixed")
    for element in list(joint):
        if element.tag not in ("parent", "child"):
            joint.remove(element)
    ET.SubElement(joint, "origin", origin_of(placement))


def set_inertial(link: ET.Element, mass: float, centre: Array, inertia: Array) -> None:
    """Give a link its mass.

    Args:
        link: changed; what it said of its mass before goes.
        mass: kg.
        centre: (3,) of mass, in the link's frame, m.
        inertia: (3, 3) about the centre of mass, along the link's axes, kg m^2.
    """
    for old in link.findall("inertial"):
        link.remove(old)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_words(centre), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=repr(float(mass)))
    names = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    ET.SubElement(inertial, "inertia", {name: repr(float(inertia[at])) for name, at in names.items()})


def origin_of(placement: Array) -> dict[str, str]:
    """A placement (4, 4) as the attributes of an origin."""
    from scipy.spatial.transform import Rotation  # slow to import

    turn = Rotation.from_matrix(placement[:3, :3]).as_euler("xyz", suppress_warnings=True)
    return {"xyz": _words(placement[:3, 3]), "rpy": _words(turn)}


def placement_of(origin: ET.Element) -> Array:
    """(4, 4) of an origin's attributes."""
    from scipy.spatial.transform import Rotation  # slow to import

    placement = np.eye(4)
    placement[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
    placement[:3, :3] = Rotation.from_euler("xyz", _numbers(origin.get("rpy", "0 0 0"))).as_matrix()
    return placement


def turns_of_file(arm: Arm) -> Array:
    """(n, 4, 4) for each joint of a URDF's chain, the turn from the file's axes of it to axes with z along its axis."""
    turns, turn = np.empty((arm.n_joints, 4, 4)), np.eye(4)
    for joint in range(arm.n_joints):
        placement = arm.model.jointPlacements[joint + 1].homogeneous
        turn = turns[joint] = np.linalg.inv(placement) @ turn @ arm.before[joint]
    return turns


def axes_told(arm: Arm) -> Array:
    """(n, 4, 4) turns from the axes in which errors of a URDF's joint are told to axes with z along the joint's axis.

    They are the file's own, unless the joint turns about none of these: then there is no turn.
    """
    turns = np.linalg.inv(turns_of_file(arm))
    along = np.isclose(np.abs(turns[:, 2, :3]).max(axis=1), 1.0, atol=AXIS.along)
    return np.where(along[:, None, None], turns, np.eye(4))


def origins_of_file(arm: Arm) -> Array:
    """(n, 4, 4) the origins of the chain's joints as their URDF states them."""
    elements = {
        element.get("name"): element for element in ET.parse(str(arm.description.urdf)).getroot().findall("joint")
    }
    found = (elements[name].find("origin") for name in arm.joint_names)
    return np.array([np.eye(4) if origin is None else placement_of(origin) for origin in found])


def keep_meshes(robot: ET.Element, source: Path, folder: Path) -> None:
    """Let names of meshes beside a URDF lead there from another folder, too.

    Args:
        robot: the file's root; changed.
        source: the file.
        folder: where it is to be written.
    """
    for mesh in robot.iter("mesh"):
        name = mesh.get("filename", "")
        if "://" not in name and not Path(name).is_absolute():
            mesh.set("filename", Path(os.path.relpath(source.parent / name, folder.resolve())).as_posix())


def urdf_text(robot: ET.Element) -> str:
    """The file's text, a line an element."""
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"


def _numbers(words: str) -> Array:
    return np.array([float(word) for word in words.split()])


def _words(values: Array) -> str:
    return " ".join(repr(float(value)) for value in values)
