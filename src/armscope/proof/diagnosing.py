"""Many worlds diagnosed in one process, each exactly as `armscope diagnose` would: by its visible files alone.

This module must not know how worlds are made, nor what a sealed truth looks like.
"""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.files import new_folder, write_table, write_text
from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose, write_verdict
from armscope.physics.model import FittedModel, predict
from armscope.proof.answers import FAILURE, PREDICTED
from armscope.recordings import Recordings, read_recordings
from armscope.recordings.columns import AXES_MM
from armscope.robot import load_arm

MOMENTS = 16  # Of the session, at which poses are predicted whose time nobody knows


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
    recordings = read_recordings(world / "recordings.csv", arm.n_motors)
    verdict = diagnose(arm, recordings, settings)
    write_verdict(verdict, output)
    poses = read_recordings(world / "test_poses.csv", arm.n_motors, measured=False)
    points = predicted_during(verdict.model, recordings, poses) * 1e3
    write_table(output / PREDICTED, pd.DataFrame(points, columns=AXES_MM))


def predicted_during(model: FittedModel, recordings: Recordings, poses: Recordings) -> Array:
    """(N, 3) m, points of poses that were taken among the recorded rows, nobody knows when.

    `armscope predict` takes a pose without a time for one of now, after all that was recorded. Held-out rows are of the
    session, as the oracle knows, too (`armscope.world.oracle`): where no times tell when, it is as it was on average
    in their run.

    Args:
        model: of the recorded rows.
        recordings: these.
        poses: N others of its runs.

    Returns:
        The points in the measurement frame.
    """
    if poses.time is not None:
        return predict(model, poses)
    shares = (np.arange(MOMENTS) + 0.5) / MOMENTS
    moments = np.empty((MOMENTS, len(poses)))
    for run in np.unique(poses.run):
        of_run = recordings.run == run
        moments[:, poses.run == run] = np.quantile(recordings.number[of_run], shares)[:, None]
    return np.asarray(np.mean([predict(model, replace(poses, number=at)) for at in moments], axis=0))
