"""Bad shots: rows whose residual lies far beyond the others' are weighted down and listed, never dropped."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from armscope.core.types import Array
from armscope.measurement.constants import WEIGHTS

Rule = Callable[[Array, Array, float], Array]
"""(N,) weights of residuals (N, c), by their relative uncertainty (N,) and the least noise."""


def scale_of(residuals: Array, least: float = 0.0) -> float:
    """Noise per axis from the median length of residuals (N, c), at least ``least``."""
    median = _median_length(residuals.shape[1])
    return max(float(np.median(np.linalg.norm(residuals, axis=1))) / median, least, 1e-9)


@functools.cache
def _median_length(width: int) -> float:
    """Median length of a vector of so many unit normals."""
    from scipy.special import gammaincinv  # slow to import: a table that is refused needs none

    return float(np.sqrt(2 * gammaincinv(width / 2, 0.5)))


@functools.cache
def tuning_constant(width: int) -> float:
    """`WEIGHTS.tuning_constant` for rows of so many numbers: as many clean rows lie beyond."""
    if width == 3:
        return WEIGHTS.tuning_constant
    from scipy.special import gammaincc, gammainccinv  # as above

    beyond = float(gammaincc(1.5, WEIGHTS.tuning_constant**2 / 2))  # the share of clean rows farther away
    return float(np.sqrt(2 * gammainccinv(width / 2, beyond)))


def huber_weights(residuals: Array, uncertainty: Array, least: float) -> Array:
    """(N,) weights while structure may still be in the residuals: Huber's, so that nothing is silenced yet.

    Args:
        residuals: (N, 3).
        uncertainty: (N,) relative stated uncertainty of the rows (1 where not stated).
        least: the noise is not taken to be below this.

    Returns:
        (N,), 1 for a clean row of usual uncertainty.
    """
    far = _distance(residuals, uncertainty, least)
    return np.minimum(1.0, tuning_constant(residuals.shape[1]) / far) / uncertainty**2


def quartic_weights(residuals: Array, uncertainty: Array, least: float) -> Array:
    """(N,) weights against the fitted model: 1 up to `tuning_constant` scales, then falling with the fourth power.

    Args:
        residuals: (N, c).
        uncertainty: (N,) relative stated uncertainty of the rows (1 where not stated).
        least: the noise is not taken to be below this.

    Returns:
        (N,), 1 for a clean row of usual uncertainty.
    """
    far = _distance(residuals, uncertainty, least)
    return np.minimum(1.0, tuning_constant(residuals.shape[1]) / far) ** 4 / uncertainty**2


def _distance(residuals: Array, uncertainty: Array, least: float) -> Array:
    relative = residuals / uncertainty[:, None]
    return np.asarray(np.maximum(np.linalg.norm(relative, axis=1) / scale_of(relative, least), 1e-12))
