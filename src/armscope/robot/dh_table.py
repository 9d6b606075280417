"""A D-H table as people paste it: from a data sheet, a page, a program; what it doesn't state is guessed and said."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Literal

from armscope.core.inputs import InputError, validate
from armscope.robot.constants import GUESSES, PASTED
from armscope.robot.description import RobotDescription

HEADING = re.compile(r"\s*(.*?)[\s_]*[\[(]?(mm|m|deg|rad|°)?[\])]?\s*", re.DOTALL)
"""A column's word, and its unit in brackets."""
COLUMNS = {
    "theta_offset_deg": r"(theta|θ|offset|th)",
    "alpha_deg": r"(alpha|α|twist|al)",
    "a_mm": r"(a|r|length)",
    "d_mm": r"(d|offset_d)",
    "": r"(joint|link|row|j|i|no|nr|#|kinematics|axis|)",
}
"""What the columns are called; the last are no numbers of a row."""
USUAL = ("a_mm", "alpha_deg", "d_mm", "theta_offset_deg")
"""The order where no header says one."""

Convention = Literal["standard", "modified"]


def parse_dh_table(text: str, name: str, convention: Convention = "standard") -> RobotDescription:
    """A table of D-H rows as a description whose `source` says what was guessed.

    Args:
        text: rows of numbers between blanks, tabs, commas, semicolons or bars; a header may name columns and units;
            angles may be written with pi ("pi/2", "-π/2").
        name: of the arm.
        convention: of the rows: a table does not say it.

    Returns:
        The description.

    Raises:
        InputError: a line that is no row; its number is named.
    """
    lines = [(number, line.strip().strip("|")) for number, line in enumerate(text.splitlines(), 1)]
    lines = [(number, line) for number, line in lines if re.search(r"[^\s|:+=-]", line) and not line.startswith("#")]
    if not lines:
        raise InputError(
            "D-H table", "", "nothing", "rows of a, alpha, d, theta are needed", "Paste them, end with Ctrl-D."
        )
    if len(lines) > PASTED.rows:
        raise InputError("D-H table", "", f"{len(lines)} lines", f"the rows of an arm, at most {PASTED.rows}")
    source: dict[str, str] = {}
    header = _cells(lines[0][1], lines[0][0])
    names: tuple[str, ...] = USUAL
    units: dict[str, str] = {}
    if not any(_number(cell) is not None for cell in header[1:]):
        names, units = _named(header, lines[0][0])
        lines = lines[1:]
    if not lines:
        raise InputError("D-H table", "", "a header alone", "rows of a, alpha, d, theta are needed")
    rows = [_row(line, number, names) for number, line in lines]
    if names is USUAL:
        source["dh columns"] = f"guessed: in the order a, alpha, d, theta ({len(rows[0])} numbers in a row)"
    length = units.get("length") or _guess_length(rows, source)
    if "angle" not in units:
        _refuse_mixed_angles(rows, [number for number, _ in lines])
    angle = units.get("angle") or _guess_angle(rows, source)
    source["dh convention"] = "stated" if convention == "modified" else "guessed: standard; --modified says Craig's"
    joints = [_in_file_units(row, length, angle) for row in rows]
    content = {"name": name, "dh": {"convention": convention, "joints": joints}, "source": source}
    return validate(RobotDescription, content, "D-H table")


def _cells(line: str, number: int) -> list[str]:
    separator = next((separator for separator in "|\t;," if separator in line), None)
    cells = line.split() if separator is None else [cell.strip() for cell in line.split(separator)]
    if len(cells) > PASTED.cells:
        raise InputError("D-H table", f"line {number}", f"{len(cells)} cells", "the four values of a D-H row")
    for cell in cells:
        if len(cell) > PASTED.cell:
            raise InputError(
                "D-H table", f"line {number}", cell, f"a number or a heading of at most {PASTED.cell} characters"
            )
    return cells


def _number(cell: str) -> float | None:
    """A number, also as a multiple of pi or with a decimal comma."""
    plain = cell.replace("π", "pi").replace("−", "-").replace(" ", "").replace("*", "").replace("°", "").lower()
    found = re.fullmatch(r"([+-]?\d*\.?\d*)pi(?:/(\d+\.?\d*))?", plain)
    if found:
        factor = {"": 1.0, "+": 1.0, "-": -1.0}.get(found[1])
        below = float(found[2] or 1)
        return (float(found[1]) if factor is None else factor) * math.pi / below if below else None
    try:
        value = float(plain.replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _named(header: Sequence[str], number: int) -> tuple[tuple[str, ...], dict[str, str]]:
    """What the header's columns are, and the units that it states."""
    names, units = [], {}
    for cell in header:
        parts = HEADING.fullmatch(cell.lower())
        assert parts is not None  # whatever stands before a unit is the word
        word, unit = parts.groups()
        word = re.sub(r"[\s_]*(i|j|offset)?$", "", word) or word
        found = next((key for key, pattern in COLUMNS.items() if re.fullmatch(pattern, word)), None)
        if found is None:
            raise InputError(
                "D-H table", f"line {number}", cell, "columns are a, alpha, d, theta, with units in brackets"
            )
        if unit and found:
            units["angle" if found.endswith("deg") else "length"] = "deg" if unit == "°" else unit
        names.append(found)
    if not {"a_mm", "alpha_deg", "d_mm"} <= set(names):
        raise InputError("D-H table", f"line {number}", " ".join(header), "a, alpha and d are needed in every row")
    return tuple(names), units


def _row(line: str, number: int, names: tuple[str, ...]) -> dict[str, float]:
    cells = _cells(line, number)
    if names is USUAL and len(cells) in (4, 5) and not re.search(r"\d", cells[0]):
        cells = cells[1:]
    if not (len(cells) == len(names) or (names is USUAL and len(cells) == 3)):
        cure = "A row is a, alpha, d and, where it is not zero, theta."
        raise InputError("D-H table", f"line {number}", line, f"{len(names)} numbers in a row", cure)
    row = {}
    for name, cell in zip(names, cells, strict=False):
        if not name:
            continue
        value = _number(cell)
        if value is None and name == "theta_offset_deg":  # "q1", "theta1": the joint's own angle
            value = 0.0
        if value is None:
            raise InputError("D-H table", f"line {number}", cell, "a number, or a multiple of pi")
        row[name] = value
    return row


def _guess_length(rows: Sequence[dict[str, float]], source: dict[str, str]) -> str:
    most = max(abs(row[name]) for row in rows for name in ("a_mm", "d_mm"))
    unit = "m" if 0 < most < GUESSES.metres_up_to else "mm"
    source["dh lengths"] = f"guessed: {unit}, since the longest is {most:g}"
    return unit


def _guess_angle(rows: Sequence[dict[str, float]], source: dict[str, str]) -> str:
    most = max(abs(row.get(name, 0.0)) for row in rows for name in ("alpha_deg", "theta_offset_deg"))
    unit = "rad" if 0 < most < GUESSES.radians_up_to else "deg"
    source["dh angles"] = f"guessed: {unit}, since the largest is {most:g}"
    return unit


def _refuse_mixed_angles(rows: Sequence[dict[str, float]], numbers: Sequence[int]) -> None:
    """Quarter turns in radians beside angles that can only be degrees: whichever unit is guessed, some are wrong.

    Args:
        rows: the table's.
        numbers: the lines that they stand in.

    Raises:
        InputError: there are both.
    """
    angles = [
        (number, name.partition("_")[0], row.get(name, 0.0))
        for number, row in zip(numbers, rows, strict=True)
        for name in ("alpha_deg", "theta_offset_deg")
    ]
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
            raise InputError("D-H table", f"line {number}, {word}", f"{value:.6g}", rule, cure)


def _in_file_units(row: dict[str, float], length: str, angle: str) -> dict[str, float]:
    factors = {"mm": 1e3 if length == "m" else 1.0, "deg": 180 / math.pi if angle == "rad" else 1.0}
    return {name: round(value * factors[name.rpartition("_")[2]], 9) for name, value in row.items()}
