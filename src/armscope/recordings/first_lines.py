"""What a table is by its first lines, before it is read: how long, and whether of an arm in motion."""

from __future__ import annotations

import csv
import re
import zlib
from collections.abc import Sequence
from pathlib import Path

from armscope.core.streams import at_hand
from armscope.recordings.constants import PIECES
from armscope.recordings.opening import GZIP, open_text

DRIVE_COLUMN = r"tau[1-9]\d*_nm|f[1-9]\d*_n|current[1-9]\d*_a"


def estimated_rows(path: Path) -> int:
    """About how many rows a table (CSV, gzipped or not) has; 0 where nothing can be read, which its reader will say."""
    try:
        with at_hand(path).open("rb") as stream:
            packed = stream.read(len(GZIP)) == GZIP
            stream.seek(-4 if packed else 0, 2)
            size = int.from_bytes(stream.read(4), "little") if packed else stream.tell()
        with open_text(path, "utf-8") as text:
            start = text.read(PIECES.length_from)
    except (OSError, EOFError, ValueError, zlib.error):
        return 0
    lines = start.count("\n")
    return round(size * lines / len(start)) if lines else 0


def is_motion_table(path: Path | str) -> bool:
    """Whether a table is of an arm in motion: its columns are torques or currents, and no measured points."""
    try:
        with open_text(Path(path), "utf-8") as stream:
            names = next(csv.reader(stream), [])
    except (OSError, EOFError, UnicodeDecodeError, csv.Error, zlib.error):
        return False  # whoever reads the table says what is wrong with it
    return is_motion(names)


def is_motion(names: Sequence[str]) -> bool:
    """Whether columns of these names are of an arm in motion."""
    drives = any(re.fullmatch(DRIVE_COLUMN, name) for name in names)
    return drives and not {"x_mm", "x_m"} & set(names)
