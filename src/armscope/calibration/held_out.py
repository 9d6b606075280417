"""Held-out numbers in the reference protocol: configurations split at random, test RMS of the 3D distance."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from armscope.calibration.constants import CALIBRATING
from armscope.calibration.fit import placed
from armscope.calibration.model import LEVELS, Level, SetUp, set_up
from armscope.calibration.solve import Priors, solve
from armscope.core.averages import rms_distance
from armscope.core.grouping import by_label, named_configuration, same_configuration, visited_by_others
from armscope.core.types import Array, Indices
from armscope.recordings import Recordings
from armscope.robot import Arm


def random_split(recordings: Recordings, seed: int) -> tuple[Indices, Indices]:
    """Rows to train on and rows to test on: `default_rng(seed).permutation` of the configurations, 70 % to train on.

    A configuration is an id within its run; all its targets stay together. Where several runs stood at one pose, it is
    that pose: else rows to train on would hold what is wrong with those to test on.
    """
    configuration, count = _configurations(recordings)
    train = np.random.default_rng(seed).permutation(count)[: int(CALIBRATING.train_share * count)]
    in_train = np.isin(configuration, train)
    return np.flatnonzero(in_train), np.flatnonzero(~in_train)


def parts_to_test(recordings: Recordings, splits: int, parameters: int) -> Iterator[list[tuple[Indices, Indices]]]:
    """What is held out together, as pairs of rows to train on and rows to test on: a list of pairs for each split.

    Of a short table 70 % tell the parameters no more, and what they foretell says nothing of the whole: each
    configuration is then held out by itself, an equal number of them in each split.

    Args:
        recordings: the table.
        splits: how many.
        parameters: that are fitted.

    Yields:
        One list for each split.
    """
    draws = [random_split(recordings, seed) for seed in range(splits)]
    least = CALIBRATING.numbers_per_parameter * parameters
    if all(3 * len(train) >= least for train, _ in draws):
        yield from ([draw] for draw in draws)
        return
    configuration, count = _configurations(recordings)
    order = np.random.default_rng(0).permutation(count)
    for first in range(min(splits, count)):
        yield [(np.flatnonzero(configuration != c), np.flatnonzero(configuration == c)) for c in order[first::splits]]


def _configurations(recordings: Recordings) -> tuple[Indices, int]:
    """(N,) the number of each row's configuration, and how many there are."""
    configuration = named_configuration(recordings.run, recordings.id)
    pose = same_configuration(recordings.motor_angles)
    shared = visited_by_others(pose, by_label(recordings.run)[1])
    if shared.any():
        configuration = by_label(np.where(shared, -1 - pose, configuration).astype(str))[1]
    return configuration, int(configuration.max(initial=-1)) + 1


def foretold(rows: SetUp, train: Indices, test: Indices) -> Indices:
    """The rows of a test part whose base and tool the training part tells: without, nobody could foretell them.

    Args:
        rows: the set-up.
        train: rows of the training part.
        test: rows of the test part.

    Returns:
        The rows of ``test`` that stay.
    """
    return test[np.isin(rows.base[test], rows.base[train]) & np.isin(rows.tool[test], rows.tool[train])]


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
