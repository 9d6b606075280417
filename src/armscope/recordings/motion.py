"""Which joints move in a table, and from where: one answer for all who ask."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.recordings.constants import READING
from armscope.recordings.table import Recordings


def last_moves(recordings: Recordings) -> Array:
    """By how much each motor moved from the row before in the same run, if rows were measured in their order.

    Args:
        recordings: N rows, in any order; theirs is that of time, or of their numbers.

    Returns:
        (N, m) rad; NaN for the first row of a run.
    """
    clock = recordings.number if recordings.time is None else recordings.time
    order = np.lexsort((clock, recordings.run))
    moved = np.full(recordings.motor_angles.shape, np.nan)
    moved[order[1:]] = np.diff(recordings.motor_angles[order], axis=0)
    moved[order[np.concatenate([[True], recordings.run[order][1:] != recordings.run[order][:-1]])]] = np.nan
    return moved


def moving(angles: Array) -> NDArray[np.bool_]:
    """(m,) whether each of m joints moves, by its angles (N, m), rad."""
    return np.asarray(np.ptp(angles, axis=0) > READING.still_rad)
