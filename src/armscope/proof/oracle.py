"""One who knows which effect to test, where, and how: the best that any diagnosis could do in the same poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize
from scipy.special import expit, ncfdtr
from scipy.stats import f

from armscope.proof.definitions import FALSE_ALARMS_OF_ORACLE, RELIABLE

Array = NDArray[np.float64]

FRAME_NUMBERS = 9
"""Base (6) and tool point (3), which the oracle fits, too."""
REPEATS = 400
LARGEST_EXPONENT = 20.0


def power(noncentrality: float, columns: int, rows: int) -> float:
    """Chance that an F test of ``columns`` numbers at 1 % false alarms finds an effect in ``rows`` measured points."""
    freedom = 3 * rows - FRAME_NUMBERS - columns
    critical = f.isf(FALSE_ALARMS_OF_ORACLE, columns, freedom)
    return float(1 - ncfdtr(columns, freedom, noncentrality, critical))


def reliable_noncentrality(columns: int, rows: int, share: float = RELIABLE) -> float:
    """The noncentrality at which the oracle finds the effect in that ``share`` of cases."""
    return float(brentq(lambda value: power(value, columns, rows) - share, 1e-3, 1e3))


def size_in_thresholds(noncentrality: float, columns: int, rows: int) -> float:
    """An effect's size in multiples of the size at which the oracle finds it in nine of ten cases."""
    return float(np.sqrt(noncentrality / reliable_noncentrality(columns, rows)))


@dataclass(frozen=True)
class Threshold:
    """The size at which a share of cases is found, with a bootstrap 95 % interval; NaN if the cases don't tell."""

    value: float
    low: float
    high: float
    cases: int


def threshold(size: Array, found: NDArray[np.bool_], share: float, rng: np.random.Generator) -> Threshold:
    """Fit found = logistic(a + b log size) by maximum likelihood and read it off at ``share``.

    Args:
        size: (K,) sizes of the cases, any unit.
        found: (K,) whether each was found.
        share: where to read it off, 0 ... 1.
        rng: of the bootstrap over cases.
    """
    if len(size) < 10 or found.all() or not found.any():
        return Threshold(float("nan"), float("nan"), float("nan"), len(size))
    x, y = np.log(size), found.astype(float)
    draws = [rng.integers(0, len(x), len(x)) for _ in range(REPEATS)]
    values = [_read_off(*_logistic(x[rows], y[rows]), share) for rows in draws if 0 < y[rows].mean() < 1]
    low, high = np.quantile(values, (0.025, 0.975), method="inverted_cdf")
    return Threshold(_read_off(*_logistic(x, y), share), float(low), float(high), len(size))


def _logistic(x: Array, y: Array) -> tuple[float, float]:
    """Intercept and slope by maximum likelihood, the slope held in by a weak prior where the cases separate."""

    def loss(parameters: Array) -> tuple[float, Array]:
        a, b = parameters
        z = a + b * x
        rest = expit(z) - y
        weak = 1e-3
        value = float(np.sum(np.logaddexp(0, z) - y * z) + weak * b**2 / 2)
        return value, np.array([rest.sum(), rest @ x + weak * b])

    fit = minimize(loss, np.array([0.0, 1.0]), jac=True, method="BFGS")
    return float(fit.x[0]), float(fit.x[1])


def _read_off(intercept: float, slope: float, share: float) -> float:
    """Infinite where the curve never gets there."""
    exponent = (np.log(share / (1 - share)) - intercept) / slope if slope > 0 else np.inf
    return float(np.exp(exponent)) if exponent < LARGEST_EXPONENT else float("inf")
