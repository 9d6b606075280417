"""What holds a joint in a pause: any force within the band of its dry friction, which no property of the arm tells.

The solver, the controller or the last move decides it. A row whose low-pass takes in part of a pause holds a share of
that force. So every pause has forces of its own, as many as the low-pass can show, and they are free: what of the rows
goes with them tells nothing, the rest remains, as if they were fitted beside all else (Frisch & Waugh 1933). Where a
joint turns back it travels on: friction is then that of the motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.motion.library.sides import coulomb_width
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals
from armscope.robot.dynamics import MovingArm

AnyFloat = TypeVar("AnyFloat", np.float32, np.float64)
Spell = tuple[int, int]
"""First sample, and the one after the last."""


@dataclass(frozen=True, eq=False)
class Pauses:
    """Of one joint."""

    # of pauses whose rows overlap: (k,) numbers of these rows and (k, c) orthonormal columns, which span all that
    # forces in these pauses can make of them
    held: tuple[tuple[Indices, Array], ...] = ()

    def without(self, values: NDArray[AnyFloat]) -> NDArray[AnyFloat]:
        """Rows (K, ...) without what goes with the forces of pauses; the same array where there are none."""
        if not self.held:
            return values
        found = values.copy()
        for which, span in self.held:
            found[which] -= span @ (span.T @ values[which])
        return found

    def holding(self, rows: int, share: float = 0.5) -> NDArray[np.bool_]:
        """(rows,) those of which the forces of pauses take more than a share, the most where none is given."""
        found = np.zeros(rows, dtype=np.bool_)
        for which, span in self.held:
            found[which] = np.sum(span**2, axis=1) > share
        return found


def pauses_of(arm: MovingArm, signals: Signals, how: Preparation, still: NDArray[np.bool_]) -> tuple[Pauses, ...]:
    """Those of each joint, as its rows show them.

    Args:
        arm: the arm.
        signals: N samples with K rows.
        how: their filters.
        still: (K, m) rows that do not count, for the joint stands all about them.

    Returns:
        (m,) of them.
    """
    found = []
    for q, width, out in zip(signals.q.T, coulomb_width(arm), still.T, strict=True):
        held = _held(q, signals.period, width, how) & _near(signals, how, ~out)
        edges = np.flatnonzero(np.diff(np.r_[0, held.astype(np.int8), 0]))
        alone = [_shown(signals, how, spell) for spell in zip(edges[::2], edges[1::2], strict=True)]
        told = [(which[~out[which]], shown[~out[which]]) for which, shown in alone]
        spanned = map(_spanned, _groups([each for each in told if len(each[0])]))
        found.append(Pauses(tuple((which, span) for which, span in spanned if span.shape[1])))
    return tuple(found)


def joined(pieces: Sequence[tuple[int, tuple[Pauses, ...]]]) -> tuple[Pauses, ...]:
    """Of each joint, from numbers of rows and the pauses in them, one after the other."""
    before = np.cumsum([0, *(rows for rows, _ in pieces)])
    of_joints = zip(*(own for _, own in pieces), strict=True)
    return tuple(
        Pauses(tuple((which + first, span) for own, first in zip(of, before, strict=False) for which, span in own.held))
        for of in of_joints
    )


def pauses_in_words(pauses: Sequence[Pauses]) -> str:
    """What is done about them, to follow what else was done to the samples; nothing where there are none."""
    joints = [str(j + 1) for j, own in enumerate(pauses) if own.held]
    if not joints:
        return ""
    return f"; what holds a joint in a pause is any force within its friction, and free (joint {', '.join(joints)})"


def stands(arm: MovingArm, signals: Signals, rate: float) -> NDArray[np.bool_]:
    """Where a joint is slow for longer than it takes to turn back.

    Args:
        arm: the arm.
        signals: N samples.
        rate: of them, per second.

    Returns:
        (N, m).
    """
    width = FILTER.still * np.where(arm.sliding, FILTER.coulomb_width_m_s, FILTER.coulomb_width_rad_s)
    slow = np.abs(signals.dq) < width
    length = max(int(FILTER.still_s * rate), 1)
    total = np.cumsum(np.vstack([np.zeros(arm.n_motors), slow]), axis=0)
    stood = np.zeros_like(slow)
    if len(slow) > length:
        whole = (total[length:] - total[:-length]) == length  # windows that are slow all through
        for shift in (0, length // 2, length - 1):
            stood[shift : shift + len(whole)] |= whole
    return np.asarray(stood & slow)


def _shown(signals: Signals, how: Preparation, spell: Spell) -> tuple[Indices, Array]:
    """Rows about a pause, and what they hold of a force of one in each piece of it."""
    (first, end), reach = spell, _reach(signals, how)
    low, high = max(first - reach, 0), min(end + reach, len(signals.q))
    which = np.flatnonzero((signals.kept >= low) & (signals.kept < high))
    pieces = np.zeros((high - low, _pieces(end - first, signals.period, how)))
    at = np.arange(first, end)
    pieces[at - low, (at - first) * pieces.shape[1] // (end - first)] = 1.0
    if not len(which):
        return which, pieces[:0]
    return which, how.low_passed(pieces, signals.kept[which] - low, signals.stride)


def _pieces(samples: int, period: float, how: Preparation) -> int:
    """Into how many pieces a pause is parted, in each of which its force is constant."""
    return max(int(np.ceil(samples * period * max(how.cutoff, how.position_cutoff) / FILTER.pause_piece)), 1)


def _held(q: Array, period: float, width: float, how: Preparation) -> NDArray[np.bool_]:
    """Where a joint travels next to nothing for a while, and as long about it as its positions are blurred.

    Args:
        q: (N,) position of the joint.
        period: between two samples, s.
        width: speed within which its friction changes sides, rad/s (m/s).
        how: filters.

    Returns:
        (N,) of the samples.
    """
    from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d

    half = max(round(FILTER.pause_s / period / 2), 1)
    q = uniform_filter1d(q, half)  # noise of the positions is no travel
    travel = maximum_filter1d(q, 2 * half + 1) - minimum_filter1d(q, 2 * half + 1)
    rests = travel < FILTER.pause_travel * width * FILTER.pause_s
    blurred = int(np.ceil(FILTER.pause_blurred / how.position_cutoff / period))
    return np.asarray(_widened(rests, half + blurred))


def _near(signals: Signals, how: Preparation, told: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(N,) samples that rows (K,) which tell anything hold some of."""
    at = np.zeros(len(signals.q), dtype=np.bool_)
    at[signals.kept[told]] = True
    return _widened(at, _reach(signals, how))


def _widened(where: NDArray[np.bool_], by: int) -> NDArray[np.bool_]:
    from scipy.ndimage import maximum_filter1d

    return np.asarray(maximum_filter1d(where.astype(np.int8), 2 * by + 1) > 0)


def _reach(signals: Signals, how: Preparation) -> int:
    """Samples either side of a row that it holds some of."""
    return int(np.ceil(FILTER.pause_reach / how.cutoff / signals.period))


def _groups(alone: list[tuple[Indices, Array]]) -> Iterator[list[tuple[Indices, Array]]]:
    """Pauses whose rows overlap."""
    group: list[tuple[Indices, Array]] = []
    for each in alone:
        if group and (each[0][0] > group[-1][0][-1] or len(group) >= FILTER.pauses_at_once):
            yield group
            group = []
        group.append(each)
    if group:
        yield group


def _spanned(group: list[tuple[Indices, Array]]) -> tuple[Indices, Array]:
    """Rows, and what the forces of all pieces can make of them, but for what the low-pass hides."""
    which = np.unique(np.concatenate([rows for rows, _ in group]))
    columns = np.zeros((len(which), sum(shown.shape[1] for _, shown in group)))
    start = 0
    for rows, shown in group:
        columns[np.searchsorted(which, rows), start : start + shown.shape[1]] = shown
        start += shown.shape[1]
    left, size, _ = np.linalg.svd(columns, full_matrices=False)
    return which, left[:, size > FILTER.pause_shown]
