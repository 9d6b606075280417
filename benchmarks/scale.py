"""What long tables cost: CPU time and memory of whole commands by rows, from which `armscope.cli.cost` foretells.

Each command runs in a process of its own, on one thread. Between the shortest and the longest table cost is taken as a
start and so much per row. Ratios to the shortest say how it grows: below the ratio of rows, less than in proportion.

    python -m benchmarks.scale [--rows 10000 1000000]     # a million rows: some minutes
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from benchmarks.diagnosis import ONE_THREAD, ROWS, lengthened, world

ARM = "six-axis"
COMMANDS = {
    "diagnose": "diagnose {table} -r {robot} -o {out} --no-cross-validation --resamples 0 --no-report",
    "predict": "predict {model} {table} -o {out}.csv",
    "compensate": "compensate {model} {table} -o {out}.csv --separate-points",
}


def cost(command: list[str]) -> tuple[float, float]:
    """CPU seconds and most memory (MB) of a process."""
    silent = subprocess.DEVNULL
    process = subprocess.Popen(command, env=os.environ | ONE_THREAD, stdout=silent, stderr=silent)
    _, status, used = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 3):  # 3: some rows have no command
        raise RuntimeError(f"{' '.join(command)} ended with {os.waitstatus_to_exitcode(status)}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=int, nargs="+", default=[10_000, 1_000_000])
    asked = parser.parse_args()
    rows = sorted(asked.rows)
    with tempfile.TemporaryDirectory() as made:
        home = Path(made)
        short = world(ARM, ROWS, home)
        tables = {}
        for count in rows:
            (home / str(count)).mkdir()
            tables[count] = lengthened(short, count, home / str(count))
        files = {"robot": short / "robot.yaml", "model": home / f"diagnose-{rows[0]}" / "model.yaml"}
        for name, line in COMMANDS.items():
            taken = []
            for count in rows:
                places = files | {"table": tables[count] / "recordings.csv", "out": home / f"{name}-{count}"}
                taken.append(cost([sys.executable, "-m", "armscope", *line.format(**places).split()]))
                cpu, memory = np.divide(taken[-1], taken[0])
                seconds, megabytes = taken[-1]
                print(f"{name:11}{count:9,} rows{seconds:8.1f} s CPU ({cpu:.1f} x){megabytes:8.0f} MB ({memory:.1f} x)")
            if len(rows) > 1:
                each = np.subtract(taken[-1], taken[0]) / (rows[-1] - rows[0])
                start = np.array(taken[0]) - rows[0] * each
                per_row = f"{1e6 * each[0]:.0f} us, {1e3 * each[1]:.2f} kB"
                print(f"{'':11}start {start[0]:.1f} s, {start[1]:.0f} MB; a row {per_row}")


if __name__ == "__main__":
    main()
