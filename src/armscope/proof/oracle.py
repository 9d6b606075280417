"""One who knows which effect to test, where, and how: the best that any diagnosis could do in the same poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, isotonic_regression
from scipy.special import ncfdtr
from scipy.stats import f

from armscope.core.types import Array
from armscope.proof.definitions import FALSE_ALARMS_OF_ORACLE, RELIABLE

REPEATS = 400


def power(noncentrality: float, columns: int, rows: int, frame_numbers: int) -> float:
    """Chance that an F test of ``columns`` numbers at 1 % false alarms finds an effect in ``rows`` measured points.

    The oracle fits free frames of ``frame_numbers`` numbers, too, those of any diagnosis: a base (6) in each run that
    the table tells apart, and a tool point (3).

    Args:
        noncentrality: the effect's squared size in units of the noise.
        columns: its numbers.
        rows: measured points, of three coordinates each.
        frame_numbers: free numbers of base and tool.

    Returns:
        The chance, 0 ... 1.
    """
    freedom = 3 * rows - frame_numbers - columns
    critical = f.isf(FALSE_ALARMS_OF_ORACLE, columns, freedom)
    return float(1 - ncfdtr(columns, freedom, noncentrality, critical))


def reliable_noncentrality(columns: int, rows: int, frame_numbers: int) -> float:
    """The noncentrality at which the oracle finds the effect in the share `RELIABLE` of cases.

    Args:
        columns: the effect's numbers.
        rows: measured points.
        frame_numbers: free numbers of base and tool.

    Returns:
        The noncentrality.
    """
    return float(brentq(lambda value: power(value, columns, rows, frame_numbers) - RELIABLE, 1e-3, 1e3))


def size_in_thresholds(noncentrality: float, columns: int, rows: int, frame_numbers: int) -> float:
    """An effect's size in multiples of the size at which the oracle finds it in nine of ten cases.

    Args:
        noncentrality: the effect's squared size in units of the noise.
        columns: its numbers.
        rows: measured points.
        frame_numbers: free numbers of base and tool.

    Returns:
        1 where the oracle just finds it reliably.
    """
    return float(np.sqrt(noncentrality / reliable_noncentrality(columns, rows, frame_numbers)))


@dataclass(frozen=True)
class Threshold:
    """The size at which a share of cases is found, with a bootstrap 95 % interval; NaN if the cases don't tell."""

    value: float
    low: float
    high: float
    cases: int


def threshold(size: Array, found: NDArray[np.bool_], share: float, rng: np.random.Generator) -> Threshold:
    """The size from which that share is found, by the monotone curve that fits the cases best (isotonic regression).

    Args:
        size: (K,) sizes of the cases, any unit.
        found: (K,) whether each was found.
        share: where to read it off, 0 ... 1.
        rng: of the bootstrap over cases.

    Returns:
        The size with its 95 % interval, and how many cases it rests on.
    """
    if len(size) < 10 or found.all() or not found.any():
        return Threshold(float("nan"), float("nan"), float("nan"), len(size))
    draws = (rng.integers(0, len(size), len(size)) for _ in range(REPEATS))
    values = [_read_off(size[rows], found[rows], share) for rows in draws]
    low, high = np.quantile(values, (0.025, 0.975), method="inverted_cdf")
    return Threshold(_read_off(size, found, share), float(low), float(high), len(size))


def _read_off(size: Array, found: NDArray[np.bool_], share: float) -> float:
    """Infinite where the curve never gets there; cases of one size count together, in whatever order they come."""
    sizes, at, cases = np.unique(size, return_inverse=True, return_counts=True)
    curve = isotonic_regression(np.bincount(at, found) / cases, weights=cases).x
    reached = np.flatnonzero(curve >= share - 1e-12)
    return float(sizes[reached[0]]) if len(reached) else float("inf")
