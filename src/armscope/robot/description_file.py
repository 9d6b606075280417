"""A robot's description from its file: robot.yaml, or a URDF whose tip is then guessed."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import yaml

from armscope.core.inputs import InputError, read_keys, validate
from armscope.robot.constants import ARMS, GUESSES
from armscope.robot.description import RobotDescription
from armscope.robot.library import is_nominal, nominal_description
from armscope.robot.urdf_file import guess_chain, is_xml, root_of

QUARTER_TURN_RAD = math.pi / 2


def load_description(path: Path | str) -> RobotDescription:
    """Read robot.yaml, or a URDF: its tip is then the last link of its one arm, and `source` says that it is a guess.

    Where there is no such file, a name of the library's arms stands for the arm's own (`armscope init --list`).

    Raises:
        InputError: a key, value, unit or number of rows that can't be; it names the place and the rule.
    """
    if is_xml(path):
        return describe_urdf(path)
    if not Path(path).exists() and is_nominal(str(path)):
        return nominal_description(str(path))
    return described(read_keys(path), path)


def described(content: Any, path: Path | str) -> RobotDescription:
    """A description by the content of a robot.yaml. ``path``: of the file, from which its URDF is looked for. Raises
    InputError: as `load_description`."""
    description = validate(RobotDescription, content, path)
    _refuse_other_units(description, path)
    if description.urdf is not None:
        urdf = Path(path).parent / description.urdf
        if not urdf.is_file():
            raise InputError(path, "urdf", description.urdf, "the URDF must be a readable file", f"Looked for {urdf}.")
        # in full: a model.yaml that names it is read from other folders, too
        description = description.model_copy(update={"urdf": str(urdf.resolve())})
    return description


def describe_urdf(path: Path | str, tip: str | None = None) -> RobotDescription:
    """A URDF's one arm, with whatever is guessed under `source`. ``tip``: the frame that carries the tool; None
    guesses it. Raises InputError: it is no URDF, or has no arm, or several."""
    root = root_of(str(path))
    found = guess_chain(str(path), root, tip)
    name = root.get("name") or Path(path).stem
    return RobotDescription(
        name=name, urdf=str(Path(path).resolve()), tip=found.tip, hold_joints=found.held, source=found.guesses
    )


def as_yaml(description: RobotDescription, folder: Path) -> str:
    """A description as the text of a robot.yaml in a folder; a URDF is named from there."""
    content = description.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    if description.urdf is not None:
        content["urdf"] = os.path.relpath(description.urdf, folder)
    source = content.pop("source", {})
    options: dict[str, Any] = {"sort_keys": False, "allow_unicode": True, "width": 1000}
    said = yaml.safe_dump({"source": source}, default_flow_style=False, **options) if source else ""
    # None would put what holds single values alone on one line in braces, which nothing can follow
    style = None if any(isinstance(value, dict | list) for value in content.values()) else False
    return str(yaml.safe_dump(content, default_flow_style=style, **options)) + said


def guesses(description: RobotDescription) -> list[str]:
    """What armscope guessed of a description, in words."""
    return [f"{place}: {said}" for place, said in description.source.items() if said.startswith("guessed")]


def _refuse_other_units(description: RobotDescription, path: Path | str) -> None:
    """Metres and radians are told from millimetres and degrees by what no arm is. Raises InputError: lengths in
    metres, or angles in radians."""
    rows = () if description.dh is None else description.dh.joints
    lengths = sum(abs(row.a_mm) + abs(row.d_mm) for row in rows)
    if 0 < lengths < ARMS.shortest_mm:
        cure = "Are they metres? Then multiply a_mm and d_mm by 1000."
        raise InputError(
            path, "dh.joints", f"{lengths:.4g} mm", "all lengths of an arm together are 10 mm or more", cure
        )
    for key in ("alpha_deg", "theta_offset_deg"):
        angles = [cast(float, getattr(row, key)) for row in rows]
        if _are_quarter_turns_in_radians(angles):
            number = next(n for n, angle in enumerate(angles) if angle)
            cure = f"Write {math.degrees(angles[number]):.0f} in degrees."
            rule = "this is a quarter or half turn in radians, and so are all others"
            raise InputError(path, f"dh.joints[{number}].{key}", angles[number], rule, cure)
    centres = [abs(value) for link in description.links or () for value in link.com_mm]
    if lengths > GUESSES.centre_in_metres * 100 and 0 < max(centres, default=0) <= GUESSES.centre_in_metres:
        rule = f"no centre of mass lies further than {max(centres):.3g} mm from its frame's origin"
        cure = "Are they metres? Then multiply com_mm by 1000."
        raise InputError(path, "links", f"{max(centres):.3g} mm", rule, cure)
    limits = [end for pair in description.joint_limits_deg or () for end in pair]
    if len(limits) > 2 and max(map(abs, limits)) <= 2 * math.pi:
        rule = "no joint moves further than 6.3 degrees by these limits"
        raise InputError(path, "joint_limits_deg", limits[:2], rule, "Are they radians? Write degrees.")


def _are_quarter_turns_in_radians(angles: Sequence[float]) -> bool:
    turned = [angle for angle in angles if angle]
    return bool(turned) and all(_quarters(angle) for angle in turned)


def _quarters(angle: float) -> bool:
    quarters = round(angle / QUARTER_TURN_RAD)
    return 1 <= abs(quarters) <= 4 and abs(angle - quarters * QUARTER_TURN_RAD) <= GUESSES.as_written_rad
