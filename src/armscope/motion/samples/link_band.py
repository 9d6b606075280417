"""Up to which frequency a link's encoder beside its motor's tells how the link moves, and from where on it tells noise.

What a link does beside its motor is small, and derived twice before it counts: an encoder's noise of 20 µrad, taken for
motion up to 14 Hz, is 2 N m of a link of 60 kg m^2.
"""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.samples.constants import CUTOFF


def link_bands(beside: Array, rate: float) -> Array:
    """The cut-off of each link's place beside its motor.

    Args:
        beside: (N, m) link less motor, rad or m; NaN of joints without such an encoder.
        rate: samples per second.

    Returns:
        (m,) Hz: `CUTOFF.beyond_motion` times where the spectrum comes down to that of the highest frequencies; 0 where
        it never leaves it, and the link can only be taken to move as its motor does.
    """
    from scipy.signal import detrend, welch  # takes long to import: most tables have no such links

    bands = np.zeros(beside.shape[1])
    for j in np.flatnonzero(np.isfinite(beside).all(axis=0)):
        steady = detrend(beside[:, j])
        frequency, power = welch(steady, rate, nperseg=min(len(beside), CUTOFF.window))
        seen = np.flatnonzero(power[1:] > CUTOFF.above_noise * np.median(power[-len(power) // 4 :]))
        bands[j] = CUTOFF.beyond_motion * frequency[1 + seen[-1]] if len(seen) else 0.0
    return bands
