"""Bad shots: rows whose residual lies far beyond the others' are weighted down and listed, never dropped."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from armscope.core.types import Array

Rule = Callable[[Array, Array, float], Array]
"""(N,) weights of residuals (N, 3), by their relative uncertainty (N,) and the least noise."""

MEDIAN_OF_CHI3 = 1.5381722
"""Median length of a 3-vector of unit normals."""
TUNING_CONSTANT = 4.5
"""Scales beyond which a row is weighted down: one clean row in 6000."""
SUSPECT_WEIGHT = 0.5


def scale_of(residuals: Array, least: float = 0.0) -> float:
    """Noise per axis from the median length of residuals (N, 3), at least ``least``."""
    return max(float(np.median(np.linalg.norm(residuals, axis=1))) / MEDIAN_OF_CHI3, least, 1e-9)


def huber_weights(residuals: Array, uncertainty: Array, least: float) -> Array:
    """(N,) weights while structure may still be in the residuals: Huber's, so that nothing is silenced yet."""
    far = _distance(residuals, uncertainty, least)
    return np.minimum(1.0, TUNING_CONSTANT / far) / uncertainty**2


def quartic_weights(residuals: Array, uncertainty: Array, least: float) -> Array:
    """(N,) weights against the fitted model: 1 up to `TUNING_CONSTANT` scales, then falling with the fourth power.

    Args:
        residuals: (N, 3).
        uncertainty: (N,) relative stated uncertainty of the rows (1 where not stated).
        least: the noise is not taken to be below this.
    """
    far = _distance(residuals, uncertainty, least)
    return np.minimum(1.0, TUNING_CONSTANT / far) ** 4 / uncertainty**2


def _distance(residuals: Array, uncertainty: Array, least: float) -> Array:
    relative = residuals / uncertainty[:, None]
    return np.asarray(np.maximum(np.linalg.norm(relative, axis=1) / scale_of(relative, least), 1e-12))
