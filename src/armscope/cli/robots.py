"""What every command does with its two inputs: read the robot and the table first, and say what was guessed or left."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.recordings import Recordings
    from armscope.robot import Arm


def robot_of(path: Path, priors: Path | None = None, arm_type: str | None = None) -> Arm:
    """The arm of a robot.yaml or a URDF; guesses about a URDF are said.

    Args:
        path: of the arm.
        priors: priors.yaml of a fleet, and
        arm_type: which of its types the arm is.

    Returns:
        The arm.

    Raises:
        InputError: a file can't be used.
    """
    from armscope.core.inputs import InputError
    from armscope.robot.arm import build_arm
    from armscope.robot.arm_type import ArmType, read_arm_type
    from armscope.robot.description_file import guesses, load_description
    from armscope.robot.urdf_file import is_xml

    description = load_description(path)
    for guess in guesses(description) if is_xml(path) else ():
        print(f"note: {path}: {guess}; `armscope init {path}` writes a robot.yaml to mend it", file=sys.stderr)
    if priors is None and arm_type is not None:
        raise InputError("--arm-type", "", arm_type, "a type of --priors, which is not given")
    known = ArmType() if priors is None else read_arm_type(priors, arm_type)
    return replace(build_arm(description), type=known)


def table_of(path: Path, n_motors: int | None = None) -> Recordings:
    """The recordings of a table, with what was passed over said.

    Raises:
        InputError: it can't be used.
    """
    from armscope.recordings import read_recordings

    table = read_recordings(path, n_motors)
    for note in table.notes:
        print(f"note: {note}", file=sys.stderr)
    return table


def print_json(content: Any) -> None:
    """Content as JSON on standard output; what is no number is null."""
    from armscope.core.files import as_json

    print(as_json(content))
