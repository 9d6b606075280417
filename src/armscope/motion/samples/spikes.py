"""Single readings far from those before and after: lost ones, slips of a bus; laid between their neighbours and said.

A position that leaps by a radian and back is an acceleration that outweighs all the motion. No arm does that: what a
joint and its torque do lasts longer than a few samples, or goes on from there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, median_filter

from armscope.core.types import Array
from armscope.motion.samples.constants import READING
from armscope.recordings.motions import Motions, torque_columns
from armscope.verdict.schema import Notice

SPIKES = "single readings"
"""Kind of the notice."""


def without_spikes(motions: Motions) -> tuple[Motions, list[Notice]]:
    """The table with positions and torques that stand alone laid between their neighbours, channel by channel.

    Args:
        motions: as recorded.

    Returns:
        The samples, and one notice that names channels, rows of the file and values; none where nothing stands alone.
    """
    q, effort, told = motions.q.copy(), motions.effort.copy(), []
    n = range(1, motions.n_motors + 1)
    positions = [f"q{j}_{'m' if slides else 'rad'}" for j, slides in zip(n, motions.sliding, strict=True)]
    efforts = torque_columns(motions.sliding) if motions.kind == "torque" else [f"current{j}_a" for j in n]
    for values, names in ((q, positions), (effort, efforts)):
        for joint, name in enumerate(names):
            column = values[:, joint]
            alone = _alone(motions, column, of_turns=name.endswith("rad"))
            if values is effort:
                alone &= ~_turns_back(motions, q[:, joint])
            if alone.any():
                rows = np.flatnonzero(alone)
                first = f"{name} in line {rows[0] + 2} ({column[rows[0]]:.4g})"
                told.append(first if len(rows) == 1 else f"{first} and {len(rows) - 1} more")
                for run in motions.runs:
                    there = motions.run == run
                    bad = there & alone
                    column[bad] = np.interp(motions.time[bad], motions.time[there & ~alone], column[there & ~alone])
    if not told:
        return motions, []
    text = (
        f"Readings far from those before and after: {'; '.join(told)}. No arm moves, and no torque acts, so briefly; "
        "they are laid between their neighbours."
    )
    return replace(motions, q=q, effort=effort), [Notice(SPIKES, text)]


def _alone(motions: Motions, values: Array, of_turns: bool) -> NDArray[np.bool_]:
    """(N,) which readings of one channel stand alone: far from the median of those about them, beyond what is usual.

    An angle may have been recorded within one turn: where it jumps by a whole one and back, it has not moved.
    """
    alone = np.zeros(len(values), dtype=np.bool_)
    if not np.isfinite(values).all():
        return alone
    runs = [np.flatnonzero(motions.run == run) for run in motions.runs]
    paths = [np.unwrap(values[rows]) if of_turns else values[rows] for rows in runs]
    off = [np.abs(path - median_filter(path, 2 * READING.spike + 1, mode="nearest")) for path in paths]
    usual = float(np.percentile(np.concatenate(off), READING.usual_off))
    width = float(np.subtract(*np.percentile(np.concatenate(paths), [95, 5])))
    far = READING.far_off * max(usual, READING.least_off * width, 1e-12)
    for rows, path, each in zip(runs, paths, off, strict=True):
        alone[rows] = _come_back(path, each > far)
    return alone


def _turns_back(motions: Motions, position: Array) -> NDArray[np.bool_]:
    """(N,) where a joint turns back: what a drive takes off there for friction has the wrong side for a moment."""
    back = np.zeros(len(position), dtype=np.bool_)
    for run in motions.runs:
        rows = np.flatnonzero(motions.run == run)
        moved = np.sign(np.diff(position[rows], prepend=position[rows[0]]))
        back[rows] = binary_dilation(np.diff(moved, prepend=moved[0]) != 0, iterations=READING.spike)
    return back


def _come_back(path: Array, far: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(N,) those far readings after which a channel goes on where it was: a blow, or a step, leaves it elsewhere."""
    found, edges = np.zeros_like(far), np.flatnonzero(np.diff(np.r_[False, far, False]))
    for first, end in edges.reshape(-1, 2):
        before, after = path[max(first - 1, 0)], path[min(end, len(path) - 1)]
        excursion = np.abs(path[first:end] - (before + after) / 2).min()
        found[first:end] = end - first <= READING.spike and abs(after - before) < READING.back * excursion
    return found
