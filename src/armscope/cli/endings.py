"""How the command line ends: one clear line for whatever goes wrong, and an exit code that says which kind it was."""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TextIO

from armscope.core.inputs import InputError, spelt_out
from armscope.core.locks import Busy
from armscope.core.outputs import OF_THE_DISK

if TYPE_CHECKING:
    from armscope.verdict.schema import Answer

UNUSABLE = 2  # An input or an option can't be used
MISMATCH = 10  # `diagnose --exit-code` found that something is missing from the simulation
NO_MEMORY = 71  # Memory ran out (EX_OSERR of sysexits.h)
NO_WRITING = 74  # A file could not be read or written: a full disk, say (EX_IOERR)
BUSY = 75  # Another process writes to the same place; try again later (EX_TEMPFAIL)
INTERRUPTED = 130  # Ctrl-C (128 + SIGINT)
CLOSED = 141  # Nobody reads standard output any more (128 + SIGPIPE)


def exit_code_of(answer: Answer) -> int:
    """What `diagnose --exit-code` ends with: the answer alone decides, of points and of motions."""
    return {"nothing missing": 0, "cannot tell": UNUSABLE}.get(answer, MISMATCH)


LEAST_ADDRESSES = 500 * 2**20  # Bytes of addresses that a process must be allowed: what interpreter and libraries take
LEAST_DATA = 200 * 2**20  # As many of data
BLAS_BUFFERS = 80 * 2**20
"""Bytes that the BLAS of NumPy and that of SciPy take when they are first used: 32 MiB each, and their surroundings."""


def _take_what_blas_needs() -> None:
    """Where a process's memory is limited: BLAS takes its buffers before tables do.

    When it finds no room for them it tries for ever, without a word; what is wanted later is refused with one.
    """
    limits = (
        (resource.RLIMIT_AS, LEAST_ADDRESSES, "addresses (ulimit -v)"),
        (resource.RLIMIT_DATA, LEAST_DATA, "data (ulimit -d)"),
    )
    limited = [(resource.getrlimit(kind)[0], least, of) for kind, least, of in limits]
    limited = [each for each in limited if each[0] >= 0]
    for allowed, least, of in limited:
        if allowed < least:
            raise MemoryError(f"This process is allowed {allowed // 2**20} MB of {of}; {least // 2**20} are the least")
    if limited:
        import numpy as np
        from scipy.linalg.blas import dgemm

        np.empty(BLAS_BUFFERS, np.uint8)  # a MemoryError where there is no room
        some = np.ones((64, 64))
        dgemm(1.0, some @ some, some)


@contextlib.contextmanager
def endings() -> Iterator[None]:
    """Around a whole command line."""
    patient = sys.stdout = _Patient(sys.stdout)
    try:
        try:
            _take_what_blas_needs()
            yield
        finally:
            patient.flush()
            if patient.closed_early:
                raise BrokenPipeError
    except InputError as error:
        _end(str(error), UNUSABLE)
    except Busy as error:
        _end(str(error), BUSY)
    except KeyboardInterrupt:
        _end("interrupted; nothing was left half-written", INTERRUPTED)
    except MemoryError as error:
        _end(f"out of memory; nothing was written. {error}".rstrip(". ") + ".", NO_MEMORY)
    except BrokenPipeError:
        _silence_stdout()
        _end("nobody reads standard output any more", CLOSED)
    except OSError as error:
        if error.errno in OF_THE_DISK:
            _silence_stdout()
        where = f"{error.filename}: " if error.filename is not None else ""
        _end(f"{where}{error.strerror or error}; nothing was written", NO_WRITING)


@contextlib.contextmanager
def plain_words() -> Iterator[None]:
    """While a command speaks: names of users' files and in them are shown, and steer no terminal.

    Tables that go to standard output are written past it, as they are.
    """
    with contextlib.redirect_stdout(_Plain(sys.stdout)), contextlib.redirect_stderr(_Plain(sys.stderr)):
        yield


class _Plain:
    """A stream of words in which characters that steer a terminal are spelt out."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        self._stream.write(spelt_out(text))
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


class _Patient:
    """Standard output that takes words even when nobody reads them any more: the command's files matter more."""

    def __init__(self, stream: TextIO) -> None:
        self._stream, self.closed_early = stream, False

    def write(self, text: str) -> int:
        self._try(lambda: self._stream.write(text))
        return len(text)

    def flush(self) -> None:
        self._try(self._stream.flush)

    def _try(self, action: Callable[[], object]) -> None:
        try:
            action()
        except BrokenPipeError:
            self.closed_early = True
            _silence_stdout()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextlib.contextmanager
def told_to_end() -> Iterator[None]:
    """A request to end, by a workflow engine or by Ctrl-C, unwinds the command, which leaves nothing half-written."""
    main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number)) if main else None
    try:
        yield
    except KeyboardInterrupt:  # typer would end with the exit code of a finding
        _end("interrupted; nothing was left half-written", INTERRUPTED)
    finally:
        if main:
            signal.signal(signal.SIGTERM, before)


def _end(text: str, code: int) -> None:
    with contextlib.suppress(OSError):
        print(f"armscope: {spelt_out(text)}", file=sys.stderr, flush=True)
    sys.exit(code)


def _silence_stdout() -> None:
    """What standard output still holds can't be written: the interpreter must not try again at its end."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
