"""A D-H table as people paste it: from a data sheet, a page, a program; what it doesn't state is guessed and said."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from typing import Any, Literal

from armscope.core.inputs import InputError, validate
from armscope.robot.constants import PASTED
from armscope.robot.description import RobotDescription
from armscope.robot.dh_cells import DHCell, DHLine, read_dh_cell, written_plainly
from armscope.robot.dh_joints import TABLE, ThetaCell, motors_of_rows
from armscope.robot.dh_units import MILLIMETRES, all_units, in_file_units

HEADING = re.compile(r"\s*(.*?)[\s_]*[\[(/,]?\s*(mm|cm|m|inch|in|deg|degrees|rad|°)?[\])]?\s*", re.DOTALL)
"""A column's word, and its unit in brackets."""
SUBSCRIPT = re.compile(r"[\s_]*(?P<before>[ijn]\s*-\s*1)?([ijn]|offset)?$")
"""Below a column's word; Craig's convention counts a and alpha by the link before."""
COLUMNS = {
    "theta_offset_deg": r"(theta|θ|offset|th)",
    "alpha_deg": r"(alpha|α|twist|al)",
    "a_mm": r"(a|r|length)",
    "d_mm": r"(d|offset_d)",
    "": r"(joint|link|row|j|i|no|nr|#|kinematics|axis|)",
}
"""What the columns are called; the last are no numbers of a row."""
DIGITS_APART = re.compile(r"\d,\d")  # A comma that may be a decimal one
USUAL = ("a_mm", "alpha_deg", "d_mm", "theta_offset_deg")  # The order where no header says one

Convention = Literal["standard", "modified"]


def parse_dh_table(text: str, name: str, convention: Convention = "standard") -> RobotDescription:
    """A table of D-H rows as a description whose `source` says what was guessed.

    Args:
        text: rows of numbers between blanks, tabs, commas, semicolons or bars; a header may name columns and units;
            angles may be written with pi ("pi/2", "-π/2"), theta as a joint's angle ("q2 - 90", "-θ₃").
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
        raise InputError(TABLE, "", "nothing", "rows of a, alpha, d, theta are needed", "Paste them, end with Ctrl-D.")
    if len(lines) > PASTED.rows:
        raise InputError(TABLE, "", f"{len(lines)} lines", f"the rows of an arm, at most {PASTED.rows}")
    source: dict[str, str] = {}
    header = _cells(lines[0][1], lines[0][0])
    names: tuple[str, ...] = USUAL
    units: dict[str, str] = {}
    if not any(_is_value(cell) for cell in header[1:]):
        names, units = _named(header, lines[0][0], convention)
        lines = lines[1:]
    if not lines:
        raise InputError(TABLE, "", "a header alone", "rows of a, alpha, d, theta are needed")
    if names is USUAL and _is_counted(lines):
        names = ("", *USUAL)
        source["dh columns"] = "guessed: the row's number first, then a, alpha, d, theta"
    rows = [_row(line, number, names) for number, line in lines]
    if names is USUAL:
        source["dh columns"] = f"guessed: in the order a, alpha, d, theta ({len(rows[0].cells)} numbers in a row)"
    units = all_units(units, rows, source)
    source["dh convention"] = "stated" if convention == "modified" else "guessed: standard; --modified says Craig's"
    joints = [in_file_units(row, units) for row in rows]
    thetas = [
        ThetaCell(row.number, row.theta, row.cells.get("theta_offset_deg"), joint.get("theta_offset_deg", 0.0))
        for row, joint in zip(rows, joints, strict=True)
    ]
    content: dict[str, Any] = {"name": name, "dh": {"convention": convention, "joints": joints}, "source": source}
    if (actuation := motors_of_rows(thetas, source)) is not None:
        content["actuation"] = actuation
    return validate(RobotDescription, content, TABLE)


def _is_counted(lines: Sequence[tuple[int, str]]) -> bool:
    """Whether rows of five cells without a header begin with 1, 2, 3 ...: each its own number."""
    rows = [_cells(line, number) for number, line in lines]
    begun = [row[0] for row in rows if len(row) == 1 + len(USUAL)]
    return len(begun) == len(rows) and begun == [str(n) for n in range(1, len(rows) + 1)]


def _cells(line: str, number: int) -> list[str]:
    separator = next((separator for separator in "|\t;,&" if separator in line), None)
    cells = _at_blanks(line) if separator is None else [cell.strip() for cell in line.split(separator)]
    if separator == "," and not all(map(_is_value, cells)) and all(map(_is_value, apart := _at_blanks(line))):
        cells = apart  # decimal commas: 0,5 90 0,3 q1
    if len(cells) > PASTED.cells:
        raise InputError(TABLE, f"line {number}", f"{len(cells)} cells", "the four values of a D-H row")
    for cell in cells:
        if len(cell) > PASTED.cell:
            rule = f"a number or a heading of at most {PASTED.cell} characters"
            raise InputError(TABLE, f"line {number}", cell, rule)
    return cells


def _at_blanks(line: str) -> list[str]:
    """Cells between blanks; "q2 - 90" is one."""
    cells: list[str] = []
    for word in line.split():
        joins = bool(cells) and written_plainly(cells[-1])[-1:] in ("+", "-") and len(cells[-1].strip()) > 1
        if joins or (cells and written_plainly(word) in ("+", "-") and _names_joint(cells[-1])):
            cells[-1] += f" {word}"
        elif len(cells) > 1 and written_plainly(cells[-1]) in ("+", "-") and _names_joint(word):
            cells[-2:] = [f"{cells[-2]} {cells[-1]} {word}"]
        else:
            cells.append(word)
    return cells


def _names_joint(cell: str) -> bool:
    read = read_dh_cell(cell)
    return read is not None and read.turns != 0


def _is_value(cell: str) -> bool:
    """A number, or the angle of a joint that is numbered; "theta" alone is a heading."""
    read = read_dh_cell(cell)
    return read is not None and (not read.turns or read.joint is not None)


def _named(header: Sequence[str], number: int, convention: Convention) -> tuple[tuple[str, ...], dict[str, str]]:
    """What the header's columns are, and the units that it states for them."""
    names, units = [], {}
    for cell in header:
        plain = re.sub(r"[${}\\]", "", unicodedata.normalize("NFKC", cell)).replace("\u2212", "-").lower()
        parts = HEADING.fullmatch(plain)
        assert parts is not None  # whatever stands before a unit is the word
        word, unit = parts.groups()
        below = SUBSCRIPT.search(word)
        if below and below["before"] and convention == "standard":
            rule = "a and alpha of the link before are Craig's (modified) convention"
            raise InputError(TABLE, f"line {number}", cell, rule, "Add --modified.")
        word = SUBSCRIPT.sub("", word) or word
        found = next((key for key, pattern in COLUMNS.items() if re.fullmatch(pattern, word)), None)
        if found is None:
            raise InputError(TABLE, f"line {number}", cell, "columns are a, alpha, d, theta, with units in brackets")
        if found in names and found not in ("", "theta_offset_deg"):
            raise InputError(TABLE, f"line {number}", cell, "each of a, alpha and d is one column")
        if unit and found:
            units[found] = _allowed_unit(unit, found, cell, number)
        names.append(found)
    if not {"a_mm", "alpha_deg", "d_mm"} <= set(names):
        raise InputError(TABLE, f"line {number}", " ".join(header), "a, alpha and d are needed in every row")
    return tuple(names), units


def _allowed_unit(unit: str, column: str, cell: str, number: int) -> str:
    unit = "deg" if unit in ("°", "degrees") else unit
    if (unit in MILLIMETRES) == column.endswith("mm"):
        return unit
    rule = "lengths are in mm, cm, m or in" if column.endswith("mm") else "angles are in deg or rad"
    raise InputError(TABLE, f"line {number}", cell, rule)


def _row(line: str, number: int, names: tuple[str, ...]) -> DHLine:
    cells = _cells(line, number)
    if names is USUAL and len(cells) in (4, 5) and not re.search(r"\d", cells[0]) and not _names_joint(cells[0]):
        cells = cells[1:]
    if not (len(cells) == len(names) or (names is USUAL and len(cells) == 3)):
        cure = "A row is a, alpha, d and, where it is not zero, theta (q2-90 without blanks)."
        cure = f"{cure} {_of_commas(line)}".strip()
        raise InputError(TABLE, f"line {number}", line, f"{len(names)} numbers in a row", cure)
    read: dict[str, DHCell] = {}
    theta = ""
    for name, cell in zip(names, cells, strict=False):
        if not name or (name == "theta_offset_deg" and written_plainly(cell) in ("", "-")):
            continue
        value = read_dh_cell(cell)
        if value is None or not _fits(value, name):
            rule, cure = _what_fits(name)
            place = f"line {number}, column {name.partition('_')[0]}"
            raise InputError(TABLE, place, cell, rule, f"{cure} {_of_commas(line)}".strip())
        if name == "theta_offset_deg":
            theta = f"{theta} {cell}".strip()
            value = _both(read[name], value, number, theta) if name in read else value
        read[name] = value
    return DHLine(number, read, theta)


def _of_commas(line: str) -> str:
    """What to do where commas that part cells may be decimal ones; "" where they can't."""
    cure = "With decimal commas, part the cells by ; or tabs, or write decimal points."
    return cure if DIGITS_APART.search(line) else ""


def _both(one: DHCell, other: DHCell, number: int, text: str) -> DHCell:
    """A joint's angle in a column of its own, and what is added to it in another."""
    if one.turns and other.turns:
        raise InputError(TABLE, f"line {number}, column theta", text, "one joint's angle stands in a row")
    sums = {key: getattr(one, key) + getattr(other, key) for key in ("plain", "degrees", "radians", "turns")}
    return DHCell(**sums, joint=one.joint if one.turns else other.joint)


def _fits(value: DHCell, name: str) -> bool:
    if name == "theta_offset_deg":
        return True
    return not value.turns and (name == "alpha_deg" or not (value.degrees or value.radians))


def _what_fits(name: str) -> tuple[str, str]:
    """What may stand in a column, and what to do about anything else."""
    if name == "theta_offset_deg":
        rule = "a number, or a joint's angle with a number or a multiple of pi added: q2, q2-90, -q3+pi/2"
        return rule, "Coupled joints are stated by `actuation` in robot.yaml: write q2 here, and the sum there."
    if name == "alpha_deg":
        return "a number, or a multiple of pi", ""
    cure = "A joint that slides (d3, q3+100) is no row here: write its length where it is held, or give a URDF."
    return "a number", cure if name == "d_mm" else "Write the length instead of its symbol."
