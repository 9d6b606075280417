"""A comma-separated file as a table of cells: equally long rows under a header whose names differ."""

from __future__ import annotations

import codecs
import csv
import io
import zlib
from collections.abc import Callable
from itertools import islice, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from armscope.core.inputs import InputError, why_unreadable
from armscope.core.parallel import each_piece
from armscope.core.plainyaml import CONTROL
from armscope.core.streams import at_hand, pipes_kept
from armscope.recordings.constants import PIECES
from armscope.recordings.opening import GZIP, open_text, refuse_other_than_text, start_of, undecodable
from armscope.recordings.other_formats import what_it_is

if TYPE_CHECKING:
    import pandas as pd  # slow to import

WORDS = ("id", "run", "target")  # Columns that are words, even where they look like numbers or like a name for no value


Piece = tuple[int, int]  # Where whole lines of a file start and end, bytes

NO_VALUE = ("", "NaN", "nan", "NA", "N/A", "n/a", "#N/A", "null", "NULL", "None", "-nan", "-NaN", "<NA>")
"""What stands for no value in a column of numbers."""


def read_text_table(path: Path, check: Callable[[list[str]], object] = lambda header: None) -> pd.DataFrame:
    """A CSV file (gzipped or not) with a header and equally long rows; id, run and target stay text. ``check``:
    refuses a header that can't be used, before the rest is read. Raises InputError: it is no such table."""
    with pipes_kept():
        return _table(path, check)


def _table(path: Path, check: Callable[[list[str]], object]) -> pd.DataFrame:
    refuse_other_than_text(path, start_of(path, "a recordings table (CSV)"), "utf-8", "Save it as UTF-8.")
    header, counts, pieces = _shape(path)
    if not header:
        raise InputError(path, "line 1", "nothing", "the first line names the columns", "Is the file empty?")
    _check_header(path, header)
    _check_lengths(path, header, counts)
    check(header)
    try:
        table = _read(path, header, pieces)
    except (ValueError, OverflowError) as error:  # pandas' words for it
        if "out of memory" in str(error):
            raise MemoryError("The table needs more") from error
        cure = "Was the file cut off while it was written, or is a quotation mark never closed?"
        raise InputError(path, "", str(error), "this must be a comma-separated table", cure) from error
    if table.empty:
        raise InputError(path, "line 2", "nothing", "at least one measured row is needed")
    _check_words(path, table)
    return table


def _read(path: Path, header: list[str], pieces: list[Piece]) -> pd.DataFrame:
    """A table whose rows are as long as its header; in pieces, since text takes several times the memory of numbers."""
    import pandas as pd

    how: dict[str, Any] = {
        "index_col": False,
        "skip_blank_lines": False,
        "dtype": {name: str for name in header if _is_word(name)},
        "keep_default_na": False,
        "na_values": {name: list(NO_VALUE) for name in header if not _is_word(name)},
        "low_memory": False,
    }

    def read_piece(piece: Piece) -> pd.DataFrame:
        named = {} if piece[0] == 0 else {"header": None, "names": names}
        table: pd.DataFrame = pd.read_csv(io.BytesIO(_lines(path, piece)), **how, **named)
        return table

    if pieces:
        names = pd.read_csv(io.StringIO(",".join(header)), **how).columns  # one without a name gets one
        return pd.concat(each_piece(pieces, read_piece), ignore_index=True)
    with open_text(path, "utf-8") as stream:
        return pd.concat(pd.read_csv(stream, chunksize=PIECES.rows, **how), ignore_index=True)


def cell_as_written(source: Path | str, row: int, column: int) -> str:
    """What stands in a cell whose word was taken for no value: "NaN", "n/a"; or "" where it is empty.

    Args:
        source: the file; a table that was read from none has no such word.
        row: of the table, from 0.
        column: from 0.

    Returns:
        The word, without blanks around it.
    """
    if not isinstance(source, Path):
        return ""
    try:
        with open_text(source, "utf-8") as stream:
            cells = next(islice(csv.reader(stream), row + 1, None), [])
    except (OSError, EOFError, UnicodeDecodeError, csv.Error, zlib.error):
        return ""
    return cells[column].strip() if column < len(cells) else ""


def _is_word(header: str) -> bool:
    return header.strip().lower() in WORDS


def _check_words(path: Path, table: pd.DataFrame) -> None:
    """Names are shown on terminals and pages: none of their characters may be a command."""
    for name in filter(_is_word, table.columns):
        words = table[name].fillna("").tolist()
        if CONTROL.search(" ".join(words)):
            row, word = next((row, word) for row, word in enumerate(words) if CONTROL.search(word))
            raise InputError(path, f"line {row + 2}, column {name}", word, "a name has no control characters")


def _shape(path: Path) -> tuple[list[str] | None, list[int], list[Piece]]:
    """The header, how many values each row has, and the pieces that it can be read in, where there are such."""
    rows = None
    try:
        pieces = _pieces(path)
        counts = each_piece(pieces, lambda piece: _values_of_lines(path, piece))
        plain = [count for piece in counts if piece is not None for count in piece]
        if pieces and None not in counts:
            with open_text(path, "utf-8") as stream:
                line = stream.readline().rstrip("\n")
            return line.split(",") if line else [], plain[1:], pieces
        with open_text(path, "utf-8") as stream:
            rows = csv.reader(stream)
            return next(rows, None), [len(row) for row in rows], []
    except UnicodeDecodeError as error:
        place, found = undecodable(path, "utf-8", error)
        raise InputError(path, place, found, "tables are UTF-8 text", "Save it as UTF-8.") from error
    except (OSError, EOFError, zlib.error) as error:
        rule = "a recordings table (CSV) is needed here"
        raise InputError(path, "", "no readable file", rule, why_unreadable(error)) from error
    except csv.Error as error:
        place = f"line {rows.line_num}" if rows else ""
        cure = "Is there a quotation mark that is never closed?"
        raise InputError(path, place, str(error), "this must be a comma-separated table", cure) from error


def _pieces(path: Path) -> list[Piece]:
    """A file in pieces of whole lines; none of a gzipped one, which can only be read from its start."""
    path = at_hand(path)
    size, ends = path.stat().st_size, [0]
    with path.open("rb") as stream:
        if stream.read(len(GZIP)) == GZIP:
            return []
        while ends[-1] < size:
            stream.seek(ends[-1] + PIECES.size - 1)
            stream.readline()
            ends.append(min(stream.tell(), size))
    return list(pairwise(ends))


def _lines(path: Path, piece: Piece) -> bytes:
    with at_hand(path).open("rb") as stream:
        stream.seek(piece[0])
        lines = stream.read(piece[1] - piece[0])
    return lines.removeprefix(codecs.BOM_UTF8) if piece[0] == 0 else lines


def _values_of_lines(path: Path, piece: Piece) -> list[int] | None:
    """How many values the lines of a piece have, in a third of csv's time.

    Args:
        path: of the table.
        piece: of it.

    Returns:
        What the csv module says, the header's among them; None where that has to be asked: quotation marks, other ends
        of lines than \\n, lines longer than it takes.
    """
    text = _lines(path, piece)
    if not text.isascii():
        text.decode("utf-8")  # what can't be is told by who asked
    if b'"' in text or b"\r" in text:
        return None
    lines = text.removesuffix(b"\n").split(b"\n")
    if max(map(len, lines)) >= csv.field_size_limit():
        return None
    return [line.count(b",") + 1 if line else 0 for line in lines]


def _check_lengths(path: Path, header: list[str], counts: list[int]) -> None:
    for row, count in enumerate(counts, start=2):
        if count != len(header):
            raise InputError(
                path,
                f"line {row}",
                f"{count} values" if count else "nothing",
                f"every row has the {len(header)} values that line 1 names",
                _why_ragged(count, len(header)),
            )


def _why_ragged(count: int, width: int) -> str:
    if width == 1:
        return "A table's first line names several columns. Is this the right file?"
    if count > width:
        return "A decimal comma splits a number in two: use points."
    if count == 0:
        return "Remove the blank line."
    if count == 1:
        return (
            "Are its values parted by semicolons or tabs, and those of line 1 by commas? Or was the file cut off here?"
        )
    return "Was the file cut off while it was written, or is a quotation mark never closed?"


def _check_header(path: Path, header: list[str]) -> None:
    if other := what_it_is(header, str(path)):
        raise InputError(path, "line 1", *other)
    if len(header) > PIECES.columns:
        raise InputError(path, "line 1", f"{len(header)} columns", f"a table has at most {PIECES.columns} columns")
    if header[0].startswith("sep="):
        rule = "the first line names the columns"
        raise InputError(path, "line 1", ",".join(header), rule, "Remove this line, which only spreadsheets read.")
    seen: set[str] = set()
    for name in header:
        if CONTROL.search(name):
            raise InputError(path, "line 1", name, "a column's name has no control characters")
        if name in seen:
            raise InputError(
                path, "line 1", name, "column names must differ, this one stands twice", "Rename one of them."
            )
        seen.add(name)
