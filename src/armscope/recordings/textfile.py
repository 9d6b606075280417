"""A comma-separated file as a table of cells: equally long rows under a header whose names differ."""

from __future__ import annotations

import csv
import re
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING

from armscope.core.inputs import InputError
from armscope.core.plainyaml import CONTROL
from armscope.recordings.opening import open_text, refuse_other_than_text, start_of, undecodable

if TYPE_CHECKING:
    import pandas as pd  # slow to import

WORDS = ("id", "run", "target")
"""Columns that are words, even where they look like numbers or like a name for no value."""

ROWS_PER_PIECE = 50_000
BLOCK = 1 << 20
"""Characters that are looked at together."""
MOST_COLUMNS = 2000

NO_VALUE = ("", "NaN", "nan", "NA", "N/A", "n/a", "#N/A", "null", "NULL", "None", "-nan", "-NaN", "<NA>")
"""What stands for no value in a column of numbers."""


def read_text_table(path: Path, check: Callable[[list[str]], object] = lambda header: None) -> pd.DataFrame:
    """A CSV file (gzipped or not) with a header and equally long rows; id, run and target stay text.

    Args:
        path: of the file.
        check: refuses a header that can't be used, before the rest is read.

    Raises:
        InputError: it is no such table.
    """
    refuse_other_than_text(path, start_of(path, "a recordings table (CSV)"), "utf-8", "Save it as UTF-8.")
    header, counts = _shape(path)
    if not header:
        raise InputError(path, "line 1", "nothing", "the first line names the columns", "Is the file empty?")
    _check_header(path, header)
    _check_lengths(path, header, counts)
    check(header)
    try:
        table = _read(path, header)
    except (ValueError, OverflowError) as error:  # pandas' words for it
        cure = "Was the file cut off while it was written, or is a quotation mark never closed?"
        raise InputError(path, "", str(error), "this must be a comma-separated table", cure) from error
    if table.empty:
        raise InputError(path, "row 2", "nothing", "at least one measured row is needed")
    _check_words(path, table)
    return table


def _read(path: Path, header: list[str]) -> pd.DataFrame:
    import pandas as pd

    with open_text(path, "utf-8") as stream:
        pieces = pd.read_csv(
            stream,
            chunksize=ROWS_PER_PIECE,
            index_col=False,
            skip_blank_lines=False,
            dtype={name: str for name in header if _is_word(name)},
            keep_default_na=False,
            na_values={name: list(NO_VALUE) for name in header if not _is_word(name)},
            low_memory=False,
        )
        return pd.concat(pieces, ignore_index=True)  # in pieces, since text takes several times the memory of numbers


def _is_word(header: str) -> bool:
    return header.strip().lower() in WORDS


def _check_words(path: Path, table: pd.DataFrame) -> None:
    """Names are shown on terminals and pages: none of their characters may be a command."""
    for name in filter(_is_word, table.columns):
        wrong = table[name].str.contains(CONTROL.pattern, na=False).to_numpy()
        if wrong.any():
            row = int(wrong.argmax())
            rule = "a name has no control characters"
            raise InputError(path, f"row {row + 2}, column {name}", table[name].iloc[row], rule)


def _shape(path: Path) -> tuple[list[str] | None, list[int]]:
    """The header, and how many values each row has."""
    rows = None
    try:
        with open_text(path, "utf-8") as stream:
            plain = plain_shape(stream)
        if plain is not None:
            return plain
        with open_text(path, "utf-8") as stream:
            rows = csv.reader(stream)
            return next(rows, None), [len(row) for row in rows]
    except UnicodeDecodeError as error:
        place, found = undecodable(path, "utf-8", error)
        raise InputError(path, place, found, "tables are UTF-8 text", "Save it as UTF-8.") from error
    except (OSError, EOFError, zlib.error) as error:
        cure = getattr(error, "strerror", None) or str(error)
        raise InputError(path, "", "no readable file", "a recordings table (CSV) is needed here", cure) from error
    except csv.Error as error:
        place = f"line {rows.line_num}" if rows else ""
        cure = "Is there a quotation mark that is never closed?"
        raise InputError(path, place, str(error), "this must be a comma-separated table", cure) from error


def plain_shape(stream: IO[str]) -> tuple[list[str], list[int]] | None:
    """The header of a table without quotation marks, and how many values each row has: a third of csv's time.

    Args:
        stream: the table.

    Returns:
        What the csv module says; None where that has to be asked: quotation marks, other ends of lines than \\n, lines
        longer than it takes, nothing at all.
    """
    header, rest = "", ""
    counts: list[int] = []
    while block := stream.read(BLOCK):
        if '"' in block or "\r" in block:
            return None
        *lines, rest = (rest + block).split("\n")
        if max(map(len, (*lines, rest))) >= csv.field_size_limit():
            return None
        header = header if counts or not lines else lines[0]
        counts += [line.count(",") + 1 if line else 0 for line in lines]
    if rest:
        header = header if counts else rest
        counts.append(rest.count(",") + 1)
    return (header.split(",") if header else [], counts[1:]) if counts else None


def _check_lengths(path: Path, header: list[str], counts: list[int]) -> None:
    for row, count in enumerate(counts, start=2):
        if count != len(header):
            raise InputError(
                path,
                f"row {row}",
                f"{count} values" if count else "nothing",
                f"every row has the {len(header)} values that line 1 names",
                _why_ragged(count, len(header)),
            )


def _why_ragged(count: int, width: int) -> str:
    if count > width:
        return "A decimal comma splits a number in two: use points."
    if count == 0:
        return "Remove the blank line."
    return "Was the file cut off while it was written, or is a quotation mark never closed?"


def _check_header(path: Path, header: list[str]) -> None:
    if len(header) == 1 and re.search(r"[;\t|]", header[0]):
        raise InputError(
            path,
            "line 1",
            header[0],
            "columns are separated by commas",
            f"`armscope init {path.name} -o mapping.yaml` drafts how to read it, `armscope import` converts it.",
        )
    if len(header) > MOST_COLUMNS:
        raise InputError(path, "line 1", f"{len(header)} columns", f"a table has at most {MOST_COLUMNS} columns")
    seen: set[str] = set()
    for name in header:
        if CONTROL.search(name):
            raise InputError(path, "line 1", name, "a column's name has no control characters")
        if name in seen:
            raise InputError(
                path, "line 1", name, "column names must differ, this one stands twice", "Rename one of them."
            )
        seen.add(name)
