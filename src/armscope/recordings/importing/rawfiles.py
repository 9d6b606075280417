"""Raw files as rows of columns, a piece at a time: delimited text and MATLAB matrices. Never a pickle."""

from __future__ import annotations

import csv
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO

import numpy as np
import scipy.io
from numpy.typing import NDArray
from scipy.io.matlab import MatReadError

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.recordings.columns import LARGEST_NUMBER
from armscope.recordings.importing.formats import Column, Format, MatlabFormat, TextFormat
from armscope.recordings.opening import open_text, refuse_other_than_text, refuse_pickles, start_of, undecodable

ROWS_PER_PIECE = 20_000
REMARKS = "#%!/"
DELIMITERS = {"tab": "\t"}
TOO_LARGE = f"no recorded value reaches {LARGEST_NUMBER:.0e}"


@dataclass(frozen=True, eq=False)
class TextRows:
    """Some rows of a delimited file.

    Attributes:
        source: the file.
        names: its header; empty where it has none.
        numbers_of_rows: (N,) rows of the file without its header, counted from 1.
        lines: (N,) lines of the file, for messages.
        cells: N rows of words.
        format: how the file writes numbers.
    """

    source: Path
    names: tuple[str, ...]
    numbers_of_rows: NDArray[np.intp]
    lines: NDArray[np.intp]
    cells: list[list[str]]
    format: TextFormat

    def __len__(self) -> int:
        return len(self.cells)

    def words(self, column: Column) -> list[str]:
        """The words of a column, blanks around them removed."""
        index = _index(self.source, self.names, len(self.cells[0]) if self.cells else 0, column, self.format)
        return [row[index].strip() for row in self.cells]

    def numbers(self, column: Column) -> Array:
        """The numbers of a column, NaN where it says that there is none."""
        words = self.words(column)
        as_float = _to_floats(words, self.format)
        if as_float is not None:
            return as_float
        return np.array([self._number(row, column, word) for row, word in enumerate(words)])

    def _number(self, row: int, column: Column, word: str) -> float:
        if word in self.format.missing:
            return np.nan
        rule, wrong_sign = "this must be a finite number", "," if self.format.decimal == "." else "."
        cure = "The header stands here a second time: remove this line." if word == str(column) else ""
        if not cure and self.numbers_of_rows[row] == 1:
            cure = "If this line names the columns, leave out `header: false`."
            if self.names:
                cure = f"If this line holds units, count columns: `header: false`, `skip_lines: {self.lines[row]}`."
        if wrong_sign in word:
            cure = (
                f"The mapping declares decimal: {self.format.decimal!r} for the whole file, this number uses another."
            )
        elif "_" not in word:
            try:
                value = float(word.replace(",", "."))
            except ValueError:
                pass
            else:
                if abs(value) <= LARGEST_NUMBER:
                    return value
                cure = "Declare it under `missing` if it stands for no value."
                rule = TOO_LARGE if np.isfinite(value) else rule
        place = f"line {self.lines[row]}, column {column}"
        raise InputError(self.source, place, word, rule, cure)

    def take(self, which: NDArray[np.intp]) -> TextRows:
        """Some of the rows, in that order."""
        cells = [self.cells[row] for row in which]
        return replace(self, cells=cells, lines=self.lines[which], numbers_of_rows=self.numbers_of_rows[which])


def _to_floats(words: list[str], style: TextFormat) -> Array | None:
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
    return values if (np.abs(values) <= LARGEST_NUMBER).all() else None


@dataclass(frozen=True, eq=False)
class MatrixRows:
    """Some rows of a MATLAB matrix; attributes as in `TextRows`, with ``values`` (N, columns)."""

    source: Path
    numbers_of_rows: NDArray[np.intp]
    values: Array

    @property
    def lines(self) -> NDArray[np.intp]:
        """A matrix has rows where text has lines."""
        return self.numbers_of_rows

    def __len__(self) -> int:
        return len(self.values)

    def numbers(self, column: Column) -> Array:
        """The numbers of a column; NaN stands for no value."""
        values = self.values[:, _index(self.source, (), self.values.shape[1], column)]
        beyond = np.abs(values) > LARGEST_NUMBER
        if beyond.any():
            row = int(beyond.argmax())
            place = f"row {self.numbers_of_rows[row]}, column {column}"
            raise InputError(self.source, place, f"{values[row]:g}", TOO_LARGE, "Write NaN where there is no value.")
        return values

    def words(self, column: Column) -> list[str]:
        """The numbers of a column as words: whole numbers without a point."""
        return ["" if np.isnan(value) else f"{value:.12g}" for value in self.numbers(column)]

    def take(self, which: NDArray[np.intp]) -> MatrixRows:
        """Some of the rows, in that order."""
        return replace(self, values=self.values[which], numbers_of_rows=self.numbers_of_rows[which])


RawRows = TextRows | MatrixRows


def _index(
    source: Path, names: tuple[str, ...], n_columns: int, column: Column, style: TextFormat | None = None
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
        if style is not None and len(names) == 1 and any(sign in names[0] for sign in ",;\t| "):
            cure = f"The header is {names[0][:40]!r}: is its delimiter really {style.delimiter!r}?"
        raise InputError(source, "header", f"no column {column}", "the mapping names this column", cure)
    if count > 1:
        rule = f"the header has this name {count} times"
        raise InputError(source, "header", column, rule, "Name the column by its number, counted from 1.")
    return names.index(column)


def read_pieces(path: Path, style: Format, notes: Counter[str]) -> Iterator[RawRows]:
    """The rows of a raw file, some thousands at a time, so that its size does not matter.

    Args:
        path: the file.
        style: how it is written.
        notes: counts what was passed over on the way (blank lines).

    Yields:
        Rows with their line numbers.

    Raises:
        InputError: the file can't be read, or a row has too few or too many values.
    """
    start = start_of(path, "a raw file")
    refuse_pickles(path, start)
    if isinstance(style, MatlabFormat):
        yield read_matrix(path, style)
        return
    refuse_other_than_text(path, start, style.encoding, "Declare `encoding: utf-16` in the mapping's format.")
    yield from _read_text(path, style, notes)


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


def _read_text(path: Path, style: TextFormat, notes: Counter[str]) -> Iterator[TextRows]:
    try:
        with open_text(path, style.encoding) as stream:
            yield from _gather(path, style, _split(path, stream, style), notes)
    except LookupError as error:
        raise InputError(path, "format.encoding", style.encoding, "no encoding of this name", "Try utf-8.") from error
    except UnicodeError as error:
        place, found = undecodable(path, style.encoding, error)
        rule = f"the text is not {style.encoding.removesuffix('-sig')}"
        raise InputError(path, place, found, rule, "Declare `encoding` in the mapping, e.g. latin-1.") from error
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(path, "", str(error), "this must be delimited text, plain or gzipped") from error


def _split(path: Path, stream: IO[str], style: TextFormat) -> Iterator[tuple[int, list[str]]]:
    """Line numbers and words of the rows that are neither skipped nor comments; of a flat list, of each row's lines."""
    for _ in range(style.skip_lines):
        next(stream, None)
    if style.delimiter == "whitespace":
        rows: Iterator[list[str]] = (line.split() for line in stream)
        numbered: Iterator[tuple[int, list[str]]] = enumerate(rows, start=style.skip_lines + 1)
    else:
        numbered = _separated(path, stream, style)
    held: list[str] = []
    for number, row in numbered:
        if style.last_line is not None and number > style.last_line:
            break
        if style.comment is not None and row and row[0].startswith(style.comment):
            continue
        if style.values_per_row is None:
            yield number, row
            continue
        held += row
        if len(held) >= style.values_per_row:
            yield number, held
            held = []
    if held:
        yield number, held


def _separated(path: Path, stream: IO[str], style: TextFormat) -> Iterator[tuple[int, list[str]]]:
    """The line that each row starts in, and its words; quotation marks may hold delimiters and ends of lines."""
    reader = csv.reader(stream, delimiter=DELIMITERS.get(style.delimiter, style.delimiter), skipinitialspace=True)
    line = style.skip_lines + 1
    try:
        for row in reader:
            yield line, row
            line = style.skip_lines + reader.line_num + 1
    except csv.Error as error:
        cure = "Is there a quotation mark that is never closed?"
        raise InputError(path, f"line {line}", str(error), "this must be delimited text", cure) from error


def _gather(
    path: Path, style: TextFormat, rows: Iterator[tuple[int, list[str]]], notes: Counter[str]
) -> Iterator[TextRows]:
    names: tuple[str, ...] = ()
    width = None
    if style.header:
        first = next(rows, None)
        if first is None:
            raise InputError(path, "line 1", "nothing", "the first line names the columns", "Is the file empty?")
        names = tuple(name.strip() for name in first[1])
        width = len(names)
    cells: list[list[str]] = []
    lines: list[int] = []
    done = 0
    for line, row in rows:
        if not any(word.strip() for word in row):
            notes["blank lines passed over"] += 1
            continue
        width = width or len(row)
        if len(row) != width:
            cure = _why_ragged(style, row, width)
            raise InputError(path, f"line {line}", f"{len(row)} values", f"every row has {width} values", cure)
        cells.append(row)
        lines.append(line)
        if len(cells) == ROWS_PER_PIECE:
            yield TextRows(path, names, np.arange(done, done + len(cells)) + 1, np.array(lines), cells, style)
            done, cells, lines = done + len(cells), [], []
    if cells:
        yield TextRows(path, names, np.arange(done, done + len(cells)) + 1, np.array(lines), cells, style)
    elif done == 0:
        raise InputError(path, "", "nothing", "at least one row of values is needed", "Is the file empty?")


def _why_ragged(style: TextFormat, row: list[str], width: int) -> str:
    if row[0].lstrip()[:1] in REMARKS:
        return f"If this is a remark, declare `comment: {row[0].lstrip()[0]!r}`."
    if len(row) == 1 and any(sign in row[0] for sign in ",;\t| "):
        return f"Is its delimiter really {style.delimiter!r}?"
    if len(row) == width + 1 and not row[-1].strip():
        return "It ends with a delimiter: end the header with one as well, or count columns (`header: false`)."
    if style.delimiter == "," and len(row) > width:
        return "A decimal comma splits a number in two where the delimiter is a comma as well."
    return "Was the file cut off while it was written, or is a quotation mark never closed?"


def read_matrix(path: Path, style: MatlabFormat) -> MatrixRows:
    """A matrix of a MATLAB file.

    Raises:
        InputError: no such file or variable, several to choose from, or not a real matrix.
    """
    try:
        content = scipy.io.loadmat(path)
    except NotImplementedError as error:  # what scipy says of version 7.3, which is HDF5
        cure = "Save it with -v7 in MATLAB."
        raise InputError(path, "", "a MATLAB 7.3 file", "MATLAB files up to version 7.2 are read", cure) from error
    except (OSError, ValueError, TypeError, KeyError, IndexError, MatReadError) as error:
        found = f"no readable matrix ({error})"
        cure = "If it is text, leave `kind: matlab` out of the format."
        raise InputError(path, "", found, "this must be a MATLAB file", cure) from error
    variables = {name: value for name, value in content.items() if not name.startswith("__")}
    name = style.variable
    if name is None:
        if len(variables) != 1:
            cure = "Name one as `variable`: " + ", ".join(sorted(variables)) + "."
            raise InputError(path, "format.variable", f"{len(variables)} variables", "one must be chosen", cure)
        name = next(iter(variables))
    if name not in variables:
        raise InputError(path, "format.variable", name, "no variable of this name", nearest(name, variables))
    values = variables[name]
    if not isinstance(values, np.ndarray) or values.ndim != 2 or values.dtype.kind not in "fiu" or not values.size:
        kind = type(values).__name__ if not isinstance(values, np.ndarray) else f"{values.shape} {values.dtype}"
        raise InputError(path, name, kind, "a variable that is imported is a matrix of real numbers")
    return MatrixRows(path, np.arange(1, len(values) + 1), values.astype(float))
