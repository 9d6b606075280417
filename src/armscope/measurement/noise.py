"""The noise below which nothing can be said: stated, or seen where the same pose was visited again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.grouping import same_configuration
from armscope.core.types import Array, Indices
from armscope.measurement.constants import NOISE
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.robot import Arm


@dataclass(frozen=True)
class Noise:
    """What is known of the noise beforehand: mm per axis, 0 where nothing is, and where from."""

    least_mm: float  # it is never taken to be below
    stated_mm: float  # as somebody stated it
    source: str  # where it is from, in words
    repeated_mm: float = 0.0  # how far repeats of a pose scatter
    repeats: int = 0  # rows beyond the first of their pose, by which this is known


def known_noise(arm: Arm, recordings: Recordings) -> Noise:
    """Noise from robot.yaml, else from the table's stated uncertainty, else from repeated poses, else unknown."""
    if arm.sigma is not None:
        return Noise(NOISE.trusted * arm.sigma * 1e3, arm.sigma * 1e3, "stated in robot.yaml")
    if recordings.sigma is not None and np.isfinite(recordings.sigma).any():
        stated = float(np.sqrt(np.nanmedian(recordings.sigma**2))) * 1e3
        return Noise(stated, 0.0, "estimated; the instrument's stated uncertainty is its lower bound")
    scatter, repeats = _of_repeats(recordings)
    if repeats >= NOISE.fewest_repeats:
        source = "estimated; repeated poses are its lower bound"
        return Noise(NOISE.repeats_trusted * scatter, 0.0, source, scatter, repeats)
    return Noise(0.0, 0.0, "estimated from the residuals")


def _of_repeats(recordings: Recordings) -> tuple[float, int]:
    """Scatter, mm per axis, of poses visited more than once in one run under the same load and approach; how often."""
    context = [c for c in (recordings.payload, recordings.approach) if c is not None]
    which = same_configuration(recordings.motor_angles, recordings.run, recordings.target, *context)
    count = np.bincount(which)
    repeats = int((count - 1).sum())
    means = np.stack([np.bincount(which, p) / count for p in recordings.positions.T], axis=1)
    left = recordings.positions - means[which]
    return 1e3 * float(np.sqrt(np.sum(left**2) / max(3 * repeats, 1))), repeats


def poses(recordings: Recordings) -> Indices:
    """(N,) number of the pose at which each row was taken: what is wrong with it every target and run sees again."""
    return same_configuration(recordings.motor_angles)


def independence_weights(residuals: Array, pose: Indices, trusted: NDArray[np.bool_]) -> Array:
    """(N,) share of an independent row that each row stands for.

    A residual is what is wrong with its pose (variance u^2, the same at every visit) and the reading's noise (e^2). The
    mean of k visits has variance u^2 + e^2 / k: together they count (u^2 + e^2) / (u^2 + e^2 / k) rows, 1 where the
    pose is wrong, k where the reading is. e^2 comes from within poses, u^2 from the likelihood of their means.

    Args:
        residuals: (N, 3) mm.
        pose: (N,) number of each row's configuration.
        trusted: (N,) rows that are no bad shots.

    Returns:
        (N,), at most 1.
    """
    visits = np.bincount(pose[trusted], minlength=int(pose.max()) + 1)
    freedom = int((visits[visits > 0] - 1).sum())
    if freedom < NOISE.fewest_repeats:
        return np.ones(len(pose))
    seen = visits > 0
    sums = np.stack([np.bincount(pose[trusted], r, len(visits)) for r in residuals[trusted].T], axis=1)
    means = sums / np.maximum(visits, 1)[:, None]
    within = np.sum((residuals[trusted] - means[pose[trusted]]) ** 2) / (3 * freedom)
    squares, k = np.sum(means[seen] ** 2, axis=1), visits[seen]
    ratios = np.concatenate([[0.0], np.geomspace(1e-3, 1e4, 57)])

    def log_likelihood(ratio: float) -> float:
        variance = max(within, 1e-18) * (ratio + 1 / k)
        return -0.5 * float(np.sum(3 * np.log(variance) + squares / variance))

    likelihood = np.array([log_likelihood(ratio) for ratio in ratios])  # one after the other: a long table has many
    best = int(np.argmax(likelihood))
    if likelihood[best] - likelihood[0] < NOISE.sure_nats:
        return np.ones(len(pose))
    every = np.bincount(pose)[pose]
    return np.asarray((ratios[best] + 1) / (every * ratios[best] + 1))


@dataclass(frozen=True)
class Growth:
    """Noise that grows with the distance d from the instrument: variance near^2 + (slope d)^2; mm, mm/m."""

    near_mm: float
    slope_mm_per_m: float
    evidence: float

    def at(self, distance: Array) -> Array:
        """Noise (N,), mm, at distances (N,), m."""
        return np.asarray(np.hypot(self.near_mm, self.slope_mm_per_m * distance))


def distances(model: FittedModel, recordings: Recordings) -> Array | None:
    """(N,) m from the measurement frame's origin; None where it lies within reach: no instrument is there."""
    points = model.to_base(recordings.positions, recordings.run)
    for run in np.unique(recordings.run):
        reach = np.linalg.norm(points[recordings.run == run], axis=1).max()
        if np.linalg.norm(model.base_of(str(run)).translation) < reach:
            return None
    return np.asarray(np.linalg.norm(recordings.positions, axis=1))


def growth(residuals: Array, distance: Array, trusted: NDArray[np.bool_]) -> Growth | None:
    """How the noise grows with distance, if the residuals (N, 3), mm, ask for it; None where it is the same everywhere.

    The likelihood of normal residuals with variance near^2 (1 + (ratio d)^2), near at its best, is compared with that
    of one variance for all.

    Args:
        residuals: (N, 3) mm.
        distance: (N,) from the instrument, any unit.
        trusted: (N,) rows that are no bad shots.

    Returns:
        Noise at the nearest and per distance, mm, with its evidence, nats.
    """
    squares, d = np.sum(residuals[trusted] ** 2, axis=1), distance[trusted]
    if squares.sum() <= 0:
        return None
    ratios = np.concatenate([[0.0], np.geomspace(0.01, 100.0, 81) / np.median(d)])
    variance, likelihood = np.empty((2, len(ratios)))
    for n, ratio in enumerate(ratios):  # one after the other: a long table has many rows
        shape = 1 + (ratio * d) ** 2
        variance[n] = np.mean(squares / shape) / 3
        likelihood[n] = -1.5 * (len(d) * np.log(variance[n]) + np.sum(np.log(shape)))
    best = int(np.argmax(likelihood))
    gain = float(likelihood[best] - likelihood[0]) - 0.5 * float(np.log(3 * len(d))) - NOISE.sure_nats
    if gain < 0:
        return None
    size = float(np.sqrt(variance[best]))
    return Growth(size, size * float(ratios[best]), gain)


def relative_uncertainty(recordings: Recordings, noise_mm: float, known: Array | None = None) -> Array:
    """(N,) uncertainty of each row relative to the usual one: stated differences on top of the common noise.

    Args:
        recordings: with the uncertainties that they state.
        noise_mm: the common noise.
        known: (N,) noise of the rows, mm, where it was found to differ; counts where none is stated.

    Returns:
        (N,), 1 for the usual row.
    """
    if recordings.sigma is None or not np.isfinite(recordings.sigma).any():
        return np.ones(len(recordings)) if known is None else np.asarray(known / np.median(known))
    stated = np.isfinite(recordings.sigma)
    squares = np.where(stated, recordings.sigma, 0.0) ** 2
    rows = np.sqrt(squares.sum(axis=1) / np.maximum(stated.sum(axis=1), 1)) * 1e3
    rows = np.where(stated.any(axis=1), rows, np.median(rows[stated.any(axis=1)]))
    common = max(noise_mm**2 - float(np.median(rows**2)), 0.0)
    total = np.sqrt(common + rows**2)
    return np.asarray(total / np.median(total)) if np.median(total) > 0 else np.ones(len(rows))
