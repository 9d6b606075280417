"""What is no file: outputs that are written into (standard output, devices, pipes), inputs that are read once."""

from __future__ import annotations

import contextlib
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import TextIO

_COPIES: ContextVar[tuple[contextlib.ExitStack, dict[str, Path]] | None] = ContextVar("copies of pipes", default=None)
"""Copies by what they are of, and what removes them."""
STANDARD_INPUT = ("-", "/dev/stdin")


@contextlib.contextmanager
def pipes_kept() -> Iterator[None]:
    """Within the block a pipe is read once, whoever asks for it how often: see `at_hand`."""
    if _COPIES.get() is not None:
        yield
        return
    with contextlib.ExitStack() as removing:
        before = _COPIES.set((removing, {}))
        try:
            yield
        finally:
            _COPIES.reset(before)


def at_hand(path: Path | str) -> Path:
    """Where an input can be read from its start as often as one likes: a copy of a pipe, or of standard input ("-").
    Raises OSError: it can't be read."""
    path, kept = Path(path), _COPIES.get()
    if kept is None or not _is_read_once(path):
        return path
    removing, copies = kept
    name = "-" if str(path) in STANDARD_INPUT else str(path)
    if name not in copies:
        made = Path(removing.enter_context(tempfile.TemporaryDirectory(prefix="armscope-"))) / "copy"
        with made.open("wb") as copy:
            if name == "-":
                shutil.copyfileobj(sys.stdin.buffer, copy)
            else:
                with path.open("rb") as stream:
                    shutil.copyfileobj(stream, copy)
        copies[name] = made
    return copies[name]


def _is_read_once(path: Path) -> bool:
    """Whether it is standard input by its own sign, or a pipe: not devices, some of which never end."""
    if str(path) == "-":
        return True
    with contextlib.suppress(OSError, ValueError):
        mode = os.stat(path).st_mode
        return stat.S_ISFIFO(mode) or stat.S_ISSOCK(mode)
    return False


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
