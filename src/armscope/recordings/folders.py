"""A folder given where a table is read: its table and its robot.yaml, under the names that all pages use."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from armscope.core.inputs import InputError

TABLES = ("recordings.csv", "recordings.csv.gz", "motions.csv", "motions.csv.gz")
ROBOT = "robot.yaml"


def table_in(given: Path) -> Path:
    """The table in a folder; a path that is no folder is the table itself. Raises InputError: a folder has none, or
    more than one."""
    if not given.is_dir():
        return given
    there = [name for name in TABLES if (given / name).exists()]
    if len(there) == 1:
        return given / there[0]
    found = f"a folder with {' and '.join(there)}" if there else "a folder without any of these"
    raise InputError(given, "", found, f"one of {', '.join(TABLES)} is read in a folder", "Name the table itself.")


def robot_in(given: Path) -> Path | None:
    """robot.yaml in a folder that has one."""
    return given / ROBOT if given.is_dir() and (given / ROBOT).exists() else None


def robot_for(robot: Path | None, given: Path) -> Path:
    """The nominal arm: as said, else robot.yaml of the folder that was given for a table. Raises InputError: nothing
    was said, and there is no such folder or no such file in it."""
    known = robot or robot_in(given)
    if known is not None:
        return known
    beside = robot_in(given.parent)
    found = f"nothing, and no {ROBOT} in {given}" if given.is_dir() else "nothing"
    cure = f"Add --robot {beside or ROBOT}; a URDF or a name (armscope init --list) will do, too."
    raise InputError("--robot", "", found, f"the nominal arm must be known: {ROBOT} is read in a folder only", cure)


def others_than(robot: Path, given: Sequence[Path]) -> list[Path]:
    """robot.yaml of folders that is not the file that is used, word for word."""
    found = [each for each in map(robot_in, given) if each is not None and each != robot]
    return [each for each in found if not robot.is_file() or each.read_bytes() != robot.read_bytes()]
