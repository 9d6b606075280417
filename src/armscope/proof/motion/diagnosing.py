"""Moving worlds diagnosed as their users would: by the command line, from the visible files alone.

This module must not know how worlds are made, nor what a sealed truth looks like.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

from armscope.core.files import copy_file, new_folder, write_text
from armscope.proof.answers import FAILURE
from armscope.proof.motion.answers import KEPT, NOT_PREDICTED, PREDICTED

LONGEST_S = 1200.0
LAST_WORDS = 2000  # Characters of what a failed command said that are kept


def diagnose_worlds(worlds: Iterable[Path], output: Path) -> None:
    """`armscope diagnose` and, for the path without torques, `armscope predict` on every world. ``output``: new
    folder; each world's verdict goes into a folder of the world's name."""
    new_folder(output)
    for world in worlds:
        started = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / "found"
            failure = _run("diagnose", world / "motions.csv", "--robot", world / "robot.yaml", "-o", made)
            silent = failure or _run("predict", made / "model.yaml", world / "test_motions.csv", "-o", made / PREDICTED)
            for name in KEPT:
                if (made / name).is_file():
                    copy_file(made / name, output / world.name / name)
        # one world's failure must not lose the others' answers: it is written down, and scored as wrong
        if failure:
            write_text(output / world.name / FAILURE, failure)
        elif silent:
            write_text(output / world.name / NOT_PREDICTED, silent)
        print(f"{world.name}: {time.perf_counter() - started:.1f} s{' FAILED' if silent else ''}", flush=True)


def _run(*words: object) -> str:
    """Why a command failed; empty where it did not."""
    command = [sys.executable, "-m", "armscope", *map(str, words)]
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_S, check=False)
    except subprocess.TimeoutExpired:
        return f"armscope {words[0]} took more than {LONGEST_S:g} s\n"
    return "" if ended.returncode == 0 else f"armscope {words[0]}: {ended.stderr[-LAST_WORDS:]}\n"
