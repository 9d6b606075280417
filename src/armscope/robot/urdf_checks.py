"""What contradicts itself in a URDF: names, references, numbers, and the tree that its joints make."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections import Counter

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.robot.constants import ARMS
from armscope.robot.description import no_inertia_of_a_body

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "planar", "floating")
COUNTS = {3: "three", 6: "six"}


def refuse_contradictions(path: str, root: ET.Element) -> None:
    """Look at names, references, numbers and the tree. Raises InputError: the first thing that is wrong."""
    links = [element.get("name", "") for element in root.findall("link")]
    joints = root.findall("joint")
    if len(joints) > ARMS.most_joints_of_robot:
        raise InputError(path, "", f"{len(joints)} joints", f"no robot has more than {ARMS.most_joints_of_robot}")
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
        _check_inertia(path, link)


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
        if key == "xyz" and np.abs(numbers).max() > ARMS.longest_mm / 1e3:
            rule = f"no joint stands further than {ARMS.longest_mm / 1e3:g} m from the one before"
            raise InputError(path, f"{place}, {tag} xyz", words, rule, "URDFs are in metres.")
        if tag == "axis" and kind not in ("fixed", "floating") and not numbers.any():
            raise InputError(path, f"{place}, axis", words, "an axis needs a direction")
    for tag, keys in (("limit", ("lower", "upper", "effort", "velocity")), ("mimic", ("multiplier", "offset"))):
        for key, words in () if (element := joint.find(tag)) is None else element.items():
            if key in keys:
                _numbers(path, f"{place}, {tag} {key}", words, 1)
    _check_range(path, joint)
    if kind in ("revolute", "prismatic"):
        limit = joint.find("limit")
        for key in ("effort", "velocity"):
            if limit is None or limit.get(key) is None:
                rule = f'a {kind} joint needs <limit lower="..." upper="..." effort="..." velocity="..."/>'
                cure = "A joint that turns without end is `continuous`." if kind == "revolute" else ""
                raise InputError(path, place, "no <limit>" if limit is None else f"no {key} in <limit>", rule, cure)


def _check_range(path: str, joint: ET.Element) -> None:
    """A joint's range is of radians and in order; without ends, or infinite, it is not stated."""
    kind, limit = joint.get("type"), joint.find("limit")
    if limit is None or kind not in ("revolute", "prismatic"):
        return
    place, most = f"joint {joint.get('name')}, limit", math.radians(ARMS.degrees)
    words = {key: limit.get(key, "0") for key in ("lower", "upper")}
    ends = {key: float(word) for key, word in words.items()}
    for key, end in ends.items() if kind == "revolute" else ():
        if math.isfinite(end) and abs(end) > most:
            rule = f"a joint turns by {most:.4g} rad at most, two turns, either way"
            cure = "A joint that turns without end is `continuous`."
            if abs(end) <= ARMS.degrees:
                cure = f"URDFs are in radians: {words[key]} degrees are {math.radians(end):.6g}. " + cure
            raise InputError(path, f"{place} {key}", words[key], rule, cure)
    if ends["lower"] > ends["upper"]:
        found = f"lower {words['lower']}, upper {words['upper']}"
        raise InputError(path, place, found, "lower is not above upper", "Exchange them.")


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
    if not 0 <= mass <= ARMS.heaviest_kg:
        raise InputError(
            path, place, words, f"0 to {ARMS.heaviest_kg:g} kg: the heaviest arm that is sold weighs 11,000 kg"
        )


def _check_inertia(path: str, link: ET.Element) -> None:
    element = link.find("inertial/inertia")
    words = [] if element is None else [element.get(key, "0") for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
    if not words:
        return
    place = f"link {link.get('name')}, inertia"
    numbers = _numbers(path, place, " ".join(words), 6)
    if said := no_inertia_of_a_body(*numbers.tolist()):
        cure = "It is about the centre of mass, kg m2; is a sign wrong, or a digit?"
        raise InputError(path, place, " ".join(words), said, cure)


def _numbers(path: str, place: str, words: str, count: int) -> Array:
    """So many finite numbers; a single one, a limit, may be infinite."""
    try:
        numbers = np.array([float(word) for word in words.split()])
    except ValueError:
        numbers = np.array([])
    known = ~np.isnan(numbers) if count == 1 else np.isfinite(numbers)
    if numbers.shape != (count,) or not known.all():
        raise InputError(path, place, words, "a number" if count == 1 else f"{COUNTS[count]} finite numbers")
    return numbers
