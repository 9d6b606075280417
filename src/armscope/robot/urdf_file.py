"""A URDF as XML: what contradicts itself in it, and which of its links carries the tool. Meshes are not looked at."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from armscope.core.inputs import InputError, nearest, note_read
from armscope.core.streams import at_hand
from armscope.robot.constants import ARMS, PASTED
from armscope.robot.urdf_checks import refuse_contradictions

TURNING = ("revolute", "continuous")
TOOL_NAMES = ("tool0", "tool", "tcp", "tool_link", "tool_frame", "flange", "ee_link", "end_effector", "ee")
"""What the link that carries the tool is usually called, the commonest first (ROS-Industrial's convention)."""

HANDS = ("gripper", "finger")  # Joints of these names open a hand; the arm ends before them


class GuessedChain(NamedTuple):
    """The frame that carries the tool, sliding joints before it with where they are held, and what is said of both."""

    tip: str
    held: dict[str, float]
    guesses: dict[str, str]


def is_xml(path: Path | str) -> bool:
    """Whether a file that is there begins as XML does."""
    try:
        with at_hand(path).open("rb") as stream:
            return stream.read(PASTED.start).lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")
    except OSError:
        return False


def root_of(path: str) -> ET.Element:
    """The one <robot> of a URDF that does not contradict itself. Raises InputError: it is no URDF, or contradicts
    itself; the joint or link is named."""
    root = _parsed(path)
    if root.tag != "robot":
        raise InputError(path, "", f"<{root.tag}>", "a URDF is one <robot>", "Other formats must be converted first.")
    for element in root.iter():
        if "xacro" in element.tag or any("${" in value or "$(" in value for value in element.attrib.values()):
            found = element.tag.rpartition("}")[2]
            rule = "macros must be expanded first"
            raise InputError(path, f"<{found}>", "a xacro file", rule, "`xacro arm.urdf.xacro > arm.urdf` does it.")
    refuse_contradictions(path, root)
    return root


def _parsed(path: str) -> ET.Element:
    note_read(path)
    try:
        content = at_hand(path).read_bytes()
    except OSError as error:
        raise InputError(path, "", "no readable file", "a URDF is needed here", error.strerror or "") from error
    try:
        return ET.fromstring(content)
    except ET.ParseError as error:
        if "unbound prefix" in str(error):
            return ET.fromstring(_with_prefixes_bound(path, content, error))
        raise _no_xml(path, error) from error


def _no_xml(path: str, error: ET.ParseError) -> InputError:
    line, column = error.position
    place = f"line {line}, column {column + 1}"
    return InputError(path, place, "no XML", "a URDF is an XML file", str(error).partition(":")[0] + ".")


def _with_prefixes_bound(path: str, content: bytes, error: ET.ParseError) -> bytes:
    """Tags of other programs (<drake:...>) whose prefix nobody declared: URDF readers pass over them, and so do we.
    Raises InputError: it is no XML for another reason, too."""
    prefixes = sorted(set(re.findall(rb"[<\s]([A-Za-z_][\w.-]*):[A-Za-z_]", content)) - {b"xmlns", b"xml"})
    bound = b"".join(b' xmlns:%b="%b"' % (prefix, prefix) for prefix in prefixes)
    mended = re.sub(rb"<robot\b", lambda found: found.group() + bound, content, count=1)
    try:
        ET.fromstring(mended)
    except ET.ParseError as other:
        raise _no_xml(path, error if "unbound" in str(other) else other) from error
    return mended


def guess_chain(path: str, root: ET.Element, tip: str | None = None) -> GuessedChain:
    """The one arm of a robot: the body behind most turning joints, or what several such bodies hang on together.

    Args:
        path: of the file, for errors.
        root: of a URDF that does not contradict itself.
        tip: the frame that carries the tool, where it is known.

    Returns:
        The chain, and what was guessed of it.

    Raises:
        InputError: there is no arm, or more than one.
    """
    joints = {_child(joint): joint for joint in root.findall("joint")}
    links = [str(link.get("name")) for link in root.findall("link")]
    if tip is not None and tip not in links:
        raise InputError(path, "tip", tip, "no link of that name", nearest(tip, links))
    ways = {link: _way(joints, link) for link in links}
    slides = not any(joint.get("type") in TURNING for joint in joints.values())
    guesses = {}
    if tip is None:
        tip, why = _last_link(path, ways, slides)
        guesses["tip"] = f"guessed: {why}"
    held = {}
    for joint in ways[tip]:
        if joint.get("type") == "prismatic" and not slides:
            name = str(joint.get("name"))
            held[name] = _within_limits(joint)
            guesses[f"hold_joints.{name}"] = "guessed: a sliding joint is held; state where it stood, m"
    return GuessedChain(tip, held, guesses)


def _child(joint: ET.Element) -> str:
    element = joint.find("child")
    return "" if element is None else str(element.get("link"))


def _way(joints: dict[str, ET.Element], link: str) -> list[ET.Element]:
    """The joints from the root to a link."""
    way: list[ET.Element] = []
    while link in joints:
        way.append(joints[link])
        parent = joints[link].find("parent")
        link = "" if parent is None else str(parent.get("link"))
    return way[::-1]


def _moving(way: Iterable[ET.Element], slides: bool) -> list[ET.Element]:
    """The joints of a way that turn; where nothing of the machine turns, those that slide."""
    return [
        joint
        for joint in way
        if joint.get("type") in (("prismatic",) if slides else TURNING)
        and joint.find("mimic") is None
        and not any(word in str(joint.get("name")).lower() for word in HANDS)
    ]


def _last_link(path: str, ways: dict[str, list[ET.Element]], slides: bool) -> tuple[str, str]:
    """The link that carries the tool, and why it is taken for that."""
    by_last: dict[str, list[ET.Element]] = {}
    fewest = 1 if slides else ARMS.fewest_joints
    for link in ways:
        if way := _moving(ways[link], slides):
            by_last[str(way[-1].get("name"))] = way
    most = max(map(len, by_last.values()), default=0)
    ends = [way for way in by_last.values() if len(way) == most]
    shared = [each[0] for each in zip(*ends, strict=False) if all(one is each[0] for one in each)]
    if len(shared) < fewest:
        if most < fewest:
            raise InputError(path, "", f"{most} turning joints in a row", f"an arm has at least {ARMS.fewest_joints}")
        names = ", ".join(_body(ways, way)[-1] for way in ends[: PASTED.ends])
        cure = "Say which in a robot.yaml: `armscope init arm.urdf --tip NAME -o robot.yaml`."
        raise InputError(path, "", f"{len(ends)} arms, ending in {names}", "one arm is needed here", cure)
    body = _body(ways, shared)
    named = [link for name in TOOL_NAMES for link in body if link.lower() == name or link.lower().endswith(f"_{name}")]
    tip, last = (named or body[::-1])[0], shared[-1].get("name")
    moves = "slides" if slides else "turns"
    why = f"the {'usual name' if named else 'last'} of the links behind joint {last}, number {len(shared)} that {moves}"
    beyond = [
        each for way in ways.values() if shared[-1] in way for each in _moving(way[way.index(shared[-1]) :], True)
    ]
    if beyond and not slides:
        why += f"; joint {beyond[0].get('name')}, which slides behind it, is taken for no part of the arm"
    without = next((said for way in ways.values() if (said := _without_motor(way, shared[-1]))), "")
    why += f"; {without}" if without else ""
    return tip, f"{tip}, {why}"


def _without_motor(way: list[ET.Element], last: ET.Element) -> str:
    """Which joint behind the last that turns ends the arm, as no motor of its own turns it; "" where none does."""
    for joint in way[way.index(last) + 1 :] if last in way else ():
        name, kind, mimic = joint.get("name"), joint.get("type"), joint.find("mimic")
        if any(word in str(name).lower() for word in HANDS):
            return ""
        if mimic is not None:
            return f"joint {name} behind it mimics {mimic.get('joint')}, so that no motor of its own turns it"
        if kind in ("floating", "planar"):
            return f"joint {name} behind it is {kind}, which no motor turns: make it `revolute` or `fixed` in the file"
    return ""


def _body(ways: dict[str, list[ET.Element]], turning: list[ET.Element]) -> list[str]:
    """The links that move as one behind the last of some turning joints, the nearest first."""
    last = turning[-1]
    found = [(len(way), link) for link, way in ways.items() if last in way and _fixed_behind(way, last)]
    return [link for _, link in sorted(found, key=lambda each: each[0])]


def _fixed_behind(way: list[ET.Element], joint: ET.Element) -> bool:
    return all(each.get("type") == "fixed" for each in way[way.index(joint) + 1 :])


def _within_limits(joint: ET.Element) -> float:
    """Zero, or the end of the joint's range that is nearest to it."""
    limit = joint.find("limit")
    low, high = (0.0 if limit is None else float(limit.get(end, 0)) for end in ("lower", "upper"))
    return min(max(0.0, low), high) if low < high else 0.0
