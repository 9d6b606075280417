"""The low-pass that all samples go through: forward and back, so that nothing comes late."""

from __future__ import annotations

import functools

import numpy as np

from armscope.core.types import Array
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.ends import going_on


def without_lag(values: Array, cutoff: float, rate: float, padded: int, going: bool = False) -> Array:
    """Samples through the low-pass, forward and back.

    Args:
        values: (N, ...).
        cutoff: Hz.
        rate: samples per second.
        padded: samples by which the ends are continued, turned about the end points.
        going: continue them as they go on, before that; what is left out at the ends needs it not.

    Returns:
        (N, ...).
    """
    from scipy.signal import sosfiltfilt  # takes long to import: a table that is refused needs none

    if going:
        whole, more = going_on(values, min(cutoff, 0.49 * rate), rate)
        return without_lag(whole, cutoff, rate, padded)[more:-more]
    return np.asarray(sosfiltfilt(low_pass_sections(cutoff, rate), values, axis=0, padlen=min(padded, len(values) - 1)))


@functools.lru_cache(maxsize=8)
def low_pass_sections(cutoff: float, rate: float) -> Array:
    """Second-order sections of the low-pass at a cut-off, Hz, of samples at a rate."""
    from scipy.signal import butter

    return np.asarray(butter(FILTER.order, min(cutoff, 0.49 * rate), fs=rate, output="sos"))


def without_what_is_faster(values: Array, time: Array, own: float, period: float) -> Array:
    """Samples without what a coarser grid can't hold: it would come back on it as something slow.

    Args:
        values: (N, c), NaN where nothing was recorded.
        time: (N,) s.
        own: s, between these samples as a rule.
        period: s, of the grid.

    Returns:
        (N, c) at the same times.
    """
    even = time[0] + own * np.arange(int(np.ceil((time[-1] - time[0]) / own)) + 1)
    found, cutoff = values.astype(np.float64), FILTER.nyquist / (2 * period)
    for c in np.flatnonzero(np.isfinite(values).all(axis=0)):
        smooth = without_lag(np.interp(even, time, values[:, c]), cutoff, 1 / own, int(np.ceil(period / own)), True)
        found[:, c] = np.interp(time, even, smooth)
    return found


def mean_about(grid: Array, period: float, time: Array, values: Array) -> Array:
    """Means over the time of each sample of a coarser grid, as friction that changes sides within one is formed.

    A low-pass would round these steps off, and what they lack then has the shape of friction that falls near rest.

    Args:
        grid: (K,) s, the middles.
        period: s, between them.
        time: (N,) s, of the values.
        values: (N, c).

    Returns:
        (K, c).
    """
    steps = np.diff(time)[:, None] * (values[1:] + values[:-1]) / 2
    whole = np.vstack([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])
    low, high = np.maximum(grid - period / 2, time[0]), np.minimum(grid + period / 2, time[-1])
    sums = [np.interp(high, time, column) - np.interp(low, time, column) for column in whole.T]
    return np.asarray(np.column_stack(sums) / (high - low)[:, None])
