"""Configurations split at random into rows to train on and rows to test on."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.calibration.constants import CALIBRATING
from armscope.calibration.model import SetUp
from armscope.core.grouping import by_label, named_configuration, same_configuration, visited_by_others
from armscope.core.types import Indices
from armscope.recordings import Recordings


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
