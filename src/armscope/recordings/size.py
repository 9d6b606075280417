"""How long a table is, guessed from its first lines before it is read."""

from __future__ import annotations

from pathlib import Path

from armscope.recordings.opening import GZIP, open_text

LOOKED_AT = 1 << 16
"""Characters from which the length of a line is taken."""


def estimated_rows(path: Path) -> int:
    """About how many rows a table (CSV, gzipped or not) has; 0 where nothing can be read, which its reader will say."""
    try:
        with path.open("rb") as stream:
            packed = stream.read(len(GZIP)) == GZIP
            stream.seek(-4 if packed else 0, 2)
            size = int.from_bytes(stream.read(4), "little") if packed else stream.tell()
        with open_text(path, "utf-8") as text:
            start = text.read(LOOKED_AT)
    except (OSError, EOFError, ValueError):
        return 0
    lines = start.count("\n")
    return round(size * lines / len(start)) if lines else 0
