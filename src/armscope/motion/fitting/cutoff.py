"""The cut-off of the low-pass, from spectra: where the model stops explaining more of the torque than it leaves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.signal import welch

from armscope.core.types import Array
from armscope.motion.fitting.first_look import FirstLook, first_look
from armscope.motion.samples.constants import CUTOFF, FILTER
from armscope.motion.samples.preparation import Preparation, preparation, thinned
from armscope.motion.samples.standing import still_span
from armscope.motion.samples.timing import Stretch
from armscope.robot.dynamics import MovingArm


def chosen_cutoff(arm: MovingArm, stretches: Sequence[Stretch], asked: float | None) -> tuple[Preparation, FirstLook]:
    """How samples become rows, with the cut-off that was asked for or the one that the spectra give.

    Of the longest motion of all joints, friction, rotors, masses and ripple are fitted at a generous cut-off; of their
    torque and of what it leaves, the spectra are taken. Above the frequency where what is left is as large, samples
    hold noise.

    Args:
        arm: the arm.
        stretches: even samples, ``effort`` in N m.
        asked: Hz; None where it is to be chosen.

    Returns:
        The filters and the decimation; what the fit tells besides.
    """
    by_run = _highest_hz(stretches)
    highest = max(by_run.values())
    how, first = _chosen(arm, stretches, asked, highest)
    return _by_run(_resolved(how, sum(map(len, stretches)), asked, highest), by_run), first


def _by_run(how: Preparation, highest: Mapping[str, float]) -> Preparation:
    """With each run's positions low-passed where its own motion ends.

    Noise of the acceleration in a slow run, beside a fast one that asks for a wide band, makes inertias look small.
    """
    own = {run: _prepared(how.rate, how.cutoff, "", hz).position_cutoff for run, hz in highest.items()}
    slower = tuple((run, hz) for run, hz in own.items() if hz < CUTOFF.slower_run * how.position_cutoff)
    return replace(how, of_runs=slower)


def _resolved(how: Preparation, samples: int, asked: float | None, highest: float) -> Preparation:
    """With as many rows as may be kept, and a cut-off that they resolve.

    Rows farther apart than the filter asks for leave out what lies between them, and slopes over them mean nothing; a
    lower cut-off takes it in. What the motion itself reaches stays below the cut-off.
    """
    kept = thinned(how, samples)
    if asked is not None or kept.every == how.every:
        return kept
    least = max(CUTOFF.least_hz, highest)
    lower, source = how, "what as many rows as are kept resolve"
    for every in range(kept.every, 3 * kept.every):  # steps of the model's own stride are skipped
        cutoff = float(f"{max(how.rate / (FILTER.rows_per_cutoff * every), least):.3g}")
        lower = _prepared(how.rate, min(cutoff, how.cutoff), source, highest)
        if cutoff <= least or lower.every * FILTER.most_rows >= samples:
            break
    return thinned(lower, samples) if lower.cutoff < how.cutoff else kept


def _chosen(
    arm: MovingArm, stretches: Sequence[Stretch], asked: float | None, highest: float
) -> tuple[Preparation, FirstLook]:
    rate = stretches[0].rate
    low, high = (np.array([bound(each.q, axis=0) for each in stretches]) for bound in (np.min, np.max))
    still = still_span(arm.sliding)
    spans = np.maximum(np.max(high, axis=0) - np.min(low, axis=0), still)
    generous = _prepared(rate, min(CUTOFF.widest * rate, CUTOFF.widest_hz), "generous", highest)
    first = first_look(arm, max(stretches, key=lambda stretch: _travelled(stretch, spans, still)), generous)
    if asked is not None:
        return _prepared(rate, asked, "as asked", highest), first
    if len(first.left) < CUTOFF.window:
        source = "a share of the sampling rate: the motion is short"
        return _prepared(rate, CUTOFF.fallback * rate, source, highest), first
    crossing = _crossing(first, rate / generous.every)
    cutoff = float(np.clip(crossing, CUTOFF.least_hz, generous.cutoff))
    source = "where the model explains as much as it leaves"
    return _prepared(rate, float(f"{cutoff:.2g}"), source, highest), first


def _travelled(stretch: Stretch, spans: Array, still: Array) -> tuple[int, float]:
    """How many joints move by more than (m,), and how far all go, in shares of their spans (m,): much may be pauses."""
    moving = np.sum(np.ptp(stretch.q, axis=0) > still)
    return int(moving), float(np.sum(np.abs(np.diff(stretch.q, axis=0)) / spans))


def _prepared(rate: float, cutoff: float, source: str, highest: float) -> Preparation:
    """How samples become rows whose positions show motion up to ``highest``, Hz.

    Noise that positions hold between that frequency and the torques' cut-off is noise of the model's torque, and none
    of the measured one: laws that bring out what is fast of a torque, of a drive that gives way, of a delay, fit it. So
    the positions' low-pass is close there. Where the torques' own low-pass takes that noise off, it is far enough away
    to leave the motion as it is.
    """
    cutoff = min(cutoff, FILTER.nyquist * rate / 2)
    close = CUTOFF.close_to_motion * highest
    return preparation(rate, cutoff, source, close if close < cutoff else CUTOFF.beyond_motion * highest)


def _highest_hz(stretches: Sequence[Stretch]) -> dict[str, float]:
    """Hz above which positions of each run hold noise only: where they come down to that of the highest frequencies.

    A run that was sampled more slowly has next to no noise there: it counts by that of the others. One that shows no
    motion has what the others have.
    """
    spectra = [_spectrum(stretch) for stretch in stretches]
    floor = np.max([np.median(power[-len(power) // 4 :], axis=0) for _, power in spectra], axis=0)
    highest: dict[str, float] = {}
    for stretch, (frequency, power) in zip(stretches, spectra, strict=True):
        moving = np.flatnonzero((power > CUTOFF.above_noise * floor).any(axis=1))
        seen = float(frequency[moving[-1]]) if len(moving) else 0.0
        highest[stretch.run] = max(highest.get(stretch.run, 0.0), seen)
    most = max(highest.values()) or np.inf
    return {run: hz or most for run, hz in highest.items()}


def _spectrum(stretch: Stretch) -> tuple[Array, Array]:
    """(F,) Hz and (F, m) of positions."""
    size = min(len(stretch) - 2, CUTOFF.window)
    bends = np.diff(stretch.q, n=2, axis=0)  # differences, so that a slow motion does not leak into all frequencies
    frequency, power = welch(bends, stretch.rate, nperseg=size, axis=0)
    return frequency[1:], power[1:] / (2 * np.sin(np.pi * frequency[1:, None] / stretch.rate)) ** 4


def _crossing(first: FirstLook, rate: float) -> float:
    """Hz up to which the model's torque has more power than what it leaves, at the joint that shows it furthest.

    A joint that shows it less far counts by its own noise: what is beyond its crossing does it no harm.
    """
    frequency, explained = welch(first.modelled, rate, nperseg=CUTOFF.window, axis=0)
    _, remains = welch(first.left, rate, nperseg=CUTOFF.window, axis=0)
    return max(_drowned(frequency, *powers) for powers in zip(explained.T, remains.T, strict=True))


def _drowned(frequency: Array, explained: Array, remains: Array) -> float:
    drowned = explained < CUTOFF.drowned * remains
    peak = int(np.argmax(explained))
    several = np.convolve(drowned[peak:], np.ones(CUTOFF.bins), mode="valid") == CUTOFF.bins
    return float(frequency[peak + int(np.argmax(several))]) if several.any() else float(frequency[-1])
