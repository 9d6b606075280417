"""How long commands take to say that an input can't be used: whole processes, wall and CPU seconds.

python -m benchmarks.failing
"""

from __future__ import annotations

import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXAMPLE = Path(__file__).parents[1] / "examples" / "five-effects"
ROOT = EXAMPLE.parents[1]
MODEL, URDF = ROOT / "tests/fuzz/corpus/model/five-effects.yaml", ROOT / "tests/robot/torso_arm.urdf"
ROUNDS = 5
AIM_S = 0.7
LINES = (
    "--help",
    "diagnose RECORDINGS -r BAD.yaml -o OUT",
    "diagnose BAD.csv -r ROBOT -o OUT",
    "diagnose RECORDINGS -r OTHER -o OUT",
    "check BAD.csv -r ROBOT",
    "calibrate BAD.csv -r ROBOT -o OUT",
    "predict BAD.yaml RECORDINGS -o OUT.csv",
    "poses -r BAD.yaml -o OUT.csv",
    "compensate BAD.yaml RECORDINGS -o OUT.csv",
    "compensate MODEL BAD.csv -o OUT.csv",
    "predict MODEL BAD.csv -o OUT.csv",
    "fit-error-model BAD.csv -r ROBOT -o OUT.json",
    "diagnose CELL.csv -r ROBOT -o OUT",
    "check CELL.csv -r ROBOT",
    "diagnose BAD.csv -r URDF -o OUT",
    "diagnose HOME/predicted.csv -r HOME/robot.yaml -o HOME",
    "calibrate HOME/predicted.csv -r HOME/robot.yaml -o HOME",
    "compare BAD.csv BAD.csv -r ROBOT",
    "init nowhere.urdf",
)


def seconds(words: list[str]) -> tuple[float, float]:
    """Wall and CPU time of one process."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run([sys.executable, "-m", "armscope", *words], capture_output=True, check=False)
    wall, after = time.perf_counter() - started, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _placed(word: str, places: dict[str, Path]) -> str:
    name = re.split(r"[./]", word)[0]
    return f"{places[name]}{word.removeprefix(name)}" if name in places else word


def main() -> None:
    """Print the median of every command."""
    with tempfile.TemporaryDirectory() as folder:
        places = {"BAD": Path(folder) / "bad", "OUT": Path(folder) / "out"}
        Path(f"{places['BAD']}.yaml").write_text("name: arm\n")
        Path(f"{places['BAD']}.csv").write_text("a,b\n1,2\n")
        rows = (EXAMPLE / "recordings.csv").read_text().splitlines()
        rows[40] = rows[40].replace(".", ",", 1).replace(",", ";", 1)
        places["CELL"] = Path(folder) / "cell"
        Path(f"{places['CELL']}.csv").write_text("\n".join(rows) + "\n")
        places["HOME"] = Path(folder) / "home"
        places["HOME"].mkdir()
        (places["HOME"] / "predicted.csv").write_bytes((EXAMPLE / "recordings.csv").read_bytes())
        (places["HOME"] / "robot.yaml").write_bytes((EXAMPLE / "robot.yaml").read_bytes())
        places |= {"MODEL": MODEL, "URDF": URDF}
        places |= {
            "OTHER": ROOT / "config" / "robots" / "six-axis.yaml",
            "ROBOT": EXAMPLE / "robot.yaml",
            "RECORDINGS": EXAMPLE / "recordings.csv",
        }
        print(f"{'armscope ...':45s} wall s  CPU s  (aim: {AIM_S} s)")
        for line in LINES:
            words = [_placed(word, places) for word in line.split()]
            took = [seconds(words) for _ in range(ROUNDS)]
            wall, cpu = (statistics.median(values) for values in zip(*took, strict=True))
            print(f"{line:45s} {wall:6.2f} {cpu:6.2f}")


if __name__ == "__main__":
    main()
