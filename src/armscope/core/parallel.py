"""Work on pieces of a long table, shared among processes. What comes out does not depend on how many there are."""

from __future__ import annotations

import contextlib
import math
import mmap
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextvars import ContextVar
from typing import Any, TypeVar

import numpy as np

from armscope.core.types import Array

Piece = TypeVar("Piece")
Result = TypeVar("Result")

_PROCESSES: ContextVar[int] = ContextVar("processes", default=1)


@contextlib.contextmanager
def processes(count: int) -> Iterator[None]:
    """Within the block, `each_piece` shares its work among so many processes."""
    before = _PROCESSES.set(count)
    try:
        yield
    finally:
        _PROCESSES.reset(before)


def shared_array(shape: tuple[int, ...]) -> Array:
    """An array of zeros into which `each_piece` may write, a piece its own part: no process has to send it."""
    if _PROCESSES.get() < 2:
        return np.zeros(shape)
    return np.frombuffer(mmap.mmap(-1, math.prod(shape) * np.dtype(float).itemsize)).reshape(shape)


def each_piece(pieces: Sequence[Piece], work: Callable[[Piece], Result]) -> list[Result]:
    """What ``work`` makes of each piece, in the order of the pieces.

    Args:
        pieces: of the work; they must not depend on each other.
        work: done in a process of its own, which starts with all that this one knows; what it changes is
            lost, but what it writes into an array made by `shared_array`.

    Returns:
        One result per piece, the same for any number of processes.

    Raises:
        MemoryError: a process was ended from outside, as happens where memory runs out.
    """
    return list(piece_by_piece(pieces, work))


def piece_by_piece(pieces: Sequence[Piece], work: Callable[[Piece], Result]) -> Iterator[Result]:
    """As `each_piece`, each result as soon as those before it are taken: where all of them together are too large."""
    count = min(_PROCESSES.get(), len(pieces))
    if count < 2 or "fork" not in multiprocessing.get_all_start_methods():
        yield from map(work, pieces)
    else:
        yield from _forked(len(pieces), lambda number: work(pieces[number]), count)


def _forked(many: int, work: Callable[[int], Result], count: int) -> Iterator[Result]:
    """As `each_piece`: the first process takes every n-th piece, the second those that follow them, ..."""
    context = multiprocessing.get_context("fork")
    lines, workers = [], []
    for first in range(count):
        receiving, sending = context.Pipe(duplex=False)
        worker = context.Process(target=_run, args=(work, range(first, many, count), sending), daemon=True)
        worker.start()
        sending.close()
        lines.append(receiving)
        workers.append(worker)
    try:
        for number in range(many):
            yield _received(lines[number % count])
    finally:
        for worker in workers:
            worker.terminate()
            worker.join()


def _run(work: Callable[[int], Result], numbers: range, line: Any) -> None:
    _let_go(line.fileno())
    with contextlib.suppress(BrokenPipeError):  # nobody waits any more
        for number in numbers:
            try:
                result = work(number)
            except Exception as error:  # it is raised again where the result is waited for
                line.send((None, error))
                return
            line.send((result, None))


def _let_go(line: int) -> None:
    """A process that helps holds no file of its parent's, whose locks would outlive it, and leaves Ctrl-C to it."""
    os.closerange(3, line)
    os.closerange(line + 1, os.sysconf("SC_OPEN_MAX"))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _received(line: Any) -> Any:
    try:
        result, error = line.recv()
    except EOFError as closed:
        raise MemoryError("a process that shared the work was ended from outside") from closed
    if error is not None:
        raise error
    return result
