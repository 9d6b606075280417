"""The units of a pasted D-H table: as its header and cells state them, else guessed by size, and said."""

from __future__ import annotations

import math
from collections.abc import Sequence

from armscope.core.inputs import InputError
from armscope.robot.constants import GUESSES
from armscope.robot.dh_cells import DHLine
from armscope.robot.dh_joints import TABLE

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1e3, "in": 25.4, "inch": 25.4}
LENGTHS = ("a_mm", "d_mm")
ANGLES = ("alpha_deg", "theta_offset_deg")


def all_units(stated: dict[str, str], rows: Sequence[DHLine], source: dict[str, str]) -> dict[str, str]:
    """The unit of every column; one that states none has that of the other column of its kind.

    Args:
        stated: units by column, from the header.
        rows: the table's.
        source: is told what was guessed.

    Returns:
        Units by column.

    Raises:
        InputError: angles of which some can only be degrees, and some are quarter turns in radians.
    """
    units = dict(stated)
    for kind in (LENGTHS, ANGLES):
        own = [units[name] for name in kind if name in units]
        if not own and kind is ANGLES:
            _refuse_mixed_angles(rows)
        unit = own[0] if own else (_guess_length if kind is LENGTHS else _guess_angle)(rows, source)
        units |= {name: units.get(name, unit) for name in kind}
    return units


def in_file_units(row: DHLine, units: dict[str, str]) -> dict[str, float]:
    """A row as robot.yaml states it: mm and degrees."""
    values = {
        name: cell.angle(units[name]) if name in ANGLES else cell.plain * MILLIMETRES[units[name]]
        for name, cell in row.cells.items()
    }
    return {name: round(value, 9) for name, value in values.items()}


def _plain(row: DHLine, name: str) -> float:
    """A number that states no unit of its own."""
    return row.cells[name].plain if name in row.cells else 0.0


def _guess_length(rows: Sequence[DHLine], source: dict[str, str]) -> str:
    most = max(abs(_plain(row, name)) for row in rows for name in LENGTHS)
    unit = "m" if 0 < most < GUESSES.metres_up_to else "mm"
    source["dh lengths"] = f"guessed: {unit}, since the longest is {most:g}"
    return unit


def _guess_angle(rows: Sequence[DHLine], source: dict[str, str]) -> str:
    most = max(abs(_plain(row, name)) for row in rows for name in ANGLES)
    if not most and any(cell.degrees or cell.radians for row in rows for cell in row.cells.values()):
        source["dh angles"] = "stated: by pi or °"
        return "deg"
    unit = "rad" if 0 < most < GUESSES.radians_up_to else "deg"
    source["dh angles"] = f"guessed: {unit}, since the largest is {most:g}"
    return unit


def _refuse_mixed_angles(rows: Sequence[DHLine]) -> None:
    """Quarter turns in radians beside angles that can only be degrees: whichever unit is guessed, some are wrong.
    Raises InputError: there are both."""
    angles = [(row.number, name.partition("_")[0], _plain(row, name)) for row in rows for name in ANGLES]
    line, name, most = max(angles, key=lambda each: abs(each[2]))
    if abs(most) < GUESSES.radians_up_to:
        return
    for number, word, value in angles:
        quarters = round(value / (math.pi / 2))
        if (
            quarters
            and abs(value - quarters * math.pi / 2) < GUESSES.as_written_rad
            and abs(value) < GUESSES.radians_up_to
        ):
            rule = f"this is {90 * quarters} degrees in radians, where {name} of line {line}, {most:g}, is in degrees"
            cure = f"Write {90 * quarters}, or say the unit in a header: a [mm], alpha [deg], d [mm], theta [deg]."
            raise InputError(TABLE, f"line {number}, {word}", f"{value:.6g}", rule, cure)
