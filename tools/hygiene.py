"""Ends of lines and files: no blanks before a line's end, one line end before a file's, no mark of an unfinished merge.

python -m tools.hygiene FILE ...   # mends what it can, and fails where there was something to mend
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

MERGE_MARKS = ("<<<<<<< ", ">>>>>>> ")


def mended(text: str) -> str:
    """The text with clean ends; an empty file stays empty."""
    lines = [line.rstrip(" \t\r") for line in text.split("\n")]
    return "\n".join(lines).rstrip("\n") + "\n" if text.strip() else ""


def unfinished(text: str) -> bool:
    """Whether a merge left its marks."""
    return any(line.startswith(MERGE_MARKS) for line in text.split("\n"))


def mend(paths: Iterable[Path]) -> list[str]:
    """What was wrong, one line per file."""
    wrong = []
    for path in paths:
        text = path.read_bytes().decode("utf-8")
        if unfinished(text):
            wrong.append(f"{path}: an unfinished merge")
        if mended(text) != text:
            path.write_bytes(mended(text).encode("utf-8"))
            wrong.append(f"{path}: ends of lines or of the file, mended")
    return wrong


if __name__ == "__main__":
    found = mend(map(Path, sys.argv[1:]))
    print("\n".join(found))
    sys.exit(bool(found))
