"""What every command does with its two inputs: read the robot and the table first, and say what was guessed or left."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.recordings import Recordings
    from armscope.robot import Arm


def robot_of(path: Path) -> Arm:
    """The arm of a robot.yaml or a URDF; guesses about a URDF are said.

    Raises:
        InputError: it can't be used.
    """
    from armscope.robot.arm import build_arm
    from armscope.robot.description_file import guesses, load_description
    from armscope.robot.urdf_file import is_xml

    description = load_description(path)
    for guess in guesses(description) if is_xml(path) else ():
        print(f"note: {path}: {guess}; `armscope init {path}` writes a robot.yaml to mend it", file=sys.stderr)
    return build_arm(description)


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
