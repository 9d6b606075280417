"""By how much all links grow with temperature, of the small errors that have no name: as a formula with its number."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.words import size_of
from armscope.physics.effect import Part
from armscope.physics.thermal import THERMAL_EXPANSION

WHOLE_ARM = "arm"


def growth_in_words(background: Sequence[Part]) -> str:
    """The formula by which all links of an arm are scaled: one number for all, weighed by their lengths. Returns a
    sentence or two; "" where the links do not grow."""
    grown = _by_link(background)
    if not grown:
        return ""
    coefficients, lengths = np.array(list(grown.values())).T
    mean = float(np.average(coefficients, weights=lengths))
    told = f"length = stated length x (1 + coefficient x (temperature - 20 C)). Here coefficient = {_told(mean)}"
    lowest, highest = float(coefficients.min()), float(coefficients.max())
    apart = _told(lowest) != _told(highest)
    return f"{told}, the mean by length (link by link {_told(lowest)} to {_told(highest)})." if apart else f"{told}."


def _by_link(background: Sequence[Part]) -> dict[str, tuple[float, float]]:
    """By link what it grows by, 1/K, as one of all and by itself, and its length, m."""
    growing = [part for part in background if part.placed.effect is THERMAL_EXPANSION]
    if not any(part.values.any() for part in growing):
        return {}
    alike = sum(float(part.values[0]) for part in growing if part.placed.location == WHOLE_ARM)
    return {
        part.placed.location: (
            alike + float(part.values[0]),
            sum(abs(product.factor) for product in part.placed.terms[0].products),
        )
        for part in growing
        if part.placed.location != WHOLE_ARM
    }


def _told(coefficient: float) -> str:
    return size_of(coefficient, "1/K", sign=coefficient < 0)
