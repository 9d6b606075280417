"""What is given to a command as a function: folders in place of tables, arms left out, options that it has not."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from armscope.compensation.path import WantedPath, as_path, read_path
from armscope.core.inputs import DATA_FRAME, InputError, nearest
from armscope.recordings import Recordings
from armscope.recordings.folders import robot_for, robot_in, table_in
from armscope.recordings.motions import Motions
from armscope.robot import Arm

Robot = Arm | Path | str
Table = Recordings | Motions | pd.DataFrame | Path | str


def table_of(recordings: Table) -> Table:
    """The table itself where a folder was given."""
    return table_in(Path(recordings)) if isinstance(recordings, str | Path) else recordings


def arm_of(robot: Robot | None, recordings: Table) -> Robot | None:
    """The arm as said, else that of a folder that was given for a table; None where there is none."""
    return robot_in(Path(recordings)) if robot is None and isinstance(recordings, str | Path) else robot


def arm_for(robot: Robot | None, recordings: Table) -> Robot:
    """The arm as said, else that of a folder that was given for a table. Raises InputError: there is none."""
    if robot is None and isinstance(recordings, str | Path):
        return robot_for(None, Path(recordings))
    if robot is None:
        rule = "the nominal arm must be known: a robot.yaml, a URDF or an arm"
        cure = "Give it after the recordings; to `compare`, before which recordings alone stand, as robot=..."
        raise InputError("robot", "", "nothing", rule, cure)
    return robot


def refuse_less_than_two(recordings: Sequence[object]) -> None:
    """What is no two recordings: none, or a list of them where they are given one after the other.

    Raises:
        InputError: it is so.
    """
    rule = "two or more of one arm are compared"
    listed = next((type(each).__name__ for each in recordings if isinstance(each, list | tuple)), "")
    if listed:
        cure = "armscope.compare(*recordings, robot=...) gives them so."
        raise InputError("compare", "", f"a {listed}", f"{rule}, one after the other", cure)
    if not recordings:
        raise InputError("compare", "", "no recordings", rule)


def names_of(recordings: Sequence[Table], names: Sequence[str]) -> list[str]:
    """What recordings are called: as said, else by their paths, and by their numbers where they have none.

    Raises:
        InputError: two have one name, or one path.
    """
    if names:
        if len(set(names)) != len(names) or len(names) != len(recordings):
            raise InputError("names", "", list(names), "as many different names as recordings")
        return list(names)
    named = [str(each) if isinstance(each, str | Path) else f"{n}" for n, each in enumerate(recordings, 1)]
    twice = next((name for k, name in enumerate(named) if name in named[:k]), None)
    if twice is not None:
        rule = "what is compared is measured anew each time"
        raise InputError("compare", "", f"{twice} more than once", rule, "Was one file copied, or named twice?")
    return named


def described_file(robot: Robot) -> Path | str:
    """The file of a robot: inverse dynamics needs what an `Arm` does not hold. Raises InputError: an arm was given."""
    if not isinstance(robot, str | Path):
        raise InputError("robot", "", type(robot).__name__, "the path of robot.yaml, for a table of motions")
    return robot


def wanted_path(path: WantedPath | pd.DataFrame | Path | str, arm: Arm) -> WantedPath:
    """Wanted points as said, of a data frame or of a file."""
    if isinstance(path, WantedPath):
        return path
    return as_path(path, DATA_FRAME, arm) if isinstance(path, pd.DataFrame) else read_path(path, arm)


def options_of(function: Callable[..., Any]) -> list[str]:
    """The options of a function: what comes after an arm and a table or a count."""
    return list(inspect.signature(function).parameters)[2:]


def refuse_unknown(command: str, options: Collection[str], known: Sequence[str]) -> None:
    """Options that a command does not have.

    Args:
        command: its name.
        options: those given.
        known: those that it has.

    Raises:
        InputError: there is one.
    """
    for name in sorted(set(options) - set(known)):
        rule = f"an option of {command} is one of {', '.join(sorted(known))}"
        close = nearest(name, known)
        raise InputError(command, "", name, rule, close if close.startswith("Did") else "")
