"""Configurations split at random into rows to train on and rows to test on."""

from __future__ import annotations

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
    configuration = named_configuration(recordings.run, recordings.id)
    pose = same_configuration(recordings.motor_angles)
    shared = visited_by_others(pose, by_label(recordings.run)[1])
    if shared.any():
        configuration = by_label(np.where(shared, -1 - pose, configuration).astype(str))[1]
    count = int(configuration.max(initial=-1)) + 1
    train = np.random.default_rng(seed).permutation(count)[: int(CALIBRATING.train_share * count)]
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
