"""Files opened by what is in them, whatever they are called: gzip or plain text, and what can be neither."""

from __future__ import annotations

import codecs
import gzip
import os
import zlib
from pathlib import Path
from typing import IO, cast

from armscope.core.inputs import InputError, note_read, unreadable, why_unreadable
from armscope.core.streams import at_hand
from armscope.recordings.constants import PIECES

GZIP = b"\x1f\x8b"
SHEET = "Save the sheet as CSV; or `armscope init` it: mappings read workbooks (`format: {kind: workbook}`)."
OTHER_THAN_TEXT: tuple[tuple[bytes, str, str], ...] = (
    (b"PK\x03\x04", "a zip archive, such as an Excel workbook", SHEET),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook, or one with a password", "Save the sheet as CSV."),
    (b"MATLAB 5.0", "a MATLAB file", "`armscope import` reads it with `format: {kind: matlab}`."),
    (b"MATLAB 7.3", "a MATLAB 7.3 file", "Save it with -v7 in MATLAB; `armscope import` reads that."),
    (b"\x89HDF", "an HDF5 file", "Save the numbers as text where the file comes from."),
)
PICKLES = (b"\x80\x02", b"\x80\x03", b"\x80\x04", b"\x80\x05", b"\x93NUMPY")
PICKLE_SUFFIXES = {".pickle", ".pkl", ".joblib", ".npy", ".npz", ".pt"}
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def start_of(path: Path, what: str) -> bytes:
    """The first bytes of a file, unpacked where it is gzipped; ``what`` it is, for the error. Raises InputError: no
    readable file."""
    note_read(path)
    try:
        with at_hand(path).open("rb") as stream:
            start = stream.read(PIECES.signature)
        if start.startswith(GZIP):
            _refuse_bombs(path, what)
            with gzip.open(at_hand(path)) as packed:
                start = packed.read(PIECES.signature)
    except IsADirectoryError as error:
        found, cure = unreadable(path, error, (".csv", ".csv.gz"))
        raise InputError(path, "", found, f"{what} is needed here", cure) from error
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(path, "", "no readable file", f"{what} is needed here", why_unreadable(error)) from error
    return start


def _unpacks_to_more(path: Path, size: int) -> bool:
    """Whether a gzipped file holds more bytes than ``size``; nothing of it is kept."""
    count = 0
    with gzip.open(at_hand(path)) as stream:
        while count <= size and (piece := stream.read(PIECES.unpacked_at_once)):
            count += len(piece)
    return count > size


def _refuse_bombs(path: Path, what: str) -> None:
    """A few bytes that would swell into all memory; of a file that was cut off, only what it holds counts."""
    packed = at_hand(path).stat().st_size
    most = PIECES.unpacked * packed
    with at_hand(path).open("rb") as stream:
        stream.seek(-min(4, packed), os.SEEK_END)
        unpacked = int.from_bytes(stream.read(4), "little")
    if unpacked > most and _unpacks_to_more(path, most):
        found = f"{unpacked} bytes packed into {packed}"
        cure = "No table packs so well; if this one does, unpack it first."
        raise InputError(path, "", found, f"{what} is needed here", cure)


def refuse_pickles(path: Path, start: bytes) -> None:
    """Python object files are never loaded. Raises InputError: this is one, by its suffix or its first bytes."""
    if path.suffix.lower() in PICKLE_SUFFIXES or start.startswith(PICKLES):
        raise InputError(
            path,
            "",
            "a Python object file",
            "pickles and their kin are never loaded, since loading one may run any code",
            "Save the numbers as text or as a MATLAB matrix where the file comes from.",
        )


def refuse_other_than_text(path: Path, start: bytes, encoding: str, cure_utf_16: str) -> None:
    """Name a file that can't be delimited text by what it is.

    Args:
        path: the file.
        start: its first bytes.
        encoding: as declared.
        cure_utf_16: what to do about UTF-16.

    Raises:
        InputError: an archive, a workbook, a MATLAB or HDF5 file, or UTF-16 text where another encoding was declared.
    """
    refuse_pickles(path, start)
    for signature, what, cure in OTHER_THAN_TEXT:
        if start.startswith(signature):
            raise InputError(path, "", what, "delimited text is needed here", cure)
    if start.startswith(UTF_16) and not encoding.lower().replace("_", "-").startswith(("utf-16", "utf16")):
        raise InputError(path, "", "UTF-16 text", f"the text is declared as {encoding}", cure_utf_16)


def open_text(path: Path, encoding: str) -> IO[str]:
    """A text file, unpacked where its content is gzipped; a byte-order mark is no part of UTF-8 text."""
    if codecs.lookup(encoding).name == "utf-8":
        encoding = "utf-8-sig"
    path = at_hand(path)
    with path.open("rb") as stream:
        packed = stream.read(len(GZIP)) == GZIP
    opener = gzip.open if packed else open
    return cast(IO[str], opener(path, "rt", encoding=encoding, newline=""))


def undecodable(path: Path, encoding: str, error: UnicodeError) -> tuple[str, str]:
    """Where a file is not text in ``encoding``, and what stands there: ("line 3", "byte 0xb0 in '20 ...'").

    Args:
        path: the file.
        encoding: as declared.
        error: what Python says of it.

    Returns:
        Place and content.
    """
    path = at_hand(path)
    with path.open("rb") as stream:
        packed = stream.read(len(GZIP)) == GZIP
    with gzip.open(path) if packed else path.open("rb") as lines:
        for number, line in enumerate(lines, start=1):
            try:
                line.decode(encoding)
            except UnicodeDecodeError as here:
                before = line[max(0, here.start - PIECES.before_a_byte) : here.start].decode(encoding, "replace")
                return f"line {number}", f"byte 0x{line[here.start]:02x} after {before!r}"
    return "", str(error)
