"""A URDF as XML: what contradicts itself in it, and which of its links carries the tool. Meshes are not looked at."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from armscope.core.inputs import InputError, nearest, note_read
from armscope.core.types import Array
from armscope.robot.description import HEAVIEST_KG, LONGEST_MM

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "planar", "floating")
TURNING = ("revolute", "continuous")
FEWEST_JOINTS = 2
"""Turning joints of what may be an arm."""
TOOL_NAMES = ("tool0", "tool", "tcp", "tool_link", "tool_frame", "flange", "ee_link", "end_effector", "ee")
"""What the link that carries the tool is usually called, the commonest first (ROS-Industrial's convention)."""


MOST_JOINTS = 500
"""Of a whole robot; the humanoid with the most, hands included, has fewer than 100."""
HANDS = ("gripper", "finger")
"""Joints of these names open a hand; the arm ends before them."""


class GuessedChain(NamedTuple):
    """The frame that carries the tool, sliding joints before it with where they are held, and what is said of both."""

    tip: str
    held: dict[str, float]
    guesses: dict[str, str]


def is_xml(path: Path | str) -> bool:
    """Whether a file that is there begins as XML does."""
    try:
        with open(path, "rb") as stream:
            return stream.read(200).lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")
    except OSError:
        return False


def root_of(path: str) -> ET.Element:
    """The one <robot> of a URDF that does not contradict itself.

    Raises:
        InputError: it is no URDF, or contradicts itself; the joint or link is named.
    """
    root = _parsed(path)
    if root.tag != "robot":
        raise InputError(path, "", f"<{root.tag}>", "a URDF is one <robot>", "Other formats must be converted first.")
    for element in root.iter():
        if "xacro" in element.tag or any("${" in value or "$(" in value for value in element.attrib.values()):
            found = element.tag.rpartition("}")[2]
            rule = "macros must be expanded first"
            raise InputError(path, f"<{found}>", "a xacro file", rule, "`xacro arm.urdf.xacro > arm.urdf` does it.")
    _check(path, root)
    return root


def _parsed(path: str) -> ET.Element:
    note_read(path)
    try:
        content = Path(path).read_bytes()
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

    Raises:
        InputError: it is no XML for another reason, too.
    """
    prefixes = sorted(set(re.findall(rb"[<\s]([A-Za-z_][\w.-]*):[A-Za-z_]", content)) - {b"xmlns", b"xml"})
    bound = b"".join(b' xmlns:%b="%b"' % (prefix, prefix) for prefix in prefixes)
    mended = re.sub(rb"<robot\b", lambda found: found.group() + bound, content, count=1)
    try:
        ET.fromstring(mended)
    except ET.ParseError as other:
        raise _no_xml(path, error if "unbound" in str(other) else other) from error
    return mended


def _check(path: str, root: ET.Element) -> None:
    """Names, references, numbers and the tree; the first thing that is wrong becomes an `InputError`."""
    links = [element.get("name", "") for element in root.findall("link")]
    joints = root.findall("joint")
    if len(joints) > MOST_JOINTS:
        raise InputError(path, "", f"{len(joints)} joints", f"no robot has more than {MOST_JOINTS}")
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
    for link in root.findall("link"):
        _check_mass(path, link)


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
        numbers = _numbers(path, f"{place}, {tag} {key}", words, 3)
        if key == "xyz" and np.abs(numbers).max() > LONGEST_MM / 1e3:
            rule = f"no joint stands further than {LONGEST_MM / 1e3:g} m from the one before"
            raise InputError(path, f"{place}, {tag} xyz", words, rule, "URDFs are in metres.")
        if tag == "axis" and kind not in ("fixed", "floating") and not numbers.any():
            raise InputError(path, f"{place}, axis", words, "an axis needs a direction")
    for tag, keys in (("limit", ("lower", "upper", "effort", "velocity")), ("mimic", ("multiplier", "offset"))):
        for key, words in () if (element := joint.find(tag)) is None else element.items():
            if key in keys:
                _numbers(path, f"{place}, {tag} {key}", words, 1)
    if kind in ("revolute", "prismatic"):
        limit = joint.find("limit")
        for key in ("effort", "velocity"):
            if limit is None or limit.get(key) is None:
                rule = f'a {kind} joint needs <limit lower="..." upper="..." effort="..." velocity="..."/>'
                cure = "A joint that turns without end is `continuous`." if kind == "revolute" else ""
                raise InputError(path, place, "no <limit>" if limit is None else f"no {key} in <limit>", rule, cure)


def _check_mass(path: str, link: ET.Element) -> None:
    element = link.find("inertial/mass")
    words = None if element is None else element.get("value")
    if words is None:
        return
    place = f"link {link.get('name')}, mass"
    try:
        mass = float(words)
    except ValueError as error:
        raise InputError(path, place, words, "a mass is a number of kg") from error
    if not 0 <= mass <= HEAVIEST_KG:
        raise InputError(path, place, words, f"0 to {HEAVIEST_KG:g} kg: the heaviest arm that is sold weighs 11,000 kg")


def _numbers(path: str, place: str, words: str, count: int) -> Array:
    """So many finite numbers; a single one, a limit, may be infinite."""
    try:
        numbers = np.array([float(word) for word in words.split()])
    except ValueError:
        numbers = np.array([])
    known = ~np.isnan(numbers) if count == 1 else np.isfinite(numbers)
    if numbers.shape != (count,) or not known.all():
        raise InputError(path, place, words, "a number" if count == 1 else "three finite numbers")
    return numbers


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
    fewest = 1 if slides else FEWEST_JOINTS
    for link in ways:
        if way := _moving(ways[link], slides):
            by_last[str(way[-1].get("name"))] = way
    most = max(map(len, by_last.values()), default=0)
    ends = [way for way in by_last.values() if len(way) == most]
    shared = [each[0] for each in zip(*ends, strict=False) if all(one is each[0] for one in each)]
    if len(shared) < fewest:
        if most < fewest:
            raise InputError(path, "", f"{most} turning joints in a row", f"an arm has at least {FEWEST_JOINTS}")
        names = ", ".join(_body(ways, way)[-1] for way in ends[:5])
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
    return tip, f"{tip}, {why}"


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
