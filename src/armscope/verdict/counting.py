"""Factors, odds and large numbers in words: by their digits as long as these say something."""

from __future__ import annotations

import math

from armscope.core.numerals import rounded
from armscope.verdict.constants import WORDS


def times(factor: float) -> str:
    """A factor before the word "times"; one beyond counting says that alone: what is left then is noise."""
    return "more than a thousand" if factor > WORDS.countable_times else rounded(factor)


def odds_in_words(nats: float) -> str:
    """Odds as a number to 1, of two digits; of what is beyond all doubt its size alone."""
    if nats >= WORDS.countable_odds:
        return "far beyond a thousand to 1"
    return f"{float(f'{math.exp(nats):.2g}'):.0f} to 1"


def with_prefix(value: float, unit: str) -> str:
    """Three significant digits and k, M or G before the unit."""
    for size, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= size:
            return f"{value / size:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"
