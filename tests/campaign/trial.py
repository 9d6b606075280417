"""A command of armscope that is run again and again in folders of its own, and what must be the same afterwards."""

from __future__ import annotations

import contextlib
import hashlib
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {
    **os.environ,
    "PYTHONPATH": os.pathsep.join([str(ROOT / "src"), *filter(None, [os.environ.get("PYTHONPATH")])]),
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

    What the workflow calls on its own results is killed with the workflow (`workflow.py`).

    Args:
        home: a folder where what some commands start from is made once.
    """
    example, moving, corpus = (
        ROOT / "examples" / "one-effect",
        ROOT / "examples" / "moving-arm",
        ROOT / "tests/fuzz/corpus",
    )
    table, robot = str(example / "recordings.csv"), str(example / "robot.yaml")
    model, fleet, verdicts = home / "model", home / "fleet", home / "verdicts"
    quick = ("--no-cross-validation", "--resamples", "0")
    if not model.is_dir():
        run(python("diagnose", table, "--robot", robot, "-o", str(model), *quick), check=True)
        run(python("fleet", "simulate", str(ROOT / "config/robots"), "--arms", "3", "-o", str(fleet)), check=True)
        run(python("fleet", "diagnose", str(fleet / "fleet.csv"), "-o", str(verdicts)), check=True)
    # by name: words of the command, and what it writes into the output folder
    lines = {
        "diagnose": (("diagnose", table, "--robot", robot, *quick), ""),
        "diagnose of motions": (("diagnose", moving / "test.csv.gz", "--robot", moving / "robot.yaml", "--anyway"), ""),
        "predict": (("predict", model / "model.yaml", table), "predicted.csv"),
        "predict of motions": (
            ("predict", corpus / "motion-model" / "moving-arm.yaml", corpus / "motions" / "moving-arm.csv"),
            "predicted.csv",
        ),
        "compensate": (("compensate", model / "model.yaml", table, "--separate-points"), "commands.csv"),
        "calibrate": (("calibrate", table, "--robot", robot), ""),
        "fit-error-model": (("fit-error-model", table, "--robot", robot, "--register"), "errormodel.json"),
        "compare": (("compare", table, example / "test.csv", "--robot", robot), ""),
        "poses": (("poses", "--robot", robot, "-n", "12", "--candidates", "30"), "poses.csv"),
        "excite": (("excite", moving / "robot.yaml", "--rounds", "2"), "trajectory.csv"),
        "import": (
            ("import", corpus / "raw" / "semicolons.csv", "-m", corpus / "raw" / "mapping.yaml"),
            "table.csv.gz",
        ),
        "init": (("init", ROOT / "tests" / "robot" / "torso_arm.urdf"), "robot.yaml"),
        "fleet simulate": (("fleet", "simulate", ROOT / "config" / "robots", "--arms", "3"), ""),
        "fleet diagnose": (("fleet", "diagnose", fleet / "fleet.csv", "--part", "0/3"), ""),
        "fleet page": (("fleet", "page", fleet / "fleet.csv", "--verdicts", verdicts), ""),
    }
    made = {
        name: lambda out, words=words, file=file: python(*map(str, words), "-o", str(out / file))
        for name, (words, file) in lines.items()
    }
    return made | {"check": lambda out: python("check", table, "--figure", str(out / "poses"))}


def cpu_seconds_of_children() -> float:
    """Of all processes that this one has waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command: list[str], **options: object) -> subprocess.CompletedProcess[str]:
    """Run to the end; what it printed is kept. What does not end in an hour raises."""
    options = {"timeout": 3600, "check": False, **options}
    return subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, **options)  # type: ignore[call-overload, no-any-return]


def contents(folder: Path) -> dict[str, str]:
    """Digest of every result below a folder, by name."""
    found = {}
    for path in sorted(folder.rglob("*")) if folder.is_dir() else ():
        inside = path.relative_to(folder)
        if path.is_file() and not any(part in NO_RESULT for part in inside.parts):
            content = path.read_bytes().replace(str(folder).encode(), b"")  # fleet.csv says where its tables are
            found[inside.as_posix()] = hashlib.sha256(content).hexdigest()
    return found


def leftovers(folder: Path) -> list[str]:
    """What a run that ended well must not leave: drafts, stages, plans, locks."""
    endings = (".part", ".new", ".plan", ".lock")
    return [path.name for path in folder.rglob("*") if path.name.endswith(endings) and ".snakemake" not in path.parts]


def cpu_seconds_of(session: int) -> float:
    """CPU seconds of all processes of a session so far; of those that have ended as far as they were waited for."""
    ticks = 0
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            # after the name, which may hold anything: state, parent, group, session, ...
            fields = (folder / "stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
            if int(fields[3]) == session:
                ticks += sum(map(int, fields[11:15]))
    return ticks / os.sysconf("SC_CLK_TCK")


def ended(command: list[str], after_cpu_s: float, sign: signal.Signals, cwd: Path | None = None) -> tuple[int, str]:
    """Start a process group and send it a signal after some work: exit code (negative: the signal) and what it said.

    Moments are of CPU time, so that other work on the machine does not shift them towards the start.
    """
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as said:
        process = subprocess.Popen(
            command, env=ENVIRONMENT, cwd=cwd, start_new_session=True, stdout=said, stderr=subprocess.STDOUT, text=True
        )
        while process.poll() is None and (missing := after_cpu_s - cpu_seconds_of(process.pid)) > 0:
            time.sleep(max(0.005, missing / (2 * (os.cpu_count() or 1))))  # looked at seldom: looking takes time, too
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, sign)
        process.wait(timeout=600)
        said.seek(0)
        return process.returncode, said.read()
