"""The noise below which nothing can be said: stated, or seen where the same pose was visited again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.recordings import Recordings
from armscope.robot import Arm

Array = NDArray[np.float64]

TRUSTED = 0.97
"""A stated noise is a lower bound; this much below it is left to chance."""
FEWEST_REPEATS = 6


@dataclass(frozen=True)
class Noise:
    """What is known of the noise beforehand: mm per axis, 0 where nothing is, and where from."""

    least_mm: float
    stated_mm: float
    source: str


def known_noise(arm: Arm, recordings: Recordings) -> Noise:
    """Noise from robot.yaml, else from the table's stated uncertainty, else from repeated poses, else unknown."""
    if arm.sigma is not None:
        return Noise(TRUSTED * arm.sigma * 1e3, arm.sigma * 1e3, "stated in robot.yaml")
    if recordings.sigma is not None and np.isfinite(recordings.sigma).any():
        stated = float(np.sqrt(np.nanmedian(recordings.sigma**2))) * 1e3
        return Noise(stated, 0.0, "estimated; the instrument's stated uncertainty is its lower bound")
    repeats = _from_repeats(recordings)
    if repeats is not None:
        return Noise(0.8 * repeats * 1e3, 0.0, "estimated; repeated poses are its lower bound")
    return Noise(0.0, 0.0, "estimated from the residuals")


def _from_repeats(recordings: Recordings) -> float | None:
    """Scatter, m per axis, of poses visited more than once in one run under the same load and approach."""
    context = [recordings.motor_angles.round(5)]
    context += [c.reshape(len(recordings), -1) for c in (recordings.payload, recordings.approach) if c is not None]
    _, run = np.unique(recordings.run, return_inverse=True)
    _, target = np.unique(recordings.target, return_inverse=True)
    keys = np.nan_to_num(np.column_stack([*context, run, target]))
    _, which, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    which = which.reshape(-1)
    freedom = int((count - 1).sum())
    if freedom < FEWEST_REPEATS:
        return None
    means = np.stack([np.bincount(which, p) / count for p in recordings.positions.T], axis=1)
    left = recordings.positions - means[which]
    return float(np.sqrt(np.sum(left**2) / (3 * freedom)))


def relative_uncertainty(recordings: Recordings, noise_mm: float) -> Array:
    """(N,) uncertainty of each row relative to the usual one: stated differences on top of the common noise."""
    if recordings.sigma is None:
        return np.ones(len(recordings))
    rows = np.sqrt(np.nanmean(recordings.sigma**2, axis=1)) * 1e3
    rows = np.where(np.isnan(rows), np.nanmedian(rows), rows)
    common = max(noise_mm**2 - float(np.median(rows**2)), 0.0)
    total = np.sqrt(common + rows**2)
    return np.asarray(total / np.median(total)) if np.median(total) > 0 else np.ones(len(rows))
