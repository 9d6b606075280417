"""An ABB RAPID module with the commands as joint targets, and its reader.

A `jointtarget` names motor angles in degrees, so nothing is left to the controller's own inverse kinematics and to its
choice of a configuration. Syntax: ABB, Technical reference manual, RAPID Instructions, Functions and Data types
(jointtarget, MoveAbsJ). The seventh motor of an arm stands in the first external axis; 9E9 is RAPID's "not there".
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from armscope.compensation.constants import RAPID
from armscope.core.files import write_text
from armscope.core.inputs import InputError
from armscope.core.types import Array

NOT_THERE = "9E9"
AXES = len(("rax_1", "rax_2", "rax_3", "rax_4", "rax_5", "rax_6"))  # Of a joint target: the robot's, and as many others
LARGEST = AXES + 1
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,31}")
TARGET = re.compile(r"CONST\s+jointtarget\s+(\w+)\s*:=\s*\[\s*\[([^\]]*)\]\s*,\s*\[([^\]]*)\]\s*\]\s*;", re.IGNORECASE)
MOVE = re.compile(r"MoveAbsJ\s+(\w+)", re.IGNORECASE)


def write_rapid(path: Path | str, angles: Array, name: str = "armscope_path", speed_mm_s: int = 100) -> None:
    """Write commands (N, m) rad as a RAPID module that moves to each in turn and stops there.

    Args:
        path: the file (.mod).
        angles: (N, m), m up to 7.
        name: of the module: a letter, then letters, digits and underscores, at most 32.
        speed_mm_s: of the tool: one of RAPID's predefined speeds, 5 ... 7000 mm/s.

    Raises:
        InputError: a name, speed or number of motors that RAPID can't hold; angles that are missing.
    """
    angles = np.atleast_2d(np.asarray(angles, dtype=float))
    if not NAME.fullmatch(name):
        raise InputError(path, "module name", name, "a letter, then letters, digits and underscores, at most 32")
    if angles.shape[1] > LARGEST:
        raise InputError(path, "motors", angles.shape[1], f"a RAPID joint target holds at most {LARGEST} motors")
    speeds = (5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000)
    if speed_mm_s not in (*speeds, 4000, 5000, 6000, 7000):
        raise InputError(path, "speed", speed_mm_s, f"RAPID's speeds are {', '.join(map(str, speeds))} ... 7000 mm/s")
    if not np.isfinite(angles).all():
        row = int(np.flatnonzero(~np.isfinite(angles).all(axis=1))[0])
        raise InputError(path, f"row {row + 1}", "no command", "a job file needs a command for every row")
    width = max(5, len(str(len(angles))))
    names = [f"p{number:0{width}d}" for number in range(1, len(angles) + 1)]
    lines = [f"MODULE {name}"]
    lines += [f"  CONST jointtarget {point} := {_target(row)};" for point, row in zip(names, angles, strict=True)]
    lines += ["", "  PROC follow()"]
    lines += [f"    MoveAbsJ {point}\\NoEOffs, v{speed_mm_s}, fine, tool0;" for point in names]
    lines += ["  ENDPROC", "ENDMODULE", ""]
    write_text(path, "\n".join(lines))


def read_rapid(path: Path | str, n_motors: int) -> Array:
    """The commands (N, m) rad of a RAPID module's joint targets, in the order in which it moves to them. Raises
    InputError: no such module, a target that is not defined, or another number of motors."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(path, "", "no readable text", "a RAPID module is needed here", str(error)) from error
    targets = {match[1].lower(): _angles(path, match, n_motors) for match in TARGET.finditer(text)}
    moves = [match[1].lower() for match in MOVE.finditer(text)]
    for move in moves:
        if move not in targets:
            raise InputError(path, "MoveAbsJ", move, "no joint target of that name is defined in the module")
    if not moves:
        raise InputError(path, "", "no MoveAbsJ", "a module moves to its joint targets with MoveAbsJ")
    return np.array([targets[move] for move in moves])


def _target(row: Array) -> str:
    degrees = [f"{value:.{RAPID.digits}f}" for value in np.degrees(row)]
    arm = [*degrees[:AXES], *["0"] * (AXES - len(degrees))]
    external = [*degrees[AXES:], *[NOT_THERE] * (AXES - max(0, len(degrees) - AXES))]
    return f"[[{', '.join(arm)}], [{', '.join(external)}]]"


def _angles(path: Path | str, match: re.Match[str], n_motors: int) -> Array:
    arm, external = ([part.strip() for part in match[group].split(",")] for group in (2, 3))
    if len(arm) != AXES or len(external) != AXES:
        raise InputError(path, f"jointtarget {match[1]}", match[0], "six robot axes and six external axes")
    extra = [value for value in external if float(value) < 8e9]
    if len(extra) != max(0, n_motors - AXES) or any(float(value) != 0 for value in arm[n_motors:]):
        raise InputError(
            path, f"jointtarget {match[1]}", match[0], f"the arm has {n_motors} motors", "Is it another arm's job?"
        )
    return np.radians([float(value) for value in (*arm[:n_motors], *extra)])
