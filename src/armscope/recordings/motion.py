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
    order = np.lexsort((_clock(recordings), recordings.run))
    moved = np.full(recordings.motor_angles.shape, np.nan)
    moved[order[1:]] = np.diff(recordings.motor_angles[order], axis=0)
    moved[order[np.concatenate([[True], recordings.run[order][1:] != recordings.run[order][:-1]])]] = np.nan
    return moved


def sides_of_last_moves(recordings: Recordings, kept: bool = False) -> Array:
    """From which side each motor came to each row, if rows were measured in the order of their time or number.

    Args:
        kept: whether a motor that stood still from one row to the next still rests on the side that it came from
            before, as gears under load do; else it is on none, as one that relaxes is.

    Returns:
        (N, m) sign of the motor's motion from the row before in the same run, 0 for none; NaN where no row tells: for
        the first of a run, and where a side is kept, for all before the motor's first motion.
    """
    moves = last_moves(recordings)
    if not kept:
        return np.sign(moves)
    order = np.lexsort((_clock(recordings), recordings.run))
    runs = recordings.run[order]
    first = np.concatenate([[True], runs[1:] != runs[:-1]])
    moved = (np.abs(moves[order]) > READING.still_rad) | first[:, None]
    last = np.maximum.accumulate(np.where(moved, np.arange(len(order))[:, None], 0), axis=0)
    sides = np.empty_like(moves)
    sides[order] = np.sign(np.take_along_axis(moves[order], last, axis=0))
    return sides


def _clock(recordings: Recordings) -> Array:
    return recordings.number if recordings.time is None else recordings.time


def moving(angles: Array) -> NDArray[np.bool_]:
    """(m,) whether each of m joints moves, by its angles (N, m), rad."""
    return np.asarray(np.ptp(angles, axis=0) > READING.still_rad)
