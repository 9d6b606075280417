"""What a plain fit of one motion tells before anything is weighed: the torque so far, and waves in what it leaves."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import orth

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting.model_estimate import Estimate, stated_model
from armscope.motion.fitting.rows import MotionRows, build_rows
from armscope.motion.fitting.selection import estimated_model
from armscope.motion.fitting.weights import fitted_together
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.samples.preparation import Preparation, parts
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
    speed = np.percentile(np.abs(np.diff(stretch.q[:, j])), 90) * stretch.rate / (2 * np.pi)
    most = min(LIBRARY.most_waves, int(how.cutoff / max(speed, 1e-9)))
    least = max(2, int(np.ceil(LIBRARY.least_waves * 2 * np.pi / max(float(np.ptp(stretch.q[:, j])), 1e-9))))
    counts, (moving, ordinary) = np.arange(least, most + 1), beside
    if not len(counts) or not moving.any():
        return ((), 1), np.zeros(len(left))
    made = []
    for signals in parts([stretch], how):
        turned = signals.q[:, j, None] * counts
        made.append(how.low_passed(np.stack([np.sin(turned), np.cos(turned)], axis=2), signals.kept, signals.stride))
    waves = np.concatenate(made)
    basis = orth(ordinary / np.maximum(np.linalg.norm(ordinary, axis=0), 1e-300))
    own = left[moving] - basis @ (basis.T @ left[moving])
    explained = np.zeros(len(counts))
    for number in range(len(counts)):
        wave = waves[moving, number]
        wave = wave - basis @ (basis.T @ wave)
        explained[number] = (wave.T @ own) @ np.linalg.lstsq(wave, own, rcond=None)[0]
    around = np.r_[-np.inf, explained, -np.inf]
    peaks = np.flatnonzero((explained >= around[:-2]) & (explained >= around[2:]))
    best = np.sort(peaks[np.argsort(-explained[peaks])][: LIBRARY.waves_kept])
    kept = waves[:, best].reshape(len(waves), -1)
    found = tuple(int(n) for n in counts[best])
    return (found, len(counts)), kept @ np.linalg.lstsq(kept[moving], left[moving], rcond=None)[0]
