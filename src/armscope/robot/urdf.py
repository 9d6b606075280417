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

from armscope.core.inputs import InputError, nearest, note_read
from armscope.core.types import Array
from armscope.robot.description import RobotDescription

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "planar", "floating")
SLIDING = "a sliding joint"
KINDS = {"P": SLIDING, "Planar": "a planar joint", "FreeFlyer": "a floating joint", "Translation": "a planar joint"}
"""What joints that do not turn are called, by how pinocchio's names of them begin (behind "JointModel")."""
LONGEST_COMPLAINT = 300
BEYOND_LIMITS = 0.01
"""A joint may be held beyond its limits by this share of its range: recorded positions are not exact."""


class SerialPart(NamedTuple):
    """How a whole robot becomes one arm: joints to lock, in which configuration, and what its tip is called then."""

    locked: list[int]
    configuration: Array
    tip: str


def read_urdf(path: str) -> pin.Model:
    """The whole robot of a URDF; meshes are not looked at.

    Raises:
        InputError: it is no URDF, or one that contradicts itself.
    """
    _check(path, _root(path))
    said: list[str] = []
    try:
        with _errors_kept(said):
            return pin.buildModelFromUrdf(path)
    except (ValueError, RuntimeError) as error:
        cure = " ".join(said)[:LONGEST_COMPLAINT] or "`check_urdf` may say more."
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
            lines = kept.read(100 * LONGEST_COMPLAINT).decode(errors="replace").splitlines()
            said += [line.removeprefix("Error:").strip() for line in lines[:3] if line.strip()]


def cut(description: RobotDescription, full: pin.Model) -> SerialPart:
    """What is locked, and where, so that the chain from the root to the tip is left without the joints that are held.

    Raises:
        InputError: the tip, or a joint to hold, is not there or not possible; or nothing is left.
    """
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
            cure = "Make it a fixed joint in the file."
            if other == SLIDING:
                cure = f"Hold it where it stood (m): `hold_joints: {{{name}: 0}}`."
            raise InputError(file, f"joint {name}", other, "only turning joints can be diagnosed", cure)


def _root(path: str) -> ET.Element:
    note_read(path)
    try:
        root = ET.parse(path).getroot()
    except OSError as error:
        raise InputError(path, "", "no readable file", "a URDF is needed here", error.strerror or "") from error
    except ET.ParseError as error:
        line, column = error.position
        place = f"line {line}, column {column + 1}"
        raise InputError(path, place, "no XML", "a URDF is an XML file", str(error).partition(":")[0] + ".") from error
    if root.tag != "robot":
        raise InputError(path, "", f"<{root.tag}>", "a URDF is one <robot>", "Other formats must be converted first.")
    for element in root.iter():
        if "xacro" in element.tag or any("${" in value or "$(" in value for value in element.attrib.values()):
            found = element.tag.rpartition("}")[2]
            rule = "macros must be expanded first"
            raise InputError(path, f"<{found}>", "a xacro file", rule, "`xacro arm.urdf.xacro > arm.urdf` does it.")
    return root


def _check(path: str, root: ET.Element) -> None:
    """Names, references, numbers and the tree; the first thing that is wrong becomes an `InputError`."""
    links = [element.get("name", "") for element in root.findall("link")]
    joints = root.findall("joint")
    if not links:
        raise InputError(path, "", "no <link>", "a URDF has links and joints", "Is it a file of macros or settings?")
    for kind, names in (("link", links), ("joint", [joint.get("name", "") for joint in joints])):
        for name, count in Counter(names).items():
            if not name or count > 1:
                rule = "every one needs a name of its own"
                raise InputError(path, f"{kind} {name}".rstrip(), f"{count} of that name" if name else "no name", rule)
    parents = Counter(child for joint in joints for child in _ends(path, joint, links)[1:])
    for name, count in parents.items():
        if count > 1:
            raise InputError(path, f"link {name}", f"child of {count} joints", "a URDF is a tree: no closed loops")
    roots = [name for name in links if name not in parents]
    if len(roots) != 1:
        found = f"{len(roots)} links without parent" + (f": {', '.join(roots[:5])}" if roots else "")
        raise InputError(path, "", found, "all links must hang together, from one root", "Is a joint missing?")
    for joint in joints:
        _check_joint(path, joint)


def _ends(path: str, joint: ET.Element, links: list[str]) -> list[str]:
    ends = []
    for role in ("parent", "child"):
        element = joint.find(role)
        name = "" if element is None else element.get("link", "")
        if name not in links:
            place = f"joint {joint.get('name')}, {role}"
            raise InputError(path, place, name or "nothing", "no link of that name", nearest(name, links))
        ends.append(name)
    return ends


def _check_joint(path: str, joint: ET.Element) -> None:
    place, kind = f"joint {joint.get('name')}", joint.get("type", "nothing")
    if kind not in JOINT_TYPES:
        raise InputError(path, f"{place}, type", kind, "no such type", nearest(kind, JOINT_TYPES))
    for tag, key in (("origin", "xyz"), ("origin", "rpy"), ("axis", "xyz")):
        element = joint.find(tag)
        words = None if element is None else element.get(key)
        if words is None:
            continue
        numbers = _three_numbers(path, f"{place}, {tag} {key}", words)
        if tag == "axis" and kind not in ("fixed", "floating") and not numbers.any():
            raise InputError(path, f"{place}, axis", words, "an axis needs a direction")
    if kind in ("revolute", "prismatic"):
        limit = joint.find("limit")
        for key in ("effort", "velocity"):
            if limit is None or limit.get(key) is None:
                rule = f'a {kind} joint needs <limit lower="..." upper="..." effort="..." velocity="..."/>'
                cure = "A joint that turns without end is `continuous`." if kind == "revolute" else ""
                raise InputError(path, place, "no <limit>" if limit is None else f"no {key} in <limit>", rule, cure)


def _three_numbers(path: str, place: str, words: str) -> Array:
    try:
        numbers = np.array([float(word) for word in words.split()])
    except ValueError:
        numbers = np.array([])
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise InputError(path, place, words, "three finite numbers")
    return numbers


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
        slack = BEYOND_LIMITS * (high - low)
        if low < high and not low - slack <= value <= high + slack:
            unit = "m" if held.shortname().startswith("JointModelP") else "rad"
            rule = f"its limits are {low:g} and {high:g} {unit}"
            raise InputError(file, f"hold_joints: {name}", value, rule, f"It is a number of {unit}.")
    return joint


def _refuse_followers(description: RobotDescription, full: pin.Model, chain: list[int]) -> None:
    """A joint that mimics another has no motor of its own, unless `actuation` says what turns it.

    Raises:
        InputError: the chain has one.
    """
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
    for joint in ET.parse(path).getroot().findall("joint"):
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
