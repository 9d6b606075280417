"""How long a user waits for `armscope diagnose` with its whole page: 300 rows of three arms, as whole processes.

Each command runs in a process of its own, on one thread, after a first run that is not counted; CPU and wall time as
medians with their range, and the ratio to a process that only imports what a diagnosis needs. Bytecode is cached, but
in a folder of the benchmark's own, as an installed package has it.

    python -m benchmarks.pages [--rounds 5]
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from benchmarks.diagnosis import ARMS, ONE_THREAD, ROWS, world

IMPORTS = "import armscope.cli.diagnosis, armscope.diagnosis, armscope.report.pages.diagnosis"


def timed(command: list[str], rounds: int, cache: Path) -> np.ndarray:
    """(rounds, 2) CPU and wall seconds of a command."""
    environment = os.environ | ONE_THREAD | {"PYTHONPYCACHEPREFIX": str(cache), "PYTHONDONTWRITEBYTECODE": ""}
    taken = []
    for _ in range(rounds + 1):
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, env=environment)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        taken.append((cpu, time.perf_counter() - start))
    return np.array(taken[1:])


def told(name: str, taken: np.ndarray, imports: float) -> str:
    """One line of the table."""
    cpu, wall = taken.T
    times = f"{np.median(cpu):5.2f} s CPU ({cpu.min():.2f}-{cpu.max():.2f})  {np.median(wall):5.2f} s wall"
    return f"{name:28s} {times}  {np.median(cpu) / imports:4.1f} x its imports"


def main() -> None:
    """Build the worlds, run the command on each, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    with tempfile.TemporaryDirectory() as name:
        home, cache = Path(name), Path(name) / "bytecode"
        imports = timed([sys.executable, "-c", IMPORTS], rounds, cache)
        alone = float(np.median(imports[:, 0]))
        print(told("imports", imports, alone), flush=True)
        for arm in ARMS:
            folder = world(arm, ROWS, home)
            for title, more in ((arm, []), (f"{arm}, no page", ["--no-report"])):
                command = [sys.executable, "-m", "armscope", "diagnose", str(folder / "recordings.csv"), "-r"]
                command += [str(folder / "robot.yaml"), "-o", str(home / "out"), "--force", *more]
                print(told(title, timed(command, rounds, cache), alone), flush=True)


if __name__ == "__main__":
    main()
