"""How a foreign table is cut, seen from its first lines: delimiter, decimal sign, header, encoding."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.recordings.constants import PIECES
from armscope.recordings.importing.constants import DRAFT, LIMITS
from armscope.recordings.importing.stated_units import ANGLE_UNITS, LENGTH_UNITS
from armscope.recordings.opening import UTF_16, open_text, refuse_other_than_text, start_of

DELIMITERS = {";": ";", "\t": "tab", "|": "|", ",": ","}
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


@dataclass(frozen=True, eq=False)
class ForeignTable:
    """The first lines of a foreign table: how they are cut, their names, their numbers (NaN where none is).

    Attributes:
        delimiter, decimal, encoding: as mappings call them.
        skip: lines above the header, or above the first row where there is none.
        names: of the columns, or their numbers.
        header: whether the first line names the columns.
        values: (rows, columns).
        cells: the words that the numbers were read from.
        units: the cells of a line of units below the header; empty where there is none.
        file: the table's.
    """

    delimiter: str
    decimal: str
    skip: int
    names: list[str]
    header: bool
    values: Array
    encoding: str
    cells: list[list[str]]
    units: list[str]
    file: Path

    def words(self, columns: Sequence[int]) -> list[str]:
        """What stands in some columns in place of a number and holds no digit, "---" or "n/a", in order."""
        at = np.argwhere(np.isnan(self.values[:, columns]))
        found = dict.fromkeys(self.cells[row][columns[column]] for row, column in at.tolist())
        return [word for word in found if not any(sign.isdigit() for sign in word)]


def first_table(path: Path) -> ForeignTable:
    """The first lines of a delimited text table.

    Raises:
        InputError: it is no text table, or has no rows.
    """
    start = start_of(path, "a table of recordings")
    encoding = "utf-16" if start.startswith(UTF_16) else "utf-8-sig"
    refuse_other_than_text(path, start, encoding, "")
    try:
        lines = _first_lines(path, encoding)
    except UnicodeError as error:
        if encoding == "utf-16":
            raise InputError(path, "", str(error), "UTF-16 text is cut off or spoilt", "Save it as UTF-8.") from error
        encoding = "latin-1"
        lines = _first_lines(path, encoding)
    filled = [line for line in lines if line.strip()]
    if len(filled) < 2:
        raise InputError(
            path, "", f"{len(filled)} line{'s' * (len(filled) != 1)}", "a table has a header or a row, and rows"
        )
    delimiter, cut = _delimiter(filled)
    width = Counter(len(_split(line, cut)) for line in filled).most_common(1)[0][0]
    if width > PIECES.columns:
        raise InputError(path, "", f"{width} columns", f"a table has at most {PIECES.columns} columns")
    first = next(number for number, line in enumerate(lines) if line.strip() and len(_split(line, cut)) == width)
    rows = [cells for line in lines[first:] if len(cells := _split(line, cut)) == width]
    decimal = "," if cut != "," and _has_decimal_commas(rows) else "."
    header = not any(NUMBER.fullmatch(_plain(cell, decimal)) for cell in rows[0])
    names = rows[0] if header else [str(number) for number in range(1, width + 1)]
    for name in names:
        if len(name) > LIMITS.name:
            raise InputError(path, f"line {first + 1}", name, f"column names of at most {LIMITS.name} characters")
    body = rows[1:] if header else rows
    units = body[0] if header and len(body) > 1 and _is_of_units(body[0]) else []
    body = body[1:] if units else body
    numbers = np.array([[_value(cell, decimal) for cell in row] for row in body], dtype=float)
    if not len(numbers):
        raise InputError(path, "", "a header alone", "rows are needed to guess units from")
    return ForeignTable(delimiter, decimal, first, names, header, numbers, encoding, body, units, path)


def _is_of_units(cells: Sequence[str]) -> bool:
    """Whether a line below the header says units: an angle's or a length's at least, and no number."""
    words = {cell.lower().strip(" []()") for cell in cells}
    return bool(words & {*ANGLE_UNITS, *LENGTH_UNITS}) and not any(map(NUMBER.fullmatch, words))


def _first_lines(path: Path, encoding: str) -> list[str]:
    with open_text(path, encoding) as stream:
        return [line.rstrip("\r\n") for line, _ in zip(stream, range(LIMITS.lines), strict=False)]


def _delimiter(lines: Sequence[str]) -> tuple[str, str | None]:
    """What the mapping calls the delimiter that cuts most lines alike, and the sign itself (None: white space)."""
    best: tuple[str, str | None] = ("whitespace", None)
    most = 0.0
    for sign in (*DELIMITERS, None):
        width, alike = Counter(len(_split(line, sign)) for line in lines).most_common(1)[0]
        found = alike / len(lines) * (width > 3)
        if found > most + DRAFT.clearly_alike:
            best, most = ("whitespace" if sign is None else DELIMITERS[sign], sign), found
    return best


def _split(line: str, sign: str | None) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(sign)]


def _has_decimal_commas(rows: Sequence[Sequence[str]]) -> bool:
    cells = [cell for row in rows for cell in row]
    with_comma = sum(bool(re.fullmatch(r"[+-]?\d+,\d+([eE][+-]?\d+)?", cell)) for cell in cells)
    return with_comma > DRAFT.decimal_commas * len(cells)


def _plain(cell: str, decimal: str) -> str:
    return cell.replace(",", ".") if decimal == "," else cell


def _value(cell: str, decimal: str) -> float:
    plain = _plain(cell, decimal)
    return float(plain) if NUMBER.fullmatch(plain) else np.nan


def below_name(table: ForeignTable, column: int) -> str:
    """What a line of units says of a column; "" where there is none."""
    return table.units[column] if table.units else ""


def column_list(table: ForeignTable, columns: Sequence[int]) -> str:
    """Columns as mappings list them: by name, or counted from 1."""
    if not table.header:
        return "[" + ", ".join(str(column + 1) for column in columns) + "]"
    return "[" + ", ".join(quoted(table.names[column]) for column in columns) + "]"


def quoted(name: str) -> str:
    """A name as YAML takes it whatever it holds."""
    return "'" + name.replace("'", "''") + "'"


def printable(name: str) -> str:
    """A name that ends no comment and breaks no line."""
    return "".join(sign if sign.isprintable() else "?" for sign in name)
