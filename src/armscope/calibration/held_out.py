"""Held-out numbers in the reference protocol: configurations split at random, test RMS of the 3D distance."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.calibration.fit import placed
from armscope.calibration.model import LEVELS, Level, SetUp, set_up
from armscope.calibration.solve import Priors, solve
from armscope.calibration.splits import foretold, random_split
from armscope.core.averages import rms_distance
from armscope.core.types import Array, Indices
from armscope.recordings import Recordings
from armscope.robot import Arm


@dataclass(frozen=True)
class HeldOutLevel:
    """Test RMS of the 3D distance per split, m."""

    level: Level
    per_split: tuple[float, ...]

    @property
    def mean(self) -> float:
        """Mean over the splits, m."""
        return float(np.mean(self.per_split))

    @property
    def std(self) -> float:
        """Standard deviation over the splits, m."""
        return float(np.std(self.per_split))

    @property
    def median(self) -> float:
        """Median over the splits, m."""
        return float(np.median(self.per_split))


def held_out_levels(
    arm: Arm,
    recordings: Recordings,
    levels: Iterable[Level] = LEVELS,
    seeds: Sequence[int] = (0, 1, 2, 3, 4),
    *,
    priors: Priors | None = None,
    most_rows: int | None = None,
) -> list[HeldOutLevel]:
    """Fit each level on 70 % of the configurations and test it on the rest, for several splits; a base for every run.

    Args:
        arm: the nominal arm.
        recordings: measured points.
        levels: which levels; "compliance" is left out where no loads are known.
        seeds: one split each.
        priors: sizes that hold what the rows do not tell; None takes the defaults.
        most_rows: train on the first so many of the training rows, as the reference does for very long runs.

    Returns:
        RMS of the 3D distance per split, m, by level.
    """
    rows = set_up(arm, recordings, one_base=False, tool_per_run=False)
    levels = [level for level in levels if level != "compliance" or rows.loads is not None]
    found: dict[Level, list[float]] = {level: [] for level in levels}
    for seed in seeds:
        train, test = random_split(recordings, seed)
        if most_rows is not None:
            train = np.random.default_rng(seed).permutation(train)[:most_rows]
        for level, left in residuals_on(rows, levels, train, foretold(rows, train, test), priors).items():
            found[level].append(rms_distance(left))
    return [HeldOutLevel(level, tuple(values)) for level, values in found.items()]


def residuals_on(
    rows: SetUp, levels: Iterable[Level], train: Indices, test: Indices, priors: Priors | None = None
) -> dict[Level, Array]:
    """What is left of rows that took no part, by level, m.

    Args:
        rows: the set-up of all rows.
        levels: which are fitted.
        train: rows to fit.
        test: rows whose base and tool those tell.
        priors: sizes that hold what the rows do not tell; None takes the defaults.

    Returns:
        (n, 3) of the test rows by level.
    """
    training, testing = rows.rows(train), rows.rows(test)
    start, known = placed(training), priors or Priors()
    return {
        level: testing.residuals(solve(training, level, "priors", known, robust=False, start=start).fitted.state)
        for level in levels
    }
