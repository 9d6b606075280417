"""How long a whole diagnosis takes: 300 rows of three arms with the full library, and 100,000 rows of one.

Each diagnosis runs in a process of its own, on one thread, after a first run that is not counted; CPU and wall time as
medians with their range, peak memory of the process, and the ratio to the calibration of the same rows (plain geometry,
no search), timed in the same process. The atlas is timed inside the diagnosis.

    python -m benchmarks.diagnosis [--rounds 3] [--long 100000]
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pandas as pd

ROBOTS = Path(__file__).parents[1] / "config" / "robots"
ARMS = ("parallelogram-120kg", "six-axis", "seven-axis")
ROWS = 300
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def world(arm: str, rows: int, folder: Path) -> Path:
    """A virtual arm with two concealed effects, as files."""
    from armscope.world.catalogue import catalogue
    from armscope.world.folder import build
    from armscope.world.spec import WorldSpec

    model = next(spec for spec in catalogue(1, "full") if spec.category == "multiple" and spec.arm == arm)
    content = model.model_dump() | {"id": f"{arm}-{rows}", "rows": rows}
    return build(WorldSpec.model_validate(content), folder / f"{arm}-{rows}", ROBOTS) / "visible"


def lengthened(visible: Path, rows: int, folder: Path) -> Path:
    """The same arm's table repeated to many rows, each with noise of its own (speed only; the poses recur)."""
    table = pd.read_csv(visible / "recordings.csv")
    many = table.iloc[np.arange(rows) % len(table)].reset_index(drop=True)
    rng = np.random.default_rng(0)
    angles = [name for name in many.columns if name.startswith("q") and name.endswith("_rad")]
    many[["x_mm", "y_mm", "z_mm"]] += rng.normal(0, 0.02, (rows, 3))
    many[angles] += rng.normal(0, 1e-6, (rows, len(angles)))  # else they would be left out as repeated rows
    long = folder / "long"
    long.mkdir()
    many.to_csv(long / "recordings.csv", index=False)
    (long / "robot.yaml").write_text((visible / "robot.yaml").read_text())
    return long


def measure(visible: Path, rounds: int) -> dict[str, object]:
    """Run in a process of its own: times of diagnosis, atlas and calibration, seconds, and peak memory, MB."""
    from armscope.calibration.calibrate import calibrate
    from armscope.diagnosis import diagnose, pipeline
    from armscope.diagnosis.summary import attribution_map
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    arm = load_arm(visible / "robot.yaml")
    recordings = read_recordings(visible / "recordings.csv", arm.n_motors)
    atlas_times: list[float] = []
    atlas = attribution_map.atlas

    def timed_atlas(*arguments: object) -> object:
        start = time.process_time()
        result = atlas(*arguments)
        atlas_times.append(time.process_time() - start)
        return result

    cpu, wall, plain = [], [], []
    for number in range(rounds + 1):
        start, start_wall = time.process_time(), time.perf_counter()
        with patch("armscope.diagnosis.summary.rows.atlas", timed_atlas):
            verdict = diagnose(arm, recordings, pipeline.Settings())
        if number or rounds == 0:
            cpu.append(time.process_time() - start)
            wall.append(time.perf_counter() - start_wall)
        start = time.process_time()
        calibrate(arm, recordings)
        plain.append(time.process_time() - start)
    return {
        "rows": len(recordings),
        "effects": len(verdict.effects),
        "cpu": cpu,
        "wall": wall,
        "atlas": atlas_times[-len(cpu) :],
        "calibration": plain[-len(cpu) :],
        "memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def told(name: str, result: dict[str, object]) -> str:
    """One line of the table."""
    cpu, wall, atlas, plain = (np.array(result[key]) for key in ("cpu", "wall", "atlas", "calibration"))
    times = f"{np.median(cpu):6.2f} s CPU ({cpu.min():.2f}-{cpu.max():.2f})  {np.median(wall):6.2f} s wall"
    beside = f"atlas {np.median(atlas):5.2f} s  {np.median(cpu / plain):5.0f} x plain calibration"
    return f"{name:24s} {result['rows']:>7,} rows  {times}  {beside}  {result['memory_mb']:5.0f} MB"


def main() -> None:
    """Build the worlds, measure each in its own process, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--long", type=int, default=100_000, help="rows of the long table; 0 leaves it out")
    parser.add_argument("--measure", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.measure:
        print(json.dumps(measure(options.measure, options.rounds)))
        return
    with tempfile.TemporaryDirectory() as name:
        folders = {arm: world(arm, ROWS, Path(name)) for arm in ARMS}
        tasks = [(arm, folder, options.rounds) for arm, folder in folders.items()]
        if options.long:
            tasks.append((f"{ARMS[1]}, long", lengthened(folders[ARMS[1]], options.long, Path(name)), 0))
        for title, folder, rounds in tasks:
            command = [sys.executable, "-m", "benchmarks.diagnosis", "--rounds", str(rounds), "--measure", str(folder)]
            run = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | ONE_THREAD)
            print(told(title, json.loads(run.stdout.splitlines()[-1])), flush=True)


if __name__ == "__main__":
    main()
