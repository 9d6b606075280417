"""Many worlds diagnosed in one process, each exactly as `armscope diagnose` would: by its visible files alone.

This module must not know how worlds are made, nor what a sealed truth looks like.
"""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Iterable
from pathlib import Path

import pandas as pd

from armscope.core.files import new_folder, write_table, write_text
from armscope.diagnosis import Settings, diagnose, write_verdict
from armscope.physics.model import predict
from armscope.proof.answers import FAILURE, PREDICTED
from armscope.recordings import read_recordings
from armscope.recordings.columns import AXES_MM
from armscope.robot import load_arm


def diagnose_worlds(worlds: Iterable[Path], output: Path, settings: Settings) -> None:
    """Diagnose every world and predict its test poses.

    Args:
        worlds: folders with robot.yaml, recordings.csv and test_poses.csv.
        output: new folder; each world's verdict goes into a folder of the world's name.
        settings: of the diagnosis.
    """
    new_folder(output)
    for world in worlds:
        started = time.perf_counter()
        try:
            _diagnose(world, output / world.name, settings)
        except Exception as error:
            # one world's failure must not lose the others' answers: it is written down, and scored as wrong
            traceback.print_exc(file=sys.stderr)
            write_text(output / world.name / FAILURE, f"{type(error).__name__}: {error}\n")
        # for the log: what the clock says is no result, which is the same wherever it is computed
        print(f"{world.name}: {time.perf_counter() - started:.1f} s", flush=True)


def _diagnose(world: Path, output: Path, settings: Settings) -> None:
    arm = load_arm(world / "robot.yaml")
    verdict = diagnose(arm, read_recordings(world / "recordings.csv", arm.n_motors), settings)
    write_verdict(verdict, output)
    poses = read_recordings(world / "test_poses.csv", arm.n_motors, measured=False)
    points = predict(verdict.model, poses) * 1e3
    write_table(output / PREDICTED, pd.DataFrame(points, columns=AXES_MM))
