"""Channels that end at a rail: a drive at its limit, or a reading cut off; one value for many samples, or noise on one.

Where a rail is read exactly, it is the value that a channel keeps for several samples and never exceeds but by what a
filter behind it rings. With noise on it, samples are dense at one end of a channel's range and hardly reach beyond. So
they are at a joint that is all dry friction. There the motion asks for no more; at a rail, friction and masses do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.samples.constants import READING
from armscope.motion.samples.rail_constants import RAIL
from armscope.motion.samples.timing import coarse_steps
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class Rails:
    """Where channels end."""

    at: NDArray[np.bool_]  # (N, m) whether a sample lies on a rail
    values: tuple[tuple[float, ...], ...]  # of each channel, the rails that it has; Nm (N) or A
    noisy: tuple[bool, ...]  # of each channel, whether noise lies on them


def rails(motions: Motions, arm: MovingArm | None = None) -> Rails:
    """Samples that lie on a rail.

    Args:
        motions: N samples of m channels.
        arm: as stated; None looks for rails that are read exactly alone.

    Returns:
        Them, and the rails.
    """
    at = np.zeros(motions.effort.shape, dtype=np.bool_)
    values: list[list[float]] = [[] for _ in range(motions.n_motors)]
    by = RAIL.rings * np.ptp(motions.effort, axis=0)
    for run in motions.runs:
        there = np.flatnonzero(motions.run == run)
        for sign in (-1.0, 1.0):
            for j, limit in enumerate(_ends(sign * motions.effort[there])):
                if np.isfinite(limit):
                    at[there, j] |= sign * motions.effort[there, j] >= limit - by[j]
                    values[j].append(float(sign * limit))
    noisy = [False] * motions.n_motors
    if arm is not None and np.any(arm.inertial) and arm.n_motors == motions.n_motors:
        for j, sign, limit, inside in _with_noise(motions, arm, at):
            at[:, j] |= sign * motions.effort[:, j] >= inside
            values[j].append(sign * limit)
            noisy[j] = True
    return Rails(at, tuple(tuple(dict.fromkeys(each)) for each in values), tuple(noisy))


def _ends(effort: Array) -> Array:
    """(m,) largest effort that channels (N, m) show where they were cut off; without end where they were not.

    Noise repeats no value: one that a channel keeps for several samples in a row, and hardly exceeds, is its limit. Not
    so of a channel in coarse steps, which keeps any value.
    """
    fine = (coarse_steps(effort) == 0) & (np.ptp(effort, axis=0) > 0)
    found = np.full(effort.shape[1], np.inf)
    for j in np.flatnonzero(fine & (len(effort) >= READING.at_the_limit)):
        values = effort[:, j]
        unchanged = np.lib.stride_tricks.sliding_window_view(np.diff(values) == 0, READING.at_the_limit - 1)
        kept = values[: len(unchanged)][np.all(unchanged, axis=1)]
        if kept.size and values.max() - kept.max() <= RAIL.rings * np.ptp(values):
            found[j] = kept.max()
    return found


def _with_noise(motions: Motions, arm: MovingArm, known: NDArray[np.bool_]) -> list[tuple[int, float, float, float]]:
    """Joint, sign, rail and where it begins inside, of rails with noise on them; all but the joint times the sign."""
    dense = [
        (j, sign, *where)
        for j in np.flatnonzero((coarse_steps(motions.effort) == 0) & ~known.any(axis=0)).tolist()
        for sign in (-1.0, 1.0)
        if (where := _dense_end(sign * motions.effort[:, j])) is not None
    ]
    if not dense:
        return []
    q, dq, ddq, effort = _differenced(motions)
    rigid = arm.torques(q, dq, ddq, arm.inertial)
    return [each for each in dense if _asks_for_more(dq, ddq, rigid, effort, each)]


def _dense_end(effort: Array) -> tuple[float, float] | None:
    """The rail at the upper end of a channel (N,), and where it begins inside, where samples are dense there."""
    most, span = float(np.quantile(effort, 1 - RAIL.beyond)), float(np.ptp(effort))
    for width in RAIL.widths:
        inside = most - 2 * width * span
        on, before = effort >= inside, (effort >= inside - 2 * width * span) & (effort < inside)
        if np.mean(on) >= RAIL.least_share and np.sum(on) > RAIL.denser * np.sum(before):
            return float(np.median(effort[on])), inside
    return None


def _differenced(motions: Motions) -> tuple[Array, Array, Array, Array]:
    """Positions, speeds, accelerations and efforts of some samples, over a step that is slower than noise."""
    parts = []
    for run in motions.runs:
        there = motions.run == run
        time, q = motions.time[there], motions.q[there]
        inner = np.flatnonzero((time > time[0] + RAIL.step_s) & (time < time[-1] - RAIL.step_s))
        inner = inner[spread_evenly(len(inner), RAIL.samples)]
        if not len(inner):
            continue
        before, after = (
            np.column_stack([np.interp(time[inner] + by, time, each) for each in q.T])
            for by in (-RAIL.step_s, RAIL.step_s)
        )
        speed, acceleration = (after - before) / (2 * RAIL.step_s), (after + before - 2 * q[inner]) / RAIL.step_s**2
        parts.append((q[inner], speed, acceleration, motions.effort[there][inner]))
    q, dq, ddq, effort = (np.concatenate(each) for each in zip(*parts, strict=True))
    return q, dq, ddq, effort


def _asks_for_more(dq: Array, ddq: Array, rigid: Array, effort: Array, dense: tuple[int, float, float, float]) -> bool:
    """Whether friction and the stated masses, fitted to samples that are not at a dense end, ask for more than it."""
    j, sign, limit, inside = dense
    moves = np.abs(dq[:, j]) > LIBRARY.crawling * np.abs(dq[:, j]).max(initial=0.0)
    recorded = sign * effort[moves, j]
    columns = np.column_stack(
        [np.ones(len(recorded)), np.sign(dq[moves, j]), dq[moves, j], ddq[moves, j], rigid[moves, j]]
    )
    on = recorded >= inside
    if np.sum(~on) < READING.at_the_limit * columns.shape[1] or not on.any():
        return False
    fitted = np.linalg.lstsq(columns[~on], recorded[~on], rcond=None)[0]
    left = float(np.sqrt(np.mean((recorded[~on] - columns[~on] @ fitted) ** 2)))
    if left**2 > (1 - RAIL.described) * np.var(recorded[~on]):
        return False
    asked = columns[on] @ fitted
    if np.ptp(asked) > 0 and np.ptp(recorded[on]) > 0:
        follows = float(np.corrcoef(asked, recorded[on])[0, 1]) ** 2 > RAIL.followed
    else:
        follows = False
    return bool(np.mean(asked) - limit > RAIL.asked * left) and not follows
