"""A calibrated arm as files: corrected robot.yaml and URDF that load back to the calibrated positions."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.calibration.calibrate import Calibration
from armscope.core.files import write_text, write_yaml
from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.robot import Arm

TIP = "calibrated_flange"
FILES = ("robot.yaml", "robot.urdf", "robot_urdf.yaml", "frames.yaml")
"""All that `export` may write."""


def export(calibration: Calibration, folder: Path | str, target: str | None = None) -> tuple[Path, ...]:
    """Write the calibrated arm.

    Into ``folder``: ``robot.yaml`` (corrected D-H rows and the tool of one target), ``robot.urdf`` with
    ``robot_urdf.yaml`` that names it, and ``frames.yaml``: base frames, tools and compliances, which an arm's
    description has no place for. For an arm that came from a URDF, ``robot.yaml`` names the corrected URDF: its joints'
    origins are changed, all else stays.

    Args:
        calibration: what to write.
        folder: where to.
        target: whose tool becomes ``tool_mm``; None takes the first.

    Returns:
        The files that were written.

    Raises:
        InputError: a target that the recordings do not have.
    """
    names = calibration.set_up.tool_names
    target = names[0] if target is None else target
    if target not in names:
        raise InputError("export", "target", target, "the recordings have no such target", nearest(target, names))
    folder, tool = Path(folder), calibration.state.tools[names.index(target)] * 1e3
    common = _common(calibration.arm, tool)
    by_urdf = {"urdf": "robot.urdf"}
    if calibration.arm.description.dh is None:
        write_text(folder / "robot.urdf", _corrected_urdf(calibration, folder))
        tip = {"tip": calibration.arm.description.tip, "hold_joints": calibration.arm.description.hold_joints}
        write_yaml(folder / "robot.yaml", {"name": common.pop("name"), **by_urdf, **tip, **common})
        written = ["robot.yaml", "robot.urdf"]
    else:
        table = calibration.arm.description.dh.model_dump(exclude_defaults=True) | {
            "joints": [_row(row.model_dump()) for row in calibration.arm.description.dh.joints]
        }
        described = _described(calibration.arm)
        name = common.pop("name")
        write_yaml(folder / "robot.yaml", {"name": name, "dh": table, **common, **described})
        write_text(folder / "robot.urdf", _fresh_urdf(calibration.arm))
        write_yaml(folder / "robot_urdf.yaml", {"name": name, **by_urdf, "tip": TIP, **common})
        written = ["robot.yaml", "robot.urdf", "robot_urdf.yaml"]
    write_yaml(folder / "frames.yaml", frames_content(calibration))
    return tuple(folder / name for name in [*written, "frames.yaml"])


def frames_content(calibration: Calibration) -> dict[str, Any]:
    """Base frames (measurement frame from arm base), tools and compliances, in the units of their names."""
    state, rows = calibration.state, calibration.set_up
    quaternions = np.roll(Rotation.from_matrix(state.rotations).as_quat(canonical=True), 1, axis=1)
    content: dict[str, Any] = {
        "rms_distance_mm": calibration.rms_distance * 1e3,
        "base_frames": [
            {"run": name, "position_mm": position, "quaternion_wxyz": quaternion} | _not_told(calibration, name)
            for name, position, quaternion in zip(rows.base_names, state.translations * 1e3, quaternions, strict=True)
        ],
        "tools": [
            {"target": name, "tool_mm": tool} for name, tool in zip(rows.tool_names, state.tools * 1e3, strict=True)
        ],
    }
    if state.compliances.any():
        content["compliances_rad_per_nm"] = {
            f"q{motor}": value for motor, value in enumerate(state.compliances, start=1) if value != 0
        }
        content["loads"] = rows.load_source
    return content


def _not_told(calibration: Calibration, run: str) -> dict[str, list[str]]:
    """Which of a base frame's numbers the rows do not tell, as in a run of one pose; nothing where they tell all."""
    start = f"base of {run} " if run else "base "
    axes = [each.name.removeprefix(start) for each in calibration.held if each.name.startswith(start)]
    return {"not_identified": [axis for axis in axes if " " not in axis]} if axes else {}


def _common(arm: Arm, tool_mm: Array) -> dict[str, Any]:
    """What a description says beside its geometry and masses."""
    keep = arm.description.model_dump(
        mode="json", exclude_defaults=True, include={"name", "actuation", "joint_limits_deg", "instrument"}
    )
    if arm.description.dh is None and arm.description.tool_load is not None:
        keep["tool_load"] = arm.description.tool_load.model_dump(mode="json")
    return keep | {"tool_mm": tool_mm.tolist(), "gravity_m_s2": list(arm.description.gravity_m_s2)}


def _described(arm: Arm) -> dict[str, Any]:
    """Masses and linkage, which a URDF carries itself or has no place for."""
    return arm.description.model_dump(
        mode="json", exclude_defaults=True, include={"links", "tool_load", "parallelogram"}
    )


def _row(row: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in row.items() if name != "beta_deg" or value != 0}


def _fresh_urdf(arm: Arm) -> str:
    """The arm's chain as a URDF: every link in the frame of its joint, whose z is the axis."""
    robot = ET.Element("robot", name=arm.name)
    robot.append(ET.Comment("effort and velocity limits are placeholders; masses are points, good for statics only"))
    # MuJoCo takes no body without mass and inertia, and would melt the flange into the last link; others skip this
    extension = ET.SubElement(robot, "mujoco")
    ET.SubElement(extension, "compiler", boundmass="1e-9", boundinertia="1e-9", fusestatic="false")
    ET.SubElement(robot, "link", name="base")
    ends_at_motor = arm.description.actuation is None
    parent = "base"
    for joint in range(arm.n_joints):
        name = f"link_{joint + 1}"
        link = ET.SubElement(robot, "link", name=name)
        if arm.masses[joint] > 0:
            _add_point_mass(link, arm.masses[joint], arm.centres[joint])
        limits = arm.limits[joint] if ends_at_motor else np.array([-np.inf, np.inf])
        element = _add_joint(robot, f"joint_{joint + 1}", "continuous", parent, name, arm.before[joint])
        ET.SubElement(element, "axis", xyz="0 0 1")
        if np.isfinite(limits).all():
            element.set("type", "revolute")
            lower, upper = (repr(float(limit)) for limit in limits)
            ET.SubElement(element, "limit", lower=lower, upper=upper, effort="1000", velocity="10")
        parent = name
    ET.SubElement(robot, "link", name=TIP)
    _add_joint(robot, "flange_fixed", "fixed", parent, TIP, arm.tip)
    return _as_text(robot)


def _add_joint(robot: ET.Element, name: str, kind: str, parent: str, child: str, placement: Array) -> ET.Element:
    joint = ET.SubElement(robot, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", _origin(placement))
    return joint


def _add_point_mass(link: ET.Element, mass: float, centre: Array) -> None:
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_words(centre), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=repr(float(mass)))
    ET.SubElement(inertial, "inertia", ixx="0", ixy="0", ixz="0", iyy="0", iyz="0", izz="0")


def _corrected_urdf(calibration: Calibration, folder: Path) -> str:
    """The nominal URDF with the origins of the chain's joints corrected; meshes, names and other joints stay."""
    nominal, arm = calibration.set_up.arm, calibration.arm
    file = Path(str(nominal.description.urdf))
    robot = ET.parse(file).getroot()
    for mesh in robot.iter("mesh"):
        name = mesh.get("filename", "")
        if "://" not in name and not Path(name).is_absolute():  # beside the nominal file: seen from the new one
            mesh.set("filename", Path(os.path.relpath(file.parent / name, folder.resolve())).as_posix())
    elements = {element.get("name"): element for element in robot.findall("joint")}
    turn = np.eye(4)
    for joint in range(arm.n_joints):
        placement = nominal.model.jointPlacements[joint + 1].homogeneous
        # from the joint's own axes, as in the file, to axes with z along its axis
        turn = np.linalg.inv(placement) @ turn @ nominal.before[joint]
        correction = turn @ np.linalg.inv(nominal.before[joint]) @ arm.before[joint] @ np.linalg.inv(turn)
        element = elements[nominal.model.names[joint + 1]]
        origin = element.find("origin")
        if origin is None:
            origin = ET.SubElement(element, "origin")
        for name, words in _origin(_placement_of(origin) @ correction).items():
            origin.set(name, words)
    return _as_text(robot)


def _placement_of(origin: ET.Element) -> Array:
    placement = np.eye(4)
    placement[:3, 3] = _numbers(origin.get("xyz", "0 0 0"))
    rpy = _numbers(origin.get("rpy", "0 0 0"))
    placement[:3, :3] = Rotation.from_euler("xyz", rpy).as_matrix()
    return placement


def _origin(placement: Array) -> dict[str, str]:
    return {
        "xyz": _words(placement[:3, 3]),
        "rpy": _words(Rotation.from_matrix(placement[:3, :3]).as_euler("xyz", suppress_warnings=True)),
    }


def _numbers(words: str) -> Array:
    return np.array([float(word) for word in words.split()])


def _words(values: Array) -> str:
    return " ".join(repr(float(value)) for value in values)


def _as_text(robot: ET.Element) -> str:
    ET.indent(robot)
    return '<?xml version="1.0"?>\n' + ET.tostring(robot, encoding="unicode") + "\n"
