"""What a long table costs, said before the work begins."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path

from armscope.recordings.first_lines import estimated_rows

LONG_ROWS = 300_000  # A shorter table is done before anybody asks


@dataclass(frozen=True)
class Cost:
    """CPU time and memory of a command, of tables as `python -m benchmarks.scale` makes them."""

    # start_s, start_mb: of a short table
    start_s: float
    # row_us, row_kb: of every row beyond
    row_us: float
    start_mb: float
    row_kb: float

    def seconds(self, rows: int) -> float:
        """CPU time."""
        return self.start_s + 1e-6 * self.row_us * rows

    def megabytes(self, rows: int) -> float:
        """Memory of the process."""
        return self.start_mb + 1e-3 * self.row_kb * rows


# measured at 100,000 and a million rows (predict and compensate: 300,000) on a machine that did other work, too, which
# makes CPU time longer (an idle, newer one took a third); above what follows from them for ten million
DIAGNOSE = Cost(start_s=20.0, row_us=140.0, start_mb=500.0, row_kb=0.9)
PREDICT = Cost(start_s=3.0, row_us=30.0, start_mb=250.0, row_kb=0.5)
COMPENSATE = Cost(start_s=3.0, row_us=130.0, start_mb=300.0, row_kb=0.9)


def announce(table: Path, cost: Cost, threads: int) -> None:
    """Say on standard error what a long table will take, and whether this machine has the memory.

    Args:
        table: the file.
        cost: of the command.
        threads: processes that share the work.
    """
    rows = estimated_rows(table)
    if rows < LONG_ROWS:
        return
    text = f"about {rows:,} rows: some {_time(cost.seconds(rows))} of CPU time"
    if threads > 1:
        text += f", shared by {threads} processes,"
    needed, free = cost.megabytes(rows), _free_mb()
    text += f" and {needed / 1e3:.1f} GB of memory"
    if needed > free:
        text += f", but {free / 1e3:.1f} GB are free here: "
        text += f"keep one row in {int(needed / free) + 1}, or take a larger machine"
    print(f"note: {text}", file=sys.stderr, flush=True)


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} seconds"
    return f"{seconds / 60:.0f} minutes" if seconds < 6000 else f"{seconds / 3600:.1f} hours"


def _free_mb() -> float:
    """Memory that could be had without swapping."""
    try:
        with Path("/proc/meminfo").open(encoding="ascii") as lines:
            return next(float(line.split()[1]) for line in lines if line.startswith("MemAvailable")) / 1e3
    except (OSError, StopIteration, ValueError):
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e6
