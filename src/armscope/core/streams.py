"""Outputs that are no files to be replaced: standard output, devices, pipes."""

from __future__ import annotations

import contextlib
import os
import shutil
import stat
import sys
from pathlib import Path
from typing import TextIO


def is_stream(path: Path | str) -> bool:
    """Whether an output is no file to be replaced, but something to write into: "-", a device, a pipe."""
    text = os.path.abspath(path)
    if str(path) == "-" or text in ("/dev/stdout", "/dev/stderr") or text.startswith(("/dev/fd/", "/proc/")):
        return True
    with contextlib.suppress(OSError):
        mode = os.stat(path).st_mode
        return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))
    return False


def copy_into(source: Path, path: Path | str, stdout: TextIO) -> None:
    """Write a file's content into a device, a pipe or standard output ("-").

    Args:
        source: the file.
        path: what to write into.
        stdout: what standard output is.
    """
    standard = {"-": "stdout", "/dev/stdout": "stdout", "/dev/stderr": "stderr"}.get(str(path))
    with source.open("rb") as content:
        if standard is None:
            with open(path, "ab") as stream:  # what a shell has redirected to may hold something already
                shutil.copyfileobj(content, stream)
            return
        out = stdout if standard == "stdout" else sys.stderr
        out.flush()
        shutil.copyfileobj(content, out.buffer)
        out.flush()
