"""Single commands: killed, interrupted, out of disk or memory, unread, and two at once."""

from __future__ import annotations

import contextlib
import resource
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from tests.campaign.trial import ENVIRONMENT, Outcome, commands, contents, ended, leftovers, run

Command = Callable[[Path], list[str]]
"""Made for an output folder."""


def killed(home: Path, times: int, rng: np.random.Generator, sign: signal.Signals) -> Iterator[Outcome]:
    """Every writing command ended at random moments: nothing half-written, and the same command gives the same bytes.

    Args:
        home: a folder for the trials.
        times: per command.
        rng: draws the moments.
        sign: SIGKILL, or SIGINT, which must end with 130.
    """
    for name, command in commands(home).items():
        reference, seconds = _reference(home, name, command)
        broken = []
        for number in range(times):
            out = home / name / f"{sign.name}-{number}"
            out.mkdir(parents=True)
            code, said = ended(command(out), float(rng.uniform(0, seconds)), sign)
            left = contents(out)
            if left and left != reference:
                broken.append(f"{name}: half-written {sorted(left)}")
            elif sign is signal.SIGINT and code not in (0, 130, -2):  # -2: before Python's own start has ended
                broken.append(f"{name}: ended with {code}: {said[-200:]}")
            elif (again := run(command(out))).returncode or contents(out) != reference or leftovers(out):
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


def _reference(home: Path, name: str, command: Command) -> tuple[dict[str, str], float]:
    """What a command writes when nothing happens, and how long it takes."""
    out = home / name / "reference"
    out.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    done = run(command(out))
    assert done.returncode == 0, f"{name}: {done.stderr}"
    return contents(out), time.monotonic() - started


def starved(home: Path) -> Iterator[Outcome]:
    """A full or read-only disk, too little memory, nobody who reads: one clear line, an exit code, nothing left."""
    for what, codes, trial in (
        ("a disk of 64 kB", {74}, _full_disk),
        ("a read-only disk", {2, 74}, _read_only),
        ("too little memory", {71, 1, 127}, _no_memory),
    ):
        broken, tried, skipped = [], 0, ""
        for name, command in commands(home).items():
            if name == "calibrate" and what == "a disk of 64 kB":
                continue  # its files are smaller
            try:
                code, said, left = trial(home / f"{name}-{what.replace(' ', '-')}", command)
            except PermissionError as error:
                skipped = str(error)
                break
            tried += 1
            wrong_code = code not in codes and what != "too little memory"  # libraries end in ways of their own
            if left or (code and (wrong_code or "Traceback" in said)):
                broken.append(f"{name}: {code} {left} {said[-300:]}")
        yield Outcome(
            "one clear line, an exit code of its own, nothing half-written", what, tried, tuple(broken), skipped
        )
    broken = []
    for name, command in commands(home).items():
        out = home / f"{name}-unread"
        out.mkdir(parents=True, exist_ok=True)
        process = subprocess.Popen(command(out), env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        assert process.stdout is not None
        process.stdout.close()
        code = process.wait()
        if code not in (0, 141) or contents(out) != _reference(home, name, command)[0]:
            broken.append(f"{name}: {code}")
    yield Outcome(
        "files are whole though nobody reads what is said", "closed standard output", len(commands(home)), tuple(broken)
    )


@contextlib.contextmanager
def _mounted(folder: Path, options: str) -> Iterator[Path]:
    """A file system of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise PermissionError("file systems can't be mounted here")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=False)


def _full_disk(folder: Path, command: Command) -> tuple[int, str, list[str]]:
    with _mounted(folder, "size=64k") as out:
        (out / "theirs").write_bytes(b"0" * 61_440)  # all but a page
        done = run(command(out))
        return done.returncode, done.stderr, sorted(set(contents(out)) - {"theirs"})


def _read_only(folder: Path, command: Command) -> tuple[int, str, list[str]]:
    with _mounted(folder, "size=1m,ro") as out:
        done = run(command(out))
        return done.returncode, done.stderr, sorted(contents(out))


def _no_memory(folder: Path, command: Command) -> tuple[int, str, list[str]]:
    folder.mkdir(parents=True, exist_ok=True)
    limit = 500 * 1024**2  # of addresses: more than the interpreter and its libraries, less than a diagnosis
    done = run(command(folder), preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    return (
        done.returncode,
        "" if done.returncode == 0 else done.stderr,
        [] if done.returncode == 0 else sorted(contents(folder)),
    )


def two_at_once(home: Path, times: int) -> Iterator[Outcome]:
    """Two of the same command into one place: one writes, the other is told so; what is there is whole."""
    for name, command in commands(home).items():
        (reference, _), broken = _reference(home, name, command), []
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
            if codes not in ([0, 0], [0, 75]) or contents(out) != reference or leftovers(out):
                broken.append(f"{name}: {codes} {[said[-200:] for said, _ in ends]}")
            shutil.rmtree(out)
        yield Outcome(
            "one writes, the other is refused with exit code 75",
            f"two of `{name}` into one place",
            times,
            tuple(broken),
        )
