"""Torque that is off for seconds at a time, and follows nothing recorded: a brake that drags, a sensor that drifts.

It comes back with no path and no run, and counts as noise that lasts (`armscope.motion.fitting.weights`), of which
four rows are then all that there is: evidence asks for nothing, and nothing would be missing. No instrument's noise
lasts that long and is as large.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.core.words import rounded
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.clauses import run_in_words
from armscope.motion.summary.constants import LASTING, WANDERING
from armscope.motion.summary.lasting import LastingTorque, left_by_friction

DRIVER = "time alone, for a second or longer at a stretch"
"""What it follows, in words."""


def wandering_torques(selected: SelectedCauses) -> tuple[LastingTorque, ...]:
    """Joints of which much of the torque is off for seconds at a time; largest share first.

    Args:
        selected: the selection.

    Returns:
        By how much each.
    """
    rows, before, found = selected.rows, left_by_friction(selected), []
    for j in range(rows.torque.shape[1]):
        which = selected.weights.row[:, j] > 0
        if np.sum(which) < LASTING.least_rows:
            continue
        spells = _numbered(rows.run[which], rows.time[which])
        power = slow_power(selected.residuals[which, j], spells)
        torque = float(np.sqrt(np.mean(rows.torque[which, j] ** 2)))
        share = power / max(float(np.mean(before[which, j] ** 2)), 1e-300)
        of_torque = float(np.sqrt(power)) / max(torque, 1e-300)
        if share > WANDERING.share and of_torque > WANDERING.of_torque:
            most = _most(selected.residuals[which, j], spells, rows.run[which])
            unit = "N" if rows.layout.arm.sliding[j] else "N m"
            driver = f"{DRIVER}, by up to {rounded(most[0])} {unit}{most[1]}"
            found.append(LastingTorque(j, driver, float(np.sqrt(power)), of_torque, share))
    return tuple(sorted(found, key=lambda each: -each.share))


def slow_power(left: Array, spell: NDArray[np.intp]) -> float:
    """Mean square of the means over spells, less what rows that differ within them give by chance.

    Args:
        left: (K,) what a model leaves.
        spell: (K,) number of each row's spell, from 0.

    Returns:
        Its unit squared; 0 where the rows within a spell say that there is none.
    """
    count = np.bincount(spell)
    mean = np.bincount(spell, left) / count
    free = np.maximum(np.sum(count - 1), 1)
    within = float(np.sum((left - mean[spell]) ** 2)) / free
    return max(float(np.sum(count * mean**2) - len(count) * within) / len(left), 0.0)


def _most(left: Array, spell: NDArray[np.intp], run: NDArray[np.str_]) -> tuple[float, str]:
    """By how much a spell is off at most, and in which run in words, where there are several."""
    mean = np.bincount(spell, left) / np.bincount(spell)
    most = int(np.argmax(np.abs(mean)))
    where = f" in {run_in_words(str(run[np.argmax(spell == most)]))}" if len(set(run.tolist())) > 1 else ""
    return float(abs(mean[most])), where


def _numbered(run: NDArray[np.str_], time: Array) -> NDArray[np.intp]:
    """(K,) the second of each row, counted over all runs."""
    of_run = np.unique(run, return_inverse=True)[1]
    seconds = np.floor((time - time.min()) / WANDERING.seconds).astype(int)
    return np.asarray(np.unique(np.column_stack([of_run, seconds]), axis=0, return_inverse=True)[1].reshape(-1))
