"""A calibrated arm as files: corrected robot.yaml and URDF that load back to the calibrated positions."""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np

from armscope.calibration.result import Calibration
from armscope.core.files import write_text, write_yaml, yaml_text
from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.robot import Arm
from armscope.robot.controllers import UR_KINEMATICS, ZEROS_IN_IT, ur_kinematics
from armscope.robot.urdf_writing import (
    WrittenJoint,
    add_frame,
    chain_urdf,
    keep_meshes,
    origin_of,
    placement_of,
    set_inertial,
    turns_of_file,
    urdf_text,
    what_drives_can,
)

TIP, TOOL = "calibrated_flange", "calibrated_tool"


def export(calibration: Calibration, folder: Path | str, target: str | None = None) -> tuple[Path, ...]:
    """Write the calibrated arm.

    Into ``folder``: ``robot.yaml`` (corrected D-H rows and the tool of one target), ``robot.urdf`` with
    ``robot_urdf.yaml`` that names it, ``ur_kinematics.yaml`` for arms of Universal Robots, and ``frames.yaml``: base
    frames, tools and compliances, which an arm's description has no place for. For an arm that came from a URDF,
    ``robot.yaml`` names the corrected URDF: its joints' origins are changed, all else stays.

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
        write_text(folder / "robot.urdf", _corrected_urdf(calibration, tool * 1e-3, folder))
        tip = {"tip": calibration.arm.description.tip, "hold_joints": calibration.arm.description.hold_joints}
        write_yaml(folder / "robot.yaml", {"name": common.pop("name"), **by_urdf, **tip, **common})
        written = ["robot.yaml", "robot.urdf"]
    else:
        table = calibration.arm.description.dh.model_dump(exclude_defaults=True) | {
            "joints": [
                {name: value for name, value in row.model_dump().items() if name != "beta_deg" or value != 0}
                for row in calibration.arm.description.dh.joints
            ]
        }
        described = calibration.arm.description.model_dump(
            mode="json", exclude_defaults=True, include={"links", "tool_load", "parallelogram"}
        )
        name = common.pop("name")
        write_yaml(folder / "robot.yaml", {"name": name, "dh": table, **common, **described})
        write_text(folder / "robot.urdf", _fresh_urdf(calibration.arm, tool * 1e-3))
        write_yaml(folder / "robot_urdf.yaml", {"name": name, **by_urdf, "tip": TIP, **common})
        written = ["robot.yaml", "robot.urdf", "robot_urdf.yaml"]
        if (kinematics := ur_kinematics(calibration.arm)) and calibration.state.constants.any():
            write_text(folder / UR_KINEMATICS, f"# {ZEROS_IN_IT}\n{yaml_text(kinematics)}")
            written.append(UR_KINEMATICS)
    write_yaml(folder / "frames.yaml", frames_content(calibration))
    return tuple(folder / name for name in [*written, "frames.yaml"])


def frames_content(calibration: Calibration) -> dict[str, Any]:
    """Base frames (measurement frame from arm base), tools and compliances, in the units of their names."""
    from scipy.spatial.transform import Rotation  # slow to import

    state, rows = calibration.state, calibration.set_up
    quaternions = np.roll(Rotation.from_matrix(state.rotations).as_quat(canonical=True), 1, axis=1)
    content: dict[str, Any] = {
        "rms_distance_mm": calibration.rms_distance * 1e3,
        "base_frames": [
            {"run": name, "position_mm": position, "quaternion_wxyz": quaternion} | _not_told(calibration, "base", name)
            for name, position, quaternion in zip(rows.base_names, state.translations * 1e3, quaternions, strict=True)
        ],
        "tools": [
            {"target": name, "tool_mm": tool} | _not_told(calibration, "tool", name)
            for name, tool in zip(rows.tool_names, state.tools * 1e3, strict=True)
        ],
    }
    if state.compliances.any():
        content["compliances_rad_per_nm"] = {
            f"q{motor}": value for motor, value in enumerate(state.compliances, start=1) if value != 0
        }
        content["loads"] = rows.load_source
    return content


def _not_told(calibration: Calibration, frame: str, name: str) -> dict[str, list[str]]:
    """Which of a base's or tool's numbers rows do not tell, as in a run of one pose; nothing where they tell all."""
    start = f"{frame} of {name} " if name else f"{frame} "
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


def _fresh_urdf(arm: Arm, tool: Array) -> str:
    """The arm's chain as a URDF, with its masses as points, and a link at the tool (3,), m."""
    ends_at_motor = arm.description.actuation is None
    drives = what_drives_can(arm.description) if ends_at_motor else []
    drives, joints = drives or [{}] * len(arm.before), []
    for joint, placement in enumerate(arm.before):
        low, high = arm.limits[joint] if ends_at_motor else (-np.inf, np.inf)
        limits = (low, high) if np.isfinite([low, high]).all() else None
        joints.append(WrittenJoint(f"joint_{joint + 1}", placement, limits, **drives[joint]))
    robot = chain_urdf(arm.name, joints, TIP, arm.tip)
    for mass, centre, link in zip(arm.masses, arm.centres, robot.findall("link")[1:-1], strict=True):
        if mass > 0:
            set_inertial(link, mass, centre, np.zeros((3, 3)))
    add_frame(robot, TIP, TOOL, _at(tool))
    robot.insert(0, ET.Comment("effort and velocity limits are placeholders; masses are points, good for statics only"))
    return urdf_text(robot)


def _corrected_urdf(calibration: Calibration, tool: Array, folder: Path) -> str:
    """The nominal URDF with its joints' origins corrected, and a link at the tool (3,), m; the rest stays.

    A file that was calibrated before has the tool of then: the new one has a name of its own.
    """
    nominal, arm = calibration.set_up.arm, calibration.arm
    file = Path(str(nominal.description.urdf))
    robot = ET.parse(file).getroot()
    keep_meshes(robot, file, folder)
    elements = {element.get("name"): element for element in robot.findall("joint")}
    for joint, turn in enumerate(turns_of_file(nominal)):
        correction = turn @ np.linalg.inv(nominal.before[joint]) @ arm.before[joint] @ np.linalg.inv(turn)
        element = elements[nominal.model.names[joint + 1]]
        origin = element.find("origin")
        if origin is None:
            origin = ET.SubElement(element, "origin")
        for name, words in origin_of(placement_of(origin) @ correction).items():
            origin.set(name, words)
    taken = {link.get("name") for link in robot.findall("link")}
    names = itertools.chain([TOOL], (f"{TOOL}_{n}" for n in itertools.count(2)))
    name = next(name for name in names if name not in taken)
    add_frame(robot, str(nominal.description.tip), name, _at(tool))
    return urdf_text(robot)


def _at(tool: Array) -> Array:
    """(4, 4) of a tool (3,), m, in the last frame."""
    placement = np.eye(4)
    placement[:3, 3] = tool
    return placement
