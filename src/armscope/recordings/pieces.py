"""Rows of a run as they are read: with the files beside, and past the row filters."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armscope.inputs import InputError, nearest
from armscope.recordings.mapping import Column, Mapping, RowFilter, Run
from armscope.recordings.rawfiles import RawRows, read_whole

Array = NDArray[np.float64]


@dataclass
class LeftOut:
    """What one row filter left out: the rule in words, and the source rows."""

    rule: str
    rows: list[int] = field(default_factory=list)


class BesideFiles:
    """The files whose rows stand beside those of a run's first file."""

    def __init__(self, mapping: Mapping, run: Run, paths: dict[str, Path], notes: Counter[str]) -> None:
        self.tables = {
            other.name: (read_whole(paths[other.file], other.format or run.format or mapping.format, notes), other)
            for other in run.beside
        }

    def row_numbers(self, name: str, main_rows: NDArray[np.intp]) -> NDArray[np.intp]:
        """Rows (from 1) of the file called ``name`` that belong to ``main_rows`` (from 1) of the first file."""
        if name not in self.tables:
            cure = nearest(name, self.tables) if self.tables else "The run has no `beside`."
            raise InputError("mapping", "columns", name, "no file beside has this name", cure)
        table, other = self.tables[name]
        rows = (main_rows - 1) // other.repeat_each + 1
        if rows.max() > len(table):
            self._unequal(name, f"row {main_rows.max()} of the first file")
        return rows

    def check_all_used(self, rows_read: int) -> None:
        """After the last piece: no file beside may have rows left over."""
        for name, (table, other) in self.tables.items():
            if rows_read != len(table) * other.repeat_each:
                self._unequal(name, f"{rows_read} rows in the first file")

    def _unequal(self, name: str, found: str) -> None:
        table, other = self.tables[name]
        rule = f"this file has {len(table)} rows for {other.repeat_each} each of the first file"
        raise InputError(table.source, "", found, rule, "Change `repeat_each`, or the pair of files.")


@dataclass(frozen=True, eq=False)
class Piece:
    """Rows of a run's first file together with what stands beside them."""

    rows: RawRows
    beside: BesideFiles

    def __len__(self) -> int:
        return len(self.rows)

    def _where(self, column: Column) -> tuple[RawRows, Column]:
        """The rows that a column is taken from, and its name there: "name:column" is of the file beside."""
        if not isinstance(column, str) or ":" not in column or not self.beside.tables:
            return self.rows, column
        name, _, own = column.partition(":")
        which = self.beside.row_numbers(name, self.rows.numbers_of_rows)
        return self.beside.tables[name][0].take(which - 1), int(own) if own.isdigit() else own

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

    def place(self, row: int, columns: tuple[Column, ...]) -> str:
        """Where a value stands, for messages."""
        return f"line {self.rows.lines[row]}, column {', '.join(map(str, columns))}"


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
        return piece.numbers(rule.equal.column) == rule.equal.value

    def _is_new(self, key: tuple[str, ...]) -> bool:
        if key in self.seen:
            return False
        self.seen.add(key)
        return True
