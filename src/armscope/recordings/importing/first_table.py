"""How a foreign table is cut, seen from its first lines: delimiter, decimal sign, header, encoding."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.recordings.constants import PIECES
from armscope.recordings.importing.constants import DRAFT, LIMITS
from armscope.recordings.importing.rawrows import sign_of_thousands, without_thousands
from armscope.recordings.importing.stated_units import ANGLE_UNITS, LENGTH_UNITS
from armscope.recordings.importing.workbooks import is_workbook, sheet_rows, sheets_of
from armscope.recordings.opening import UTF_16, open_text, refuse_other_than_text, start_of

DELIMITERS = {";": ";", "\t": "tab", "|": "|", ",": ","}
CHINESE = re.compile(r"([\xa1-\xfe][\xa1-\xfe])+")
"""Runs of bytes beyond ASCII in texts of GB 2312, which come in twos; those of Western texts mostly stand alone."""
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


@dataclass(frozen=True)
class TableCut:
    """How a table's lines become cells, and cells numbers, as mappings call it.

    Args:
        delimiter: between cells of text; "" in a workbook.
        encoding: of text; "" in a workbook.
        decimal: sign of numbers.
        thousands: sign between groups of three digits; "" for none.
        sheet: of a workbook; "" for text.
        other_sheets: that the workbook has besides.
    """

    delimiter: str
    encoding: str
    decimal: str = "."
    thousands: str = ""
    sheet: str = ""
    other_sheets: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class ForeignTable:
    """The first lines of a foreign table: how they are cut, their names, their numbers (NaN where none is)."""

    cut: TableCut  # how lines become cells, and cells numbers
    skip: int  # lines above the header, or above the first row where there is none
    names: list[str]  # of the columns, or their numbers
    header: bool  # whether the first line names the columns
    values: Array  # (rows, columns)
    cells: list[list[str]]  # the words that the numbers were read from
    units: list[str]  # the cells of a line of units below the header; empty where there is none
    file: Path  # the table's
    groups: list[str]  # what a line above the names says is the unit of each column's group; empty where there is none

    def words(self, columns: Sequence[int]) -> list[str]:
        """What stands in some columns in place of a number and holds no digit, "---" or "n/a", in order."""
        at = np.argwhere(np.isnan(self.values[:, columns]))
        found = dict.fromkeys(self.cells[row][columns[column]] for row, column in at.tolist())
        return [word for word in found if not any(sign.isdigit() for sign in word)]


def first_table(path: Path) -> ForeignTable:
    """The first lines of a delimited text table. Raises InputError: it is no text table, or has no rows."""
    start = start_of(path, "a table of recordings")
    if is_workbook(start):
        return _of_cells(path, *_first_sheet(path))
    encoding, lines = _decoded(path, start)
    filled = [line for line in lines if line.strip()]
    _refuse_few(path, len(filled))
    delimiter, cut = _delimiter(filled)
    width = Counter(len(_split(line, cut)) for line in filled).most_common(1)[0][0]
    if width > PIECES.columns:
        raise InputError(path, "", f"{width} columns", f"a table has at most {PIECES.columns} columns")
    rows = [(number, cells) for number, line in enumerate(lines) if len(cells := _split(line, cut)) == width]
    rows = [(number, cells) for number, cells in rows if lines[number].strip()]
    return _of_cells(path, rows, TableCut(delimiter, encoding))


def _of_cells(path: Path, numbered: Sequence[tuple[int, list[str]]], cut: TableCut) -> ForeignTable:
    """A table from its rows, each with the number of its line, from 0."""
    first, rows = numbered[0][0], [cells for _, cells in numbered]
    thousands = _thousands([cell for row in rows for cell in row])
    decimal = {",": ".", ".": ","}.get(thousands, "," if _has_decimal_commas(rows, thousands) else ".")
    numbers = np.array([[_value(cell, decimal, thousands) for cell in row] for row in rows], dtype=float)
    words = [not np.isfinite(row).any() for row in numbers]
    group = _lines_of_groups(rows, words)
    above = _of_groups(rows[group - 1]) if group else []
    first, rows, numbers, words = numbered[group][0], rows[group:], numbers[group:], words[group:]
    header = words[0]
    names = rows[0] if header else [str(number) for number in range(1, len(rows[0]) + 1)]
    for name in names:
        if len(name) > LIMITS.name:
            raise InputError(path, f"line {first + 1}", name, f"column names of at most {LIMITS.name} characters")
    units = rows[1] if header and len(rows) > 2 and words[1] and _is_of_units(rows[1]) else []
    head = header + bool(units)
    if len(rows) == head:
        raise InputError(path, "", "a header alone", "rows are needed to guess units from")
    cut = replace(cut, decimal=decimal, thousands=thousands)
    return ForeignTable(cut, first, names, header, numbers[head:], rows[head:], units, path, above)


def _of_groups(cells: Sequence[str]) -> list[str]:
    """Units in the brackets of a line of groups, each also of the columns to its right that have no group."""
    units: list[str] = []
    if sum(map(bool, cells)) < 2:
        return []  # a title
    for cell in cells:
        found = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", cell)
        units.append((found[1] if found else "") if cell or not units else units[-1])
    return units


def _thousands(cells: Sequence[str]) -> str:
    """The sign between thousands; none where it is another number's decimal sign (192.168.100.100 beside 1.5)."""
    sign = sign_of_thousands(cells)
    if sign not in (".", ","):
        return sign
    decimal = re.compile(rf"[+-]?(\d+[{sign}](\d{{1,2}}|\d{{4,}})|\d{{4,}}[{sign}]\d+)")
    return "" if any(map(decimal.fullmatch, cells)) else sign


def _lines_of_groups(rows: Sequence[Sequence[str]], words: Sequence[bool]) -> int:
    """How many lines above the names say what groups of columns are: of the lines of words, the names differ most."""
    if all(words):
        return 0
    lines = [len({cell for cell in row if cell}) for row in rows[: words.index(False)]]
    return max(range(len(lines)), key=lambda line: (not _is_of_units(rows[line]), lines[line]), default=0)


def _first_sheet(path: Path) -> tuple[list[tuple[int, list[str]]], TableCut]:
    """The first sheet of a workbook that holds a table."""
    rows: list[tuple[int, list[str]]] = []
    names = sheets_of(path)
    for name in names:
        try:
            rows = [row for row, _ in zip(sheet_rows(path, name, "."), range(LIMITS.lines), strict=False)]
        except InputError:
            if name == names[-1]:
                raise
            continue
        filled = [sum(map(bool, cells)) for _, cells in rows]
        wide = Counter(count for count in filled if count).most_common(1)[0][0]
        first = next(at for at, count in enumerate(filled) if 2 * count > wide)
        if first and filled[first - 1] > 1:
            first -= 1  # a line of groups, it may be
        rows = [(number - 1, cells) for number, cells in rows[first:] if any(cells)]
        if len(rows) > 1 or name == names[-1]:
            break
    _refuse_few(path, len(rows))
    return rows, TableCut("", "", sheet=name, other_sheets=tuple(each for each in names if each != name))


def _refuse_few(path: Path, lines: int) -> None:
    if lines < 2:
        raise InputError(path, "", f"{lines} line{'s' * (lines != 1)}", "a table has a header or a row, and rows")


def _decoded(path: Path, start: bytes) -> tuple[str, list[str]]:
    """The encoding of a text, and its first lines; what is no UTF-8 is taken for GB 18030 where all of it could be."""
    encoding = "utf-16" if start.startswith(UTF_16) else "utf-8-sig"
    refuse_other_than_text(path, start, encoding, "")
    try:
        return encoding, _first_lines(path, encoding)
    except UnicodeError as error:
        if encoding == "utf-16":
            raise InputError(path, "", str(error), "UTF-16 text is cut off or spoilt", "Save it as UTF-8.") from error
    lines = _first_lines(path, "latin-1")
    foreign = re.findall(r"[\x80-\xff]+", "\n".join(lines))
    if all(len(word) % 2 == 0 and CHINESE.fullmatch(word) for word in foreign):
        return "gb18030", [line.encode("latin-1").decode("gb18030", "replace") for line in lines]
    return "latin-1", lines


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
    if sign is not None and '"' in line:
        try:
            return [cell.strip() for cell in next(csv.reader([line], delimiter=sign, skipinitialspace=True))]
        except csv.Error:
            pass
    return [cell.strip().strip('"') for cell in line.split(sign)]


def _has_decimal_commas(rows: Sequence[Sequence[str]], thousands: str) -> bool:
    """Whether many cells have one, or one that thousands without commas tell."""
    cells = [(cell, without_thousands(cell, thousands)) for row in rows for cell in row]
    with_comma = [cell != bare for cell, bare in cells if re.fullmatch(r"[+-]?\d+,\d+([eE][+-]?\d+)?", bare)]
    return any(with_comma) or len(with_comma) > DRAFT.decimal_commas * len(cells)


def _plain(cell: str, decimal: str) -> str:
    return cell.replace(",", ".") if decimal == "," else cell


def _value(cell: str, decimal: str, thousands: str) -> float:
    plain = _plain(without_thousands(cell, thousands), decimal)
    return float(plain) if NUMBER.fullmatch(plain) else np.nan


def below_name(table: ForeignTable, column: int) -> str:
    """What a line of units, or of groups, says of a column; "" where there is none."""
    return next((line[column] for line in (table.units, table.groups) if line), "")


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
