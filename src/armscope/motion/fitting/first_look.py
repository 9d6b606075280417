"""What a plain fit of one motion tells before anything is weighed: the torque so far, and waves in what it leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.linear_algebra import spanned
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting.model_estimate import Estimate, stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.selection import estimated_model
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.waves import fewest_waves, successive_waves
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Preparation, Signals, parts
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm

Waves = dict[int, tuple[tuple[int, ...], int]]


@dataclass(frozen=True, eq=False)
class FirstLook:
    """Attributes:
    model: friction, rotors and masses, each as free as the others: what delay, gain and load follow at first.
    waves: by joint (from 0): how many per turn stand out of what it leaves, and how many were tried.
    modelled, left: (K, m) torque that the model and those waves explain, and what they leave, N m.
    """

    model: Estimate
    waves: Waves
    modelled: Array
    left: Array


def first_look(arm: MovingArm, stretch: Stretch, how: Preparation) -> FirstLook:
    """A fit of one stretch.

    Args:
        arm: the arm.
        stretch: even samples, ``effort`` in N m.
        how: filters and decimation.

    Returns:
        What it tells.
    """
    layout = TorqueLayout(arm, (), False)
    rows = build_rows(layout, [stretch], how, stated_model(arm))
    coefficients = fitted_together(rows, np.arange(layout.width))
    modelled = rows.nominal + rows.modelled(coefficients)
    waves: Waves = {}
    for j in np.flatnonzero(~arm.sliding):
        left = rows.torque[:, j] - modelled[:, j]
        ordinary = rows.columns[j][rows.moving[:, j]].astype(np.float64)
        waves[int(j)], rippled = _waves(stretch, how, int(j), left, (rows.moving[:, j], ordinary))
        modelled[:, j] += rippled
    model = replace(estimated_model(layout, coefficients), of_bodies=False)
    return FirstLook(model, waves, *(_in_motion(rows, torque) for torque in (modelled, rows.torque - modelled)))


def _in_motion(rows: MotionRows, torque: Array) -> Array:
    """Torque (K, m) where joints move, and straight lines where they stand: what holds them there is not told."""
    found, every = torque.copy(), np.arange(len(rows))
    for j in range(torque.shape[1]):
        moving = np.flatnonzero(rows.moving[:, j])
        found[:, j] = np.interp(every, moving, torque[moving, j]) if len(moving) else 0.0
    return found


def _waves(
    stretch: Stretch, how: Preparation, j: int, left: Array, beside: tuple[NDArray[np.bool_], Array]
) -> tuple[tuple[tuple[int, ...], int], Array]:
    """The counts whose waves explain most, each more than the counts beside it; how many were tried; their torque.

    Of many per turn only one that is most of what is left.

    What friction and masses can say of a wave is taken off it, as it was off what is left: by the whole wave, over a
    range of less than a third of a turn another count stood out than the true one.

    Args:
        stretch: even samples.
        how: filters and decimation.
        j: joint, from 0.
        left: (K,) torque of the joint that is left to explain, N m.
        beside: (K,) which of these rows tell anything, and the joint's other columns (moving, C) there.

    Returns:
        Counts, how many, (K,) N m.
    """
    (slow, fast), (moving, ordinary) = counts_shown(stretch, how, j), beside
    counts = np.concatenate([slow, fast])
    if not len(counts) or not moving.any():
        return ((), 1), np.zeros(len(left))
    basis = spanned(ordinary, FILTER.single)
    own = left[moving] - basis @ (basis.T @ left[moving])
    explained = np.zeros(len(counts))
    turned = list(parts([stretch], how))
    for some in np.array_split(np.arange(len(counts)), -(-len(counts) // LIBRARY.waves_at_once)):
        formed = _formed(turned, how, j, counts[some])[moving].reshape(len(own), -1)
        alone = formed - basis @ (basis.T @ formed)
        explained[some], squares = _explained_by_pairs(alone, own)
        explained[some[(some >= len(slow)) & (squares <= LIBRARY.wave_left * len(own))]] = 0.0
    best = _peaks(explained[: len(slow)])[: LIBRARY.waves_kept]
    standing_out = len(slow) + np.flatnonzero(explained[len(slow) :] > LIBRARY.most_of_the_rest * float(own @ own))
    if len(standing_out):
        best = np.append(best, standing_out[np.argmax(explained[standing_out])])
    if not len(best):
        return ((), len(counts)), np.zeros(len(left))
    best = np.sort(best)
    kept = np.hstack([_formed(turned, how, j, counts[[each]])[:, 0] for each in best])
    found = tuple(int(n) for n in counts[best]), len(counts) if len(standing_out) else len(slow)
    return found, kept @ np.linalg.lstsq(kept[moving], left[moving], rcond=None)[0]


def _explained_by_pairs(columns: Array, left: Array) -> tuple[Array, Array]:
    """Of what is left (K,) the squares that each pair of neighbouring columns (K, 2 c) explains, and its own; (c,)."""
    pairs = columns.reshape(len(left), -1, 2)
    G = np.einsum("kcx,kcy->cxy", pairs, pairs, optimize=True)
    b = (columns.T @ left).reshape(-1, 2)
    explained = np.einsum("cx,cxy,cy->c", b, np.linalg.pinv(G, rcond=FILTER.rounding, hermitian=True), b)
    return explained, np.trace(G, axis1=1, axis2=2)


def _peaks(explained: Array) -> Indices:
    """Where something explains more than what is beside it, the highest first."""
    around = np.r_[-np.inf, explained, -np.inf]
    peaks = np.flatnonzero((explained >= around[:-2]) & (explained >= around[2:]))
    return np.asarray(peaks[np.argsort(-explained[peaks])])


def counts_shown(stretch: Stretch, how: Preparation, j: int) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """Waves per turn that a joint's motion shows: its range holds some, and they pass below the cut-off.

    Few per turn do so at nearly all speeds. Many, of which a gear of 100 to 1 whose wave generator has two lobes makes
    200 per turn of its joint, do so in the motion's slower parts.

    Args:
        stretch: even samples.
        how: filters and decimation.
        j: joint, from 0.

    Returns:
        The counts of both kinds, ascending; none where its range holds too little of any.
    """
    speed = np.abs(np.diff(stretch.q[:, j])) * stretch.rate / (2 * np.pi)
    moving = speed[speed > LIBRARY.crawling * speed.max()]
    if not len(moving):
        return np.arange(0), np.arange(0)
    fast, slow = float(np.percentile(speed, 90)), float(np.percentile(moving, LIBRARY.slow_turn))
    least = fewest_waves(float(np.ptp(stretch.q[:, j])) / (2 * np.pi))
    few = min(LIBRARY.few_waves, int(how.cutoff / max(fast, 1e-9)))
    many = min(LIBRARY.most_waves, int(how.cutoff / max(slow, 1e-9)))
    return np.arange(least, few + 1), np.arange(max(few + 1, least), many + 1)


def _formed(turned: Sequence[Signals], how: Preparation, j: int, counts: NDArray[np.int_]) -> Array:
    """(K, counts, 2) waves of a joint's angle of successive counts, as rows."""
    first, number = int(counts[0]), len(counts)
    made = [how.low_passed(successive_waves(each, j, first, number), each.kept, each.stride) for each in turned]
    return np.concatenate(made)
