"""Channels that went on saying one value while their joint sped up or turned back: nobody read them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.samples.constants import READING
from armscope.motion.samples.timing import coarse_steps


def unread(run: NDArray[np.str_], time: Array, q: Array, effort: Array) -> NDArray[np.bool_]:
    """Samples of channels that were not read.

    Noise repeats no value for long, unless a channel is coarse; and a torque that stays to the last digit while the
    joint does anything but stand or turn evenly is none.

    Args:
        run: (N,) name of each sample's run.
        time: (N,) s.
        q: (N, m) rad (m).
        effort: (N, m) as recorded.

    Returns:
        (N, m) whether.
    """
    found = np.zeros(effort.shape, dtype=np.bool_)
    new_run = run[1:] != run[:-1]
    for j in np.flatnonzero(coarse_steps(effort) == 0):
        changes = 1 + np.flatnonzero((np.diff(effort[:, j]) != 0) | new_run)
        first, last = np.append(0, changes), np.append(changes, len(time)) - 1
        long = time[last] - time[first] >= READING.unread_s
        for one, other in zip(first[long], last[long], strict=True):
            rows = slice(one, other + 1)
            evenly = np.interp(time[rows], time[[one, other]], q[[one, other], j])
            found[rows, j] = np.abs(q[rows, j] - evenly).max() > LIBRARY.still_rad
    return found
