"""Single commands: killed, interrupted, out of disk or memory, unread, and two at once."""

from __future__ import annotations

import contextlib
import resource
import shutil
import signal
import subprocess
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.campaign.trial import (
    ENVIRONMENT,
    Outcome,
    commands,
    contents,
    cpu_seconds_of_children,
    ended,
    leftovers,
    run,
)

Command = Callable[[Path], list[str]]
"""Made for an output folder."""
PAGE = 4096
"""Bytes that a file system gives out at a time."""


@dataclass(frozen=True)
class Reference:
    """What a command writes when nothing happens.

    Attributes:
        files: digests by name.
        pages: of disk that they take.
        cpu_s: CPU seconds to their end.
    """

    files: dict[str, str]
    pages: int
    cpu_s: float


def killed(
    home: Path, times: int, rng: np.random.Generator, sign: signal.Signals, only: Collection[str] = ()
) -> Iterator[Outcome]:
    """Every writing command ended at random moments: nothing half-written, and the same command gives the same bytes.

    Args:
        home: a folder for the trials.
        times: per command.
        rng: draws the moments.
        sign: SIGKILL, or SIGINT, which must end with 130.
        only: commands of these names; empty: all.
    """
    for name, command in commands(home).items():
        if only and name not in only:
            continue
        reference = _reference(home, name, command)
        broken = []
        for number in range(times):
            out = home / name / f"{sign.name}-{number}"
            out.mkdir(parents=True)
            code, said = ended(command(out), float(rng.uniform(0, reference.cpu_s)), sign)
            left = contents(out)
            if left and left != reference.files:
                broken.append(f"{name}: half-written {sorted(left)}")
            elif sign is signal.SIGINT and code not in (0, 130, -2):  # -2: before Python's own start has ended
                broken.append(f"{name}: ended with {code}: {said[-200:]}")
            elif (again := run(command(out))).returncode or contents(out) != reference.files or leftovers(out):
                broken.append(
                    f"{name}: the same command again: {again.returncode} {again.stderr[-200:]} {leftovers(out)}"
                )
            shutil.rmtree(out, ignore_errors=True)
        what = "kill -9" if sign is signal.SIGKILL else "Ctrl-C"
        yield Outcome(
            "nothing half-written; the same command then gives the same bytes, and leaves nothing behind",
            f"`{name}`, {what} at random moments",
            times,
            tuple(broken),
        )


def _reference(home: Path, name: str, command: Command) -> Reference:
    out = home / name / "reference"
    out.mkdir(parents=True, exist_ok=True)
    before = cpu_seconds_of_children()
    done = run(command(out))
    assert done.returncode == 0, f"{name}: {done.stderr}"
    files = contents(out)
    pages = sum(-(-(out / file).stat().st_size // PAGE) for file in files)
    return Reference(files, pages, cpu_seconds_of_children() - before)


def starved(home: Path, times: int, rng: np.random.Generator) -> Iterator[Outcome]:
    """A full or read-only disk, too little memory, nobody who reads: one clear line, an exit code, nothing left.

    Args:
        home: a folder for the trials.
        times: per command and kind.
        rng: draws when disk and memory end.
    """
    references = {name: _reference(home, name, command) for name, command in commands(home).items()}
    for what, codes, trial, tries in (
        ("a disk that is full before the files are whole, at random sizes", {74}, _full_disk, times),
        ("a read-only disk", {74}, _read_only, 1),
        ("memory that ends at random sizes", None, _no_memory, times),
        ("closed standard output", {0, 141}, _unread, 1),
    ):
        broken, tried, skipped = [], 0, ""
        for name, command in commands(home).items():
            for number in range(tries):
                folder = home / name / f"{trial.__name__}-{number}"
                folder.mkdir(parents=True)
                try:
                    code, said, left = trial(folder, command, references[name], rng)
                except PermissionError as error:
                    skipped = str(error)
                    break
                finally:
                    shutil.rmtree(folder, ignore_errors=True)
                tried += 1
                # where memory ends inside a library it may end the process in a way of its own
                one_line = codes is None or (code in codes and (code == 0 or "\narmscope: " in f"\n{said}"))
                if left or not one_line or "Traceback" in said:
                    broken.append(f"{name}: {code} {left} {said[-300:]}")
        promise = "one clear line, an exit code of its own, nothing half-written"
        if trial is _unread:
            promise = "files are whole though nobody reads what is said"
        yield Outcome(promise, f"every command: {what}", tried, tuple(broken), skipped)


@contextlib.contextmanager
def _mounted(folder: Path, options: str) -> Iterator[Path]:
    """A file system of its own."""
    done = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise PermissionError("file systems can't be mounted here")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=False)


Trial = tuple[int, str, list[str]]
"""Exit code, what was said on standard error, what was left that should not be there."""


def _full_disk(folder: Path, command: Command, reference: Reference, rng: np.random.Generator) -> Trial:
    with _mounted(folder, "size=16m") as out:
        free = PAGE * int(rng.integers(reference.pages))
        (out / "theirs").write_bytes(bytes(16 * 2**20 - free))
        done = run(command(out))
        return done.returncode, done.stderr, sorted(set(contents(out)) - {"theirs"})


def _read_only(folder: Path, command: Command, reference: Reference, rng: np.random.Generator) -> Trial:
    with _mounted(folder, "size=1m,ro") as out:
        done = run(command(out))
        return done.returncode, done.stderr, sorted(contents(out))


def _no_memory(folder: Path, command: Command, reference: Reference, rng: np.random.Generator) -> Trial:
    # of addresses: from less than the interpreter and its libraries need to more than most commands do
    limit = int(rng.uniform(300, 1200)) * 2**20
    done = run(command(folder), preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    left = contents(folder)
    return (
        done.returncode,
        done.stderr,
        [] if left == (reference.files if done.returncode == 0 else {}) else sorted(left),
    )


def _unread(folder: Path, command: Command, reference: Reference, rng: np.random.Generator) -> Trial:
    process = subprocess.Popen(
        command(folder), env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    said = process.stderr.read()
    code, left = process.wait(), contents(folder)
    return code, said, [] if left == reference.files else sorted(left)


def two_at_once(home: Path, times: int) -> Iterator[Outcome]:
    """Two of the same command into one place: one writes, the other is told so; what is there is whole."""
    for name, command in commands(home).items():
        reference, broken = _reference(home, name, command), []
        for number in range(times):
            out = home / name / f"two-{number}"
            out.mkdir(parents=True)
            both = [
                subprocess.Popen(
                    command(out), env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
                )
                for _ in range(2)
            ]
            ends = [(process.communicate()[1], process.returncode) for process in both]
            codes = sorted(code for _, code in ends)
            if codes not in ([0, 0], [0, 75]) or contents(out) != reference.files or leftovers(out):
                broken.append(f"{name}: {codes} {[said[-200:] for said, _ in ends]}")
            shutil.rmtree(out)
        yield Outcome(
            "one writes, the other is refused with exit code 75",
            f"two of `{name}` into one place",
            times,
            tuple(broken),
        )
