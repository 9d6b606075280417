"""Some rows of a long table that stand for all of it: spread evenly, and some of every run and target."""

from __future__ import annotations

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.recordings.table import Recordings


def some_rows(recordings: Recordings, most: int, of_each: int) -> Indices:
    """Rows spread evenly over a table, and the first ones of every run and target.

    Args:
        recordings: N rows.
        most: that are spread over the table.
        of_each: of every run and target at least, where there are so many.

    Returns:
        Their numbers, ascending.
    """
    group = _groups(recordings)
    order = np.argsort(group, kind="stable")
    sizes = np.bincount(group)
    place = np.arange(len(group)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    return np.unique(np.concatenate([spread_evenly(len(group), most), order[place < of_each]]))


def standing_for(recordings: Recordings, some: Indices) -> Array:
    """How many rows of its run and target each of some rows (n,) stands for."""
    group = _groups(recordings)
    return np.asarray(np.bincount(group)[group[some]] / np.bincount(group[some])[group[some]])


def _groups(recordings: Recordings) -> Indices:
    """(N,) number of each row's run and target."""
    _, run = np.unique(recordings.run, return_inverse=True)
    names, target = np.unique(recordings.target, return_inverse=True)
    return np.asarray(np.unique(run * len(names) + target, return_inverse=True)[1])
