"""A command of armscope that is run again and again in folders of its own, and what must be the same afterwards."""

from __future__ import annotations

import contextlib
import hashlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {
    **os.environ,
    "PYTHONPATH": str(ROOT / "src"),
    "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
NO_RESULT = ("logs", ".snakemake", ".armscope", "settings")
"""Folders whose content is no result: what the clock says, what is remembered."""


@dataclass(frozen=True)
class Outcome:
    """What one kind of trial showed: how often it was tried, and what went wrong."""

    promise: str
    tested: str
    tried: int
    broken: tuple[str, ...]
    skipped: str = ""

    def row(self) -> str:
        """As a line of a table."""
        held = f"skipped: {self.skipped}" if self.skipped else f"{self.tried - len(self.broken)} of {self.tried}"
        return f"| {self.promise} | {self.tested} | {held} |"


def python(*arguments: str) -> list[str]:
    """A command of armscope as a process."""
    return [sys.executable, "-m", "armscope", *arguments]


def commands(home: Path) -> dict[str, Callable[[Path], list[str]]]:
    """Every command that writes, by name: made for an output folder.

    Args:
        home: a folder where what some commands start from is made once.
    """
    example = ROOT / "examples" / "one-effect"
    table, robot = str(example / "recordings.csv"), str(example / "robot.yaml")
    model = home / "model"
    if not model.is_dir():
        run(python("diagnose", table, "--robot", robot, "-o", str(model), "--no-cross-validation", "--resamples", "0"))
    quick = ("--no-cross-validation", "--resamples", "0")
    return {
        "diagnose": lambda out: python("diagnose", table, "--robot", robot, "-o", str(out), *quick),
        "predict": lambda out: python("predict", str(model / "model.yaml"), table, "-o", str(out / "predicted.csv")),
        "compensate": lambda out: python(
            "compensate", str(model / "model.yaml"), table, "-o", str(out / "commands.csv"), "--separate-points"
        ),
        "calibrate": lambda out: python("calibrate", table, "--robot", robot, "-o", str(out)),
        "fit-error-model": lambda out: python(
            "fit-error-model", table, "--robot", robot, "-o", str(out / "errormodel.json"), "--register"
        ),
        "poses": lambda out: python(
            "poses", "--robot", robot, "-n", "12", "--candidates", "60", "-o", str(out / "poses.csv")
        ),
    }


def run(command: list[str], **options: object) -> subprocess.CompletedProcess[str]:
    """Run to the end; what it printed is kept. What does not end in an hour raises."""
    options.setdefault("timeout", 3600)
    return subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False, **options)  # type: ignore[call-overload, no-any-return]


def contents(folder: Path) -> dict[str, str]:
    """Digest of every result below a folder, by name."""
    found = {}
    for path in sorted(folder.rglob("*")) if folder.is_dir() else ():
        inside = path.relative_to(folder)
        if path.is_file() and not any(part in NO_RESULT for part in inside.parts):
            found[inside.as_posix()] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def leftovers(folder: Path) -> list[str]:
    """What a run that ended well must not leave: drafts, stages, plans, locks."""
    endings = (".part", ".new", ".plan", ".lock")
    return [path.name for path in folder.rglob("*") if path.name.endswith(endings) and ".snakemake" not in path.parts]


def ended(command: list[str], after_s: float, sign: signal.Signals, cwd: Path | None = None) -> tuple[int, str]:
    """Start a process group and send it a signal after a while: exit code (negative: the signal) and what it said."""
    process = subprocess.Popen(
        command,
        env=ENVIRONMENT,
        cwd=cwd,
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    time.sleep(after_s)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, sign)
    said, _ = process.communicate(timeout=600)
    return process.returncode, said
