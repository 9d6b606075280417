"""Configurations split at random into rows to train on and rows to test on."""

from __future__ import annotations

import numpy as np

from armscope.calibration.model import SetUp
from armscope.core.grouping import named_configuration
from armscope.core.types import Indices
from armscope.recordings import Recordings

TRAIN_SHARE = 0.7


def random_split(recordings: Recordings, seed: int) -> tuple[Indices, Indices]:
    """Rows to train on and rows to test on: `default_rng(seed).permutation` of the configurations, 70 % to train on.

    A configuration is an id within its run; all its targets stay together.
    """
    configuration = named_configuration(recordings.run, recordings.id)
    count = int(configuration.max(initial=-1)) + 1
    train = np.random.default_rng(seed).permutation(count)[: int(TRAIN_SHARE * count)]
    in_train = np.isin(configuration, train)
    return np.flatnonzero(in_train), np.flatnonzero(~in_train)


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
