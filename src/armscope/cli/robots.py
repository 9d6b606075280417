"""What every command does with its two inputs: read the robot and the table first, and say what was guessed or left."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.recordings import Recordings
    from armscope.robot import Arm
    from armscope.robot.description import RobotDescription


def robot_of(path: Path) -> Arm:
    """The arm of a robot.yaml or a URDF; guesses about a URDF are said. Raises InputError: it can't be used."""
    return arm_and_tables(path, [])[0]


def arm_and_tables(
    robot: Path, paths: list[Path], priors: Path | None = None, arm_type: str | None = None
) -> tuple[Arm, list[Recordings]]:
    """The arm and recordings of it; tables are read before kinematics are imported, so that a bad one is told at once.

    Args:
        robot: robot.yaml, a URDF, whose guesses are said, or a name of the library.
        paths: of the tables.
        priors: priors.yaml of a fleet, and
        arm_type: which of its types the arm is.

    Returns:
        The arm, and the recordings of each table.

    Raises:
        InputError: a file can't be used.
    """
    from armscope.core.inputs import InputError
    from armscope.robot.description_file import load_description

    description = load_description(robot)
    tell_guesses(robot, description)
    if not robot.exists():
        words = f"the library's {description.name}, nothing at its flange"
        print(f"note: {robot}: {words}; `armscope init {robot} -o robot.yaml` writes it to a file", file=sys.stderr)
    if priors is None and arm_type is not None:
        raise InputError("--arm-type", "", arm_type, "a type of --priors, which is not given")
    motors = None if description.dh is None else description.n_motors(len(description.dh.joints))
    tables = [table_of(path, motors) for path in paths]

    from armscope.robot.arm import build_arm
    from armscope.robot.arm_type import ArmType, read_arm_type

    known = ArmType() if priors is None else read_arm_type(priors, arm_type)
    arm = replace(build_arm(description), type=known)
    for table, path in zip(tables, paths, strict=True):
        if table.n_motors != arm.n_motors:  # how many motors a URDF has, only its arm tells
            table_of(path, arm.n_motors)
    return arm, tables


def tell_guesses(robot: Path, description: RobotDescription) -> None:
    """Say what was guessed of a bare URDF."""
    from armscope.robot.description_file import guesses
    from armscope.robot.urdf_file import is_xml

    for guess in guesses(description) if is_xml(robot) else ():
        print(f"note: {robot}: {guess}; `armscope init {robot}` writes a robot.yaml to mend it", file=sys.stderr)


def table_of(path: Path, n_motors: int | None = None) -> Recordings:
    """The recordings of a table, with what was passed over said. Raises InputError: it can't be used."""
    from armscope.recordings import read_recordings

    table = read_recordings(path, n_motors)
    for note in table.notes:
        print(f"note: {note}", file=sys.stderr)
    return table


def print_json(content: Any) -> None:
    """Content as JSON on standard output; what is no number is null."""
    from armscope.core.files import as_json

    print(as_json(content))
