"""Sheets of Excel workbooks as rows of words, as text tables have them."""

from __future__ import annotations

import gzip
import io
import zipfile
from collections.abc import Iterator
from datetime import date, datetime, time
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import ParseError

from armscope.core.inputs import InputError, nearest
from armscope.core.streams import at_hand
from armscope.recordings.constants import PIECES
from armscope.recordings.opening import GZIP

ZIP = b"PK\x03\x04"


def is_workbook(start: bytes) -> bool:
    """Whether a file that begins so may be one."""
    return start.startswith(ZIP)


def sheets_of(path: Path) -> list[str]:
    """Names of a workbook's sheets that hold cells, charts left out. Raises InputError: it is no workbook, or too
    large a one."""
    return [sheet.title for sheet in _opened(path).worksheets]


def sheet_rows(path: Path, name: str | None, decimal: str) -> Iterator[tuple[int, list[str]]]:
    """Rows of a sheet by their number, their cells as words; rows at the end that hold nothing are left out.

    Args:
        path: the workbook.
        name: of the sheet; None for the first one.
        decimal: sign that numbers are written with.

    Yields:
        The number of a row, from 1, and its cells, none beyond the last column that holds anything.

    Raises:
        InputError: it is no workbook, has no such sheet, or the sheet holds nothing.
    """
    book = _opened(path)
    names = [sheet.title for sheet in book.worksheets]
    if not names or (name is not None and name not in names):
        cure = nearest(name or "", names) if names else "Save the sheet as CSV."
        raise InputError(path, "format.sheet", name or "no sheet", "the workbook has no sheet of this name", cure)
    sheet = book[name or names[0]]
    sheet.reset_dimensions()  # what some programs write there is not the sheet's size
    found = [
        (number, [_word(cell, decimal) for cell in row])
        for number, row in enumerate(sheet.iter_rows(values_only=True), start=1)
    ]
    width = max((at + 1 for _, row in found for at, word in enumerate(row) if word), default=0)
    if not width:
        rule, cure = "a sheet with rows of values is needed", "Name another one as `sheet`: " + ", ".join(names) + "."
        raise InputError(path, f"sheet {sheet.title}", "nothing", rule, cure)
    while not any(found[-1][1]):
        found.pop()
    for number, row in found:
        yield number, (row + [""] * width)[:width]


def _word(cell: object, decimal: str) -> str:
    """A cell as text tables have it: dates and times as ISO 8601 writes them with a blank, numbers in full."""
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.15g}".replace(".", decimal)
    if isinstance(cell, datetime):
        return cell.isoformat(" ")
    return cell.isoformat() if isinstance(cell, date | time) else str(cell).strip()


def _opened(path: Path) -> Any:
    import openpyxl

    content = at_hand(path).read_bytes()
    if content.startswith(GZIP):
        content = gzip.decompress(content)
    cure = "Save the sheet as CSV."
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as packed:
            size = sum(part.file_size for part in packed.infolist())
            if "EncryptedPackage" in packed.namelist():
                raise InputError(path, "", "a workbook with a password", "only open ones are read", cure)
        if size > PIECES.unpacked * len(content):
            found = f"{size} bytes packed into {len(content)}"
            raise InputError(path, "", found, "a workbook is needed here", "No table packs so well. " + cure)
        return openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    except (zipfile.BadZipFile, KeyError, ValueError, OSError, EOFError, ParseError) as error:
        if isinstance(error, InputError):
            raise
        found = "a zip archive that is no readable Excel workbook"
        raise InputError(path, "", found, "an Excel workbook (.xlsx) is read", cure) from error
