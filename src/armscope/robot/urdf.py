"""A URDF file: read with one clear answer to whatever is wrong in it, and cut down to the chain of one arm."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.robot.constants import ARMS, PASTED
from armscope.robot.description import RobotDescription
from armscope.robot.urdf_file import root_of

SLIDING = "a sliding joint"
KINDS = {"P": SLIDING, "Planar": "a planar joint", "FreeFlyer": "a floating joint", "Translation": "a planar joint"}
"""What joints that do not turn are called, by how pinocchio's names of them begin (behind "JointModel")."""


class SerialPart(NamedTuple):
    """How a whole robot becomes one arm: joints to lock, in which configuration, and what its tip is called then."""

    locked: list[int]
    configuration: Array
    tip: str


def read_urdf(path: str) -> pin.Model:
    """The whole robot of a URDF; meshes are not looked at. Raises InputError: it is no URDF, or one that contradicts
    itself."""
    root_of(path)
    said: list[str] = []
    try:
        with _errors_kept(said):
            return pin.buildModelFromUrdf(path)
    except (ValueError, RuntimeError) as error:
        cure = " ".join(said)[: PASTED.complaint] or "`check_urdf` may say more."
        raise InputError(path, "", "no valid URDF", str(error).rstrip("."), cure) from error


@contextlib.contextmanager
def _errors_kept(said: list[str]) -> Iterator[None]:
    """What the URDF library writes to standard error, past Python: the user gets one error, not two."""
    sys.stderr.flush()
    with tempfile.TemporaryFile() as kept:
        before = os.dup(2)
        os.dup2(kept.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(before, 2)
            os.close(before)
            kept.seek(0)
            lines = kept.read(100 * PASTED.complaint).decode(errors="replace").splitlines()
            said += [line.removeprefix("Error:").strip() for line in lines[:3] if line.strip()]


def cut(description: RobotDescription, full: pin.Model) -> SerialPart:
    """What is locked, and where, so that the chain from the root to the tip is left without the joints that are
    held. Raises InputError: the tip, or a joint to hold, is not there or not possible; or nothing is left."""
    file, tip = description.urdf, str(description.tip)
    if not full.existFrame(tip):
        names = [frame.name for frame in full.frames]
        raise InputError(file, "tip", tip, "no frame of that name", nearest(tip, names))
    frame = frame_named(full, tip)
    supports = full.supports[frame.parentJoint].tolist()
    configuration, left = pin.neutral(full), set(supports) - {0}
    if not left:
        rule = "no joint moves between the root and this frame, so there is no arm"
        raise InputError(file, "tip", tip, rule, "The tip is the frame that carries the tool.")
    for name, value in description.hold_joints.items():
        joint = _to_hold(file, full, name, value)
        held = full.joints[joint]
        # a joint without limits is stored as cosine and sine of its angle
        configuration[held.idx_q : held.idx_q + held.nq] = value if held.nq == 1 else [np.cos(value), np.sin(value)]
        left.discard(joint)
    if not left:
        raise InputError(file, "hold_joints", ", ".join(description.hold_joints), "every joint of the chain is held")
    _refuse_followers(description, full, sorted(left))
    _tell_frames_apart(full)
    return SerialPart([joint for joint in range(1, full.njoints) if joint not in left], configuration, frame.name)


def held_joints(description: RobotDescription) -> dict[str, Array]:
    """(4, 4) by name: how far each joint that is not of the chain has moved from its origin, where it is held."""
    full = read_urdf(str(description.urdf))
    locked, configuration, _ = cut(description, full)
    data = full.createData()
    pin.forwardKinematics(full, data, configuration)
    moved = {joint: full.jointPlacements[joint].actInv(data.liMi[joint]) for joint in locked}
    return {str(full.names[joint]): np.asarray(placement.homogeneous) for joint, placement in moved.items()}


def frame_named(model: pin.Model, name: str) -> pin.Frame:
    """The frame of a name that is there; the link's where a joint is called so, too."""
    there = [frame for frame in model.frames if frame.name == name]
    return next((frame for frame in there if frame.type == pin.FrameType.BODY), there[0])


def _tell_frames_apart(full: pin.Model) -> None:
    """Links and fixed joints that share a name with another frame get one of their own: pinocchio goes by names."""
    names = Counter(frame.name for frame in full.frames)
    for frame in full.frames:
        if frame.type != pin.FrameType.JOINT and names[frame.name] > 1:
            frame.name += " (link)" if frame.type == pin.FrameType.BODY else " (fixed)"


def refuse_other_than_turning(file: str, model: pin.Model, sliding: bool = False) -> None:
    """Only hinges can be diagnosed; in motion, joints that slide along one axis, too.

    Args:
        file: the URDF, for the error.
        model: the chain.
        sliding: whether joints may slide.

    Raises:
        InputError: a joint of the chain is none of these.
    """
    for joint in range(1, model.njoints):
        name, kind = model.names[joint], model.joints[joint].shortname().removeprefix("JointModel")
        other = next((told for begin, told in sorted(KINDS.items(), reverse=True) if kind.startswith(begin)), "")
        if other and not (sliding and other == SLIDING):
            rule, cure = "joints turn, or slide along one axis", "Make it a fixed joint in the file."
            if other == SLIDING:
                rule = "only turning joints can be diagnosed by poses or planned for; `diagnose motions.csv` takes both"
                cure = f"Hold it where it stood (m): `hold_joints: {{{name}: 0}}`."
            raise InputError(file, f"joint {name}", other, rule, cure)


def _to_hold(file: str | None, full: pin.Model, name: str, value: float) -> int:
    if not full.existJointName(name):
        if full.existFrame(name):
            raise InputError(file, "hold_joints", name, "this does not move anyway", "Leave it out.")
        moving = list(full.names)[1:]
        raise InputError(file, "hold_joints", name, "no joint of that name", nearest(name, moving))
    joint = int(full.getJointId(name))
    held = full.joints[joint]
    if held.nv != 1:
        rule = "a joint of several coordinates cannot be held by one number"
        raise InputError(file, f"hold_joints: {name}", value, rule, "Make it a fixed joint in the file.")
    if held.nq == 1:
        low, high = float(full.lowerPositionLimit[held.idx_q]), float(full.upperPositionLimit[held.idx_q])
        slack = ARMS.beyond_limits * (high - low)
        if low < high and not low - slack <= value <= high + slack:
            unit = "m" if held.shortname().startswith("JointModelP") else "rad"
            rule = f"its limits are {low:g} and {high:g} {unit}"
            raise InputError(file, f"hold_joints: {name}", value, rule, f"It is a number of {unit}.")
    return joint


def _refuse_followers(description: RobotDescription, full: pin.Model, chain: list[int]) -> None:
    """A joint that mimics another has no motor of its own, unless `actuation` says what turns it. Raises InputError:
    the chain has one."""
    followers = {int(full.getJointId(name)): (name, mimic) for name, mimic in _mimics(str(description.urdf), full)}
    for joint in chain:
        if joint not in followers:
            continue
        name, mimic = followers[joint]
        place, found = f"joint {name}", f"mimic of {mimic.get('joint')}"
        offset = float(mimic.get("offset", 0))
        if description.actuation is not None and offset == 0:
            continue
        if offset:
            rule = f"its offset of {offset:g} has no place in `actuation`"
            cure = f"Turn the joint's <origin> by it and drop it; or hold the joint: `hold_joints: {{{name}: 0}}`."
            raise InputError(description.urdf, place, found, rule, cure)
        cure = f"Hold it (`hold_joints: {{{name}: 0}}`)"
        rows = _actuation_rows(full, chain, followers)
        cure += f", or say what turns it: `actuation: [{', '.join(rows)}]`." if rows else "."
        raise InputError(description.urdf, place, found, "every joint of the chain needs a motor of its own", cure)


def _mimics(path: str, full: pin.Model) -> Iterator[tuple[str, ET.Element]]:
    for joint in root_of(path).findall("joint"):
        mimic, name = joint.find("mimic"), joint.get("name", "")
        if mimic is not None and full.existJointName(name):
            yield name, mimic


def _actuation_rows(full: pin.Model, chain: list[int], followers: dict[int, tuple[str, Any]]) -> list[str]:
    """What to write into robot.yaml; empty where a joint follows one that is not on the chain, or follows itself."""
    motors = {joint: number for number, joint in enumerate((j for j in chain if j not in followers), start=1)}
    rows = []
    for joint in chain:
        factor, leader = 1.0, joint
        if joint in followers:
            mimic = followers[joint][1]
            factor, name = float(mimic.get("multiplier", 1)), mimic.get("joint", "")
            leader = int(full.getJointId(name)) if full.existJointName(name) else -1
        if leader not in motors:
            return []
        rows.append(f"{{q{motors[leader]}: {factor:g}}}")
    return rows
