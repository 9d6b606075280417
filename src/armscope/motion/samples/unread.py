"""Channels that went on saying one value while their joint sped up or turned back: nobody read them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.motion.samples.constants import READING
from armscope.motion.samples.standing import still_span
from armscope.motion.samples.timing import coarse_steps
from armscope.recordings.motions import Motions


def unread(motions: Motions) -> NDArray[np.bool_]:
    """(N, m) samples of channels that were not read, of runs whose rows may stand among others'.

    Noise repeats no value for long, unless a channel is coarse; and a torque that stays to the last digit while the
    joint does anything but stand or turn evenly is none.
    """
    order = np.argsort(motions.run, kind="stable")
    found = np.zeros(motions.effort.shape, dtype=np.bool_)
    found[order] = _held(motions.rows(order))
    return found


def _held(motions: Motions) -> NDArray[np.bool_]:
    """(N, m) the same where each run's rows stand together."""
    run, time, q, effort, still = motions.run, motions.time, motions.q, motions.effort, still_span(motions.sliding)
    found = np.zeros(effort.shape, dtype=np.bool_)
    new_run = run[1:] != run[:-1]
    for j in np.flatnonzero(coarse_steps(effort) == 0):
        changes = 1 + np.flatnonzero((np.diff(effort[:, j]) != 0) | new_run)
        first, last = np.append(0, changes), np.append(changes, len(time)) - 1
        long = time[last] - time[first] >= READING.unread_s
        for one, other in zip(first[long], last[long], strict=True):
            rows = slice(one, other + 1)
            evenly = np.interp(time[rows], time[[one, other]], q[[one, other], j])
            found[rows, j] = np.abs(q[rows, j] - evenly).max() > still[j]
    return found
