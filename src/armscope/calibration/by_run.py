"""How well a calibration does, run by run: on the rows it was fitted to, and on configurations that took no part."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd

from armscope.calibration.constants import CALIBRATING
from armscope.calibration.fit import placed
from armscope.calibration.model import SetUp
from armscope.calibration.splits import foretold, parts_to_test
from armscope.calibration.state import State
from armscope.core.averages import rms_distance
from armscope.recordings import Recordings

ALL = "all"


# so many parameters: a table and its calibration (three), how that is done again (one), and how it is tested (two)
def misses_by_run(
    rows: SetUp, recordings: Recordings, fitted: State, refit: Callable[[SetUp], State], splits: int, parameters: int
) -> pd.DataFrame:
    """RMS of the 3D distance by run, and of all rows.

    Args:
        rows: the set-up of the whole table.
        recordings: the table.
        fitted: the calibration of all rows.
        refit: the same calibration of some of the rows.
        splits: how often 70 % of the configurations are drawn to learn from; see `parts_to_test` of short tables.
        parameters: how many are fitted.

    Returns:
        run ("all" first), rows, in_sample_mm, held_out_mm and held_out_std_mm (mean and standard deviation over the
        splits), frames_only_mm (held out with base and tool alone). A row is tested only where its base and tool were
        learned.
    """
    without = replace(rows, orientations=None)
    names = [ALL, *dict.fromkeys(recordings.run.tolist())]
    if len(names) == 2:
        names = names[:1]
    of_run = {name: np.full(len(rows), True) if name == ALL else recordings.run == name for name in names}
    whole = without.residuals(fitted)
    held: dict[str, list[float]] = {name: [] for name in names}
    alone: dict[str, list[float]] = {name: [] for name in names}
    for seed, pairs in enumerate(parts_to_test(recordings, splits, parameters)):
        tested, found, frames = [], np.empty_like(whole), np.empty_like(whole)
        for train, test in pairs:
            if len(train) > CALIBRATING.rows_of_runs:
                train = np.sort(np.random.default_rng(seed).permutation(train)[: CALIBRATING.rows_of_runs])
            test = foretold(rows, train, test)
            found[test] = without.residuals(refit(rows.rows(train)))[test]
            frames[test] = without.residuals(placed(without.rows(train)))[test]
            tested.append(test)
        for name in names:
            mine = np.concatenate(tested)
            mine = mine[of_run[name][mine]]
            if len(mine):
                held[name].append(1e3 * rms_distance(found[mine]))
                alone[name].append(1e3 * rms_distance(frames[mine]))
    return pd.DataFrame(
        {
            "run": names,
            "rows": [int(of_run[name].sum()) for name in names],
            "in_sample_mm": [1e3 * rms_distance(whole[of_run[name]]) for name in names],
            "held_out_mm": [_mean(held[name]) for name in names],
            "held_out_std_mm": [float(np.std(held[name])) if held[name] else np.nan for name in names],
            "frames_only_mm": [_mean(alone[name]) for name in names],
        }
    )


def no_gain(misses: pd.DataFrame | None) -> bool:
    """Whether poses that took no part are foretold no better than by base and tool alone."""
    return misses is not None and bool(misses["held_out_mm"].iloc[0] >= misses["frames_only_mm"].iloc[0])


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else np.nan
