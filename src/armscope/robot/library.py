"""Nominal arms by name: D-H rows of makers' public documents, each saying where its numbers come from.

Every arm is a robot.yaml in `nominal/`. Under `source` a place begins with "published", "read from ... dimensions",
"as stated" or "from memory", and says "unsure" where nobody compared it with the maker's document.
"""

from __future__ import annotations

import functools
import re
from pathlib import Path

from armscope.core.inputs import InputError, load, nearest
from armscope.robot.description import RobotDescription

FOLDER = Path(__file__).parent / "nominal"


@functools.cache
def nominal_names() -> tuple[str, ...]:
    """What the library's arms are called, in alphabetical order."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.yaml")))


def nominal_file(name: str) -> Path:
    """The file of an arm; capitals, blanks and hyphens in its name don't count. Raises InputError: the library has
    no arm of that name."""
    plain = {_plain(each): each for each in nominal_names()}
    if _plain(name) not in plain:
        raise InputError(name, "", name, "no file, and no arm of the library", nearest(name, nominal_names()))
    return FOLDER / f"{plain[_plain(name)]}.yaml"


def nominal_description(name: str) -> RobotDescription:
    """An arm of the library. Raises InputError: the library has no arm of that name."""
    return load(RobotDescription, nominal_file(name))


def is_nominal(name: str) -> bool:
    """Whether the library has an arm of that name."""
    return _plain(name) in map(_plain, nominal_names())


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())
