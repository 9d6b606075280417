"""Raw files as rows of columns, a piece at a time: delimited text and MATLAB matrices. Never a pickle."""

from __future__ import annotations

import csv
import zlib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import numpy as np
import scipy.io
from scipy.io.matlab import MatReadError

from armscope.core.inputs import InputError, nearest, why_unreadable
from armscope.core.streams import at_hand
from armscope.recordings.importing.constants import LIMITS
from armscope.recordings.importing.formats import CellsFormat, Format, MatlabFormat, TextFormat, WorkbookFormat
from armscope.recordings.importing.rawrows import MatrixRows, RawRows, TextRows
from armscope.recordings.importing.workbooks import is_workbook, sheet_rows
from armscope.recordings.opening import open_text, refuse_other_than_text, refuse_pickles, start_of, undecodable

REMARKS = "#%!/"
DELIMITERS = {"tab": "\t"}


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
    if isinstance(style, WorkbookFormat):
        if not is_workbook(start):
            refuse_other_than_text(path, start, "utf-8", "Declare `encoding: utf-16` in the mapping's format.")
            cure = "If it is text, leave `kind: workbook` out of the format."
            raise InputError(path, "", "no Excel workbook", "a sheet of one is needed here", cure)
        rows = (row for row in sheet_rows(path, style.sheet, style.decimal) if row[0] > style.skip_lines)
        yield from _gather(path, style, _kept(rows, style), notes)
        return
    refuse_other_than_text(path, start, style.encoding, "Declare `encoding: utf-16` in the mapping's format.")
    yield from _read_text(path, style, notes)


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
        rule = "this must be delimited text, plain or gzipped"
        raise InputError(path, "", "no readable file", rule, why_unreadable(error)) from error


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
    for number, row in _kept(numbered, style):
        if style.values_per_row is None:
            yield number, row
            continue
        held += row
        if len(held) >= style.values_per_row:
            yield number, held
            held = []
    if held:
        yield number, held


def _kept(rows: Iterator[tuple[int, list[str]]], style: CellsFormat) -> Iterator[tuple[int, list[str]]]:
    """Rows up to the last line, without comments."""
    for number, row in rows:
        if style.last_line is not None and number > style.last_line:
            return
        if style.comment is None or not row or not row[0].startswith(style.comment):
            yield number, row


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
    path: Path, style: CellsFormat, rows: Iterator[tuple[int, list[str]]], notes: Counter[str]
) -> Iterator[TextRows]:
    names: tuple[str, ...] = ()
    width = None
    if style.header:
        first = next(rows, None)
        if first is None:
            raise InputError(path, "line 1", "nothing", "the first line names the columns", "Is the file empty?")
        names = tuple(name.strip() for name in first[1])
        width = len(names)
        for _ in range(style.below_header):
            next(rows, None)
    cells: list[list[str]] = []
    lines: list[int] = []
    done = 0
    for line, row in rows:
        if not any(word.strip() for word in row):
            notes["blank lines passed over"] += 1
            continue
        width = width or len(row)
        if len(row) != width:
            cure = _why_ragged(style, row, width) if isinstance(style, TextFormat) else ""
            raise InputError(path, f"line {line}", f"{len(row)} values", f"every row has {width} values", cure)
        cells.append(row)
        lines.append(line)
        if len(cells) == LIMITS.rows:
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
    """A matrix of a MATLAB file. Raises InputError: no such file or variable, several to choose from, or not a real
    matrix."""
    try:
        content = scipy.io.loadmat(at_hand(path))
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
