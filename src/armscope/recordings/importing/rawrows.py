"""Rows of raw files as columns of words and numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array, Indices
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.importing.formats import CellsFormat, Column, TextFormat

TOO_LARGE = f"no recorded value reaches {POSSIBLE.number:.0e}"

NO_VALUE = "Declare it under `missing` if it stands for no value."


@dataclass(frozen=True, eq=False)
class TextRows:
    """Some rows of a delimited file."""

    source: Path
    names: tuple[str, ...]  # its header; empty where it has none
    numbers_of_rows: Indices  # (N,) rows of the file without its header, counted from 1
    lines: Indices  # (N,) lines of the file, for messages
    cells: list[list[str]]  # N rows of words
    format: CellsFormat  # how the file writes numbers

    def __len__(self) -> int:
        return len(self.cells)

    def words(self, column: Column) -> list[str]:
        """The words of a column, blanks around them removed."""
        index = _index(self.source, self.names, len(self.cells[0]) if self.cells else 0, column, self.format)
        return [row[index].strip() for row in self.cells]

    def numbers(self, column: Column) -> Array:
        """The numbers of a column, NaN where it says that there is none."""
        words = self.words(column)
        if (thousands := self.format.thousands) is not None:
            words = [without_thousands(word, thousands) for word in words]
        as_float = _to_floats(words, self.format)
        if as_float is not None:
            return as_float
        return np.array([self._number(row, column, word) for row, word in enumerate(words)])

    def _number(self, row: int, column: Column, word: str) -> float:
        if word in self.format.missing:
            return np.nan
        rule, wrong_sign = "this must be a finite number", "," if self.format.decimal == "." else "."
        cure = "The header stands here a second time: remove this line." if word == str(column) else ""
        if not cure and self.numbers_of_rows[row] == 1 and not any(map(str.isdigit, word)):
            cure = "If this line names the columns, leave out `header: false`."
            if self.names:
                cure = f"If this line holds units, declare `below_header: {self.format.below_header + 1}`."
        if sign := sign_of_thousands([word]):
            cure = f"Is {sign!r} the sign between its thousands? Then declare `thousands: {sign!r}`."
        elif {".", ","} <= set(word):
            cure = "Write it without signs between thousands."
        elif wrong_sign in word:
            cure = (
                f"The mapping declares decimal: {self.format.decimal!r} for the whole file, this number uses another."
            )
        elif "_" not in word:
            try:
                value = float(word.replace(",", "."))
            except ValueError:
                pass
            else:
                if abs(value) <= POSSIBLE.number:
                    return value
                cure = NO_VALUE
                rule = TOO_LARGE if np.isfinite(value) else rule
        if not cure:
            cure = f"{NO_VALUE} If this line is no row of the table, remove it, or say `last_line` where rows end."
        place = f"line {self.lines[row]}, column {column}"
        raise InputError(self.source, place, word, rule, cure)

    def take(self, which: Indices) -> TextRows:
        """Some of the rows, in that order."""
        cells = [self.cells[row] for row in which]
        return replace(self, cells=cells, lines=self.lines[which], numbers_of_rows=self.numbers_of_rows[which])


GROUPED = re.compile(r"[+-]?\d{1,3}(?P<sign>[,.' ])\d{3}((?P=sign)\d{3})*(?P<rest>[.,]\d+)?")
_ANY_BLANK = re.compile("[\u00a0\u2007\u2009\u202f]")
_ANY_APOSTROPHE = re.compile("[\u2019\u02bc]")


def _grouped(word: str) -> re.Match[str] | None:
    return GROUPED.fullmatch(_ANY_APOSTROPHE.sub("'", _ANY_BLANK.sub(" ", word)))


def sign_of_thousands(words: Iterable[str]) -> str:
    """The sign between thousands that some numbers can only have; "" where none has one.

    "1,234" may be a number with three decimals: a comma or a point counts where a decimal sign follows, or it returns.
    """
    for word in words:
        if found := _grouped(word):
            sign, rest = found["sign"], found["rest"]
            if sign in " '" or word.count(sign) > 1 or (rest and rest[0] != sign):
                return sign
    return ""


def without_thousands(word: str, sign: str) -> str:
    """A number without the signs between its thousands; any other word as it is."""
    found = _grouped(word)
    return found.group().replace(sign, "") if found and found["sign"] == sign else word


def _to_floats(words: list[str], style: CellsFormat) -> Array | None:
    """All words as finite numbers, or None where one of them is not a plain number (the slow way then says which)."""
    joined = "\n".join(words)
    if "_" in joined or (style.decimal == "," and "." in joined):
        return None
    if style.decimal == ",":
        words = joined.replace(",", ".").split("\n")
    try:
        values = np.fromiter(map(float, words), dtype=float, count=len(words))
    except ValueError:
        return None
    return values if (np.abs(values) <= POSSIBLE.number).all() else None


@dataclass(frozen=True, eq=False)
class MatrixRows:
    """Some rows of a MATLAB matrix; attributes as in `TextRows`, with ``values`` (N, columns)."""

    source: Path
    numbers_of_rows: Indices
    values: Array

    @property
    def lines(self) -> Indices:
        """A matrix has rows where text has lines."""
        return self.numbers_of_rows

    def __len__(self) -> int:
        return len(self.values)

    def numbers(self, column: Column) -> Array:
        """The numbers of a column; NaN stands for no value."""
        values = self.values[:, _index(self.source, (), self.values.shape[1], column)]
        beyond = np.abs(values) > POSSIBLE.number
        if beyond.any():
            row = int(beyond.argmax())
            place = f"row {self.numbers_of_rows[row]}, column {column}"
            raise InputError(self.source, place, f"{values[row]:g}", TOO_LARGE, "Write NaN where there is no value.")
        return values

    def words(self, column: Column) -> list[str]:
        """The numbers of a column as words: whole numbers without a point."""
        return ["" if np.isnan(value) else f"{value:.12g}" for value in self.numbers(column)]

    def take(self, which: Indices) -> MatrixRows:
        """Some of the rows, in that order."""
        return replace(self, values=self.values[which], numbers_of_rows=self.numbers_of_rows[which])


RawRows = TextRows | MatrixRows


def _index(
    source: Path, names: tuple[str, ...], n_columns: int, column: Column, style: CellsFormat | None = None
) -> int:
    if isinstance(column, int):
        if column > n_columns:
            raise InputError(
                source, f"column {column}", f"{n_columns} columns", "the mapping names a column beyond them"
            )
        return column - 1
    if not names:
        rule = "the mapping names a column, but this file has no header"
        raise InputError(source, "", column, rule, f"Use numbers: 1 ... {n_columns}.")
    count = names.count(column)
    if count == 0:
        cure = nearest(column, names)
        if isinstance(style, TextFormat) and len(names) == 1 and any(sign in names[0] for sign in ",;\t| "):
            cure = f"The header is {names[0][:40]!r}: is its delimiter really {style.delimiter!r}?"
        raise InputError(source, "header", f"no column {column}", "the mapping names this column", cure)
    if count > 1:
        rule = f"the header has this name {count} times"
        raise InputError(source, "header", column, rule, "Name the column by its number, counted from 1.")
    return names.index(column)


def joined(pieces: list[RawRows]) -> RawRows:
    """Pieces of one file, one after the other, as one."""
    texts = [piece for piece in pieces if isinstance(piece, TextRows)]
    if len(texts) < 2:  # a matrix comes as one piece
        return pieces[0]
    return replace(
        texts[0],
        cells=[row for piece in texts for row in piece.cells],
        lines=np.concatenate([piece.lines for piece in texts]),
        numbers_of_rows=np.concatenate([piece.numbers_of_rows for piece in texts]),
    )
