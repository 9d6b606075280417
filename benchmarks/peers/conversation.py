"""How a peer's process talks with the benchmark: it reads a problem, calibrates when told to, and says where it got."""

from __future__ import annotations

import contextlib
import io
import json
import sys
import time
from collections.abc import Callable
from typing import Any

Problem = dict[str, Any]
Calibrate = Callable[[], Callable[[list[list[float]]], list[list[float]]]]


def converse(prepare: Callable[[Problem], Calibrate]) -> None:
    """Answer every line of standard input with the seconds that one calibration took and what it then predicts.

    Args:
        prepare: takes the problem of the first line and gives a function that calibrates once, from the nominal arm,
            and returns the calibrated prediction (joint angles rad to points m).
    """
    problem = json.loads(sys.stdin.readline())
    answers = sys.stdout
    with contextlib.redirect_stdout(io.StringIO()):
        calibrate = prepare(problem)
    answers.write("ready\n")
    answers.flush()
    for _ in sys.stdin:
        with contextlib.redirect_stdout(io.StringIO()):
            cpu, wall = time.process_time(), time.perf_counter()
            predict = calibrate()
            cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
            predicted = {name: predict(problem[name]["angles"]) for name in ("train", "fresh")}
        answers.write(json.dumps({"cpu_s": cpu, "wall_s": wall, "predicted": predicted}) + "\n")
        answers.flush()
