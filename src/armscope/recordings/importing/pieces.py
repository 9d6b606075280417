"""Rows of a run as they are read: with the files beside, and past the row filters."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array, Indices
from armscope.recordings.importing.constants import LIMITS
from armscope.recordings.importing.formats import Column, Format, RowFilter
from armscope.recordings.importing.mapping import Beside, RunFiles
from armscope.recordings.importing.rawfiles import read_pieces
from armscope.recordings.importing.rawrows import RawRows, joined


@dataclass
class LeftOut:
    """What one row filter left out: the rule in words, and the source rows."""

    rule: str
    rows: list[int] = field(default_factory=list)


class BesideFile:
    """A file whose rows stand beside those of a run's first file, read along with it."""

    def __init__(self, other: Beside, path: Path, style: Format, notes: Counter[str]) -> None:
        self.other, self.path = other, path
        self.coming = read_pieces(path, style, notes)
        self.held: list[RawRows] = []
        self.rows_read = 0

    def row_numbers(self, main_rows: Indices) -> Indices:
        """Rows (from 1) that belong to ``main_rows`` (from 1) of the first file; they are there."""
        rows = (main_rows - 1) // self.other.repeat_each + 1
        if not self._read_to(rows.max()):
            self._unequal(f"row {main_rows.max()} of the first file")
        return rows

    def take(self, main_rows: Indices) -> RawRows:
        """The rows that belong to ``main_rows``."""
        rows = self.row_numbers(main_rows)
        self.held = [joined(self.held)]
        return self.held[0].take(rows - self.held[0].numbers_of_rows[0])

    def forget_before(self, main_row: int) -> None:
        """No earlier row of the first file will be asked for."""
        row = (main_row - 1) // self.other.repeat_each + 1
        self.held = [piece for piece in self.held if piece.numbers_of_rows[-1] >= row]

    def check_all_used(self, rows_read: int) -> None:
        """After the first file's last row: none may be left over here. Raises InputError: the two files have unequal
        numbers of rows."""
        self.held = []
        for piece in self.coming:
            self.rows_read += len(piece)
        if rows_read != self.rows_read * self.other.repeat_each:
            self._unequal(f"{rows_read} rows in the first file")

    def _read_to(self, row: int) -> bool:
        while self.rows_read < row:
            piece = next(self.coming, None)
            if piece is None:
                return False
            self.held.append(piece)
            self.rows_read += len(piece)
        return True

    def _unequal(self, found: str) -> None:
        rule = f"this file has {self.rows_read} rows for {self.other.repeat_each} each of the first file"
        raise InputError(self.path, "", found, rule, "Change `repeat_each`, or the pair of files.")


class BesideFiles:
    """The files whose rows stand beside those of a run's first file, by their names."""

    def __init__(self, style: Format, run: RunFiles, paths: dict[str, Path], notes: Counter[str]) -> None:
        self.files = {
            other.name: BesideFile(other, paths[other.file], other.format or style, notes) for other in run.beside
        }

    def __getitem__(self, name: str) -> BesideFile:
        if name not in self.files:
            cure = nearest(name, self.files) if self.files else "The run has no `beside`."
            raise InputError("mapping", "columns", name, "no file beside has this name", cure)
        return self.files[name]

    def __bool__(self) -> bool:
        return bool(self.files)

    def forget_before(self, main_row: int) -> None:
        """No earlier row of the first file will be asked for."""
        for file in self.files.values():
            file.forget_before(main_row)

    def check_all_used(self, rows_read: int) -> None:
        """After the last piece: no file beside may have rows left over."""
        for file in self.files.values():
            file.check_all_used(rows_read)


@dataclass(frozen=True, eq=False)
class Piece:
    """Rows of a run's first file together with what stands beside them."""

    rows: RawRows
    beside: BesideFiles

    def __len__(self) -> int:
        return len(self.rows)

    def _where(self, column: Column) -> tuple[RawRows, Column]:
        """The rows that a column is taken from, and its name there: "name:column" is of the file beside."""
        if not isinstance(column, str) or ":" not in column or not self.beside:
            return self.rows, column
        name, _, own = column.partition(":")
        return self.beside[name].take(self.rows.numbers_of_rows), int(own) if own.isdigit() else own

    def numbers(self, column: Column) -> Array:
        """(N,) the numbers of a column, NaN for none."""
        rows, own = self._where(column)
        return rows.numbers(own)

    def stack(self, columns: tuple[Column, ...]) -> Array:
        """(N, columns) the numbers of several columns."""
        return np.column_stack([self.numbers(column) for column in columns])

    def words(self, column: Column) -> list[str]:
        """The words of a column."""
        rows, own = self._where(column)
        return rows.words(own)

    def keep(self, which: NDArray[np.bool_]) -> Piece:
        """The rows where ``which``."""
        return self if which.all() else Piece(self.rows.take(np.flatnonzero(which)), self.beside)

    def error(self, row: int, columns: tuple[Column, ...], found: object, rule: str, cure: str = "") -> InputError:
        """What is wrong with a row, at its place in the file that the first of the columns is taken from.

        Args:
            row: of the piece, from 0.
            columns: those of the table that are concerned.
            found: the value.
            rule: what is allowed.
            cure: how to mend it.

        Returns:
            The error, to be raised.
        """
        rows, _ = self._where(columns[0])
        names = (
            f"{columns[0]} ... {columns[-1]}" if len(columns) > LIMITS.columns_named else ", ".join(map(str, columns))
        )
        return InputError(rows.source, f"line {rows.lines[row]}, column {names}", found, rule, cure)


def _called(columns: tuple[Column, ...]) -> str:
    """Columns in words: names as they are, numbers as those of columns."""
    counted = isinstance(columns[0], int)
    return ("columns " if len(columns) > 1 else "column ") * counted + ", ".join(map(str, columns))


class Filter:
    """One row filter at work over the pieces of a run."""

    def __init__(self, rule: RowFilter) -> None:
        self.rule = rule
        self.seen: set[tuple[str, ...]] = set()
        self.left_out = LeftOut(self._in_words())

    def _in_words(self) -> str:
        rule = self.rule
        if rule.drop_missing is not None:
            return f"no value in {_called(rule.drop_missing)}"
        if rule.first_of is not None:
            return f"not the first row of its {_called(rule.first_of)}"
        if rule.between is not None:
            low = "" if rule.between.low is None else f" >= {rule.between.low:g}"
            high = "" if rule.between.high is None else f" <= {rule.between.high:g}"
            return f"column {rule.between.column} not" + low + high
        assert rule.equal is not None
        return f"column {rule.equal.column} not equal to {rule.equal.value}"

    def apply(self, piece: Piece) -> Piece:
        """The rows that stay; the others are noted in ``left_out``."""
        if not len(piece):
            return piece
        keep = self._kept(piece)
        self.left_out.rows += piece.rows.numbers_of_rows[~keep].tolist()
        return piece.keep(keep)

    def _kept(self, piece: Piece) -> NDArray[np.bool_]:
        rule = self.rule
        if rule.drop_missing is not None:
            return np.asarray(np.isfinite(piece.stack(rule.drop_missing)).all(axis=1))
        if rule.first_of is not None:
            keys = list(zip(*(piece.words(column) for column in rule.first_of), strict=True))
            return np.array([self._is_new(key) for key in keys])
        if rule.between is not None:
            values = piece.numbers(rule.between.column)
            low = -np.inf if rule.between.low is None else rule.between.low
            return (values >= low) & (values <= (np.inf if rule.between.high is None else rule.between.high))
        assert rule.equal is not None
        if isinstance(rule.equal.value, str):
            return np.array([word == rule.equal.value for word in piece.words(rule.equal.column)])
        return np.asarray(piece.numbers(rule.equal.column) == rule.equal.value)

    def _is_new(self, key: tuple[str, ...]) -> bool:
        if key in self.seen:
            return False
        self.seen.add(key)
        return True
