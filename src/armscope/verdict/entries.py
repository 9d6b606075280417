"""Numbers as they are entered into a controller: with a sign, a 95 % interval, and no digit that means nothing."""

from __future__ import annotations

import math

from armscope.verdict.effects import INTERVAL
from armscope.verdict.wording import decimals_for

DECIMALS = {"mm": (2, 3), "mrad": (2, 3), "°": (3, 4)}
"""Fewest and most decimals of an entry. The fewest shift the tool by 0.01 mm at most, a metre away: numbers that are
known only together (two parallel axes' d, say) are entered together, and must not be rounded as each alone could be."""


def entry_decimals(unit: str, stderr: float) -> int:
    """Decimals of a number whose standard error, in its unit, is known, or is not (NaN)."""
    fewest, most = DECIMALS[unit]
    return most if not stderr > 0 else min(max(decimals_for(stderr), fewest), most)


def angle(radians: float, stderr: float = math.nan) -> str:
    """An angle with its sign in degrees and mrad, and its interval: "−0.178° (−3.10 mrad ± 0.10)"."""
    degrees = with_sign(math.degrees(radians), entry_decimals("°", math.degrees(stderr)))
    return f"{degrees}° ({_with_interval(1e3 * radians, 1e3 * stderr, 'mrad')})"


def length(mm: float, stderr: float = math.nan) -> str:
    """A length with its sign, and its interval: "+0.595 mm (± 0.018)"."""
    told, beside, interval = _with_interval(mm, stderr, "mm").partition(" ±")
    return f"{told} (±{interval})" if beside else told


def with_sign(value: float, decimals: int) -> str:
    """A number with its sign, so many decimals."""
    text = f"{value:+.{decimals}f}"
    return (text if float(text) else text[1:]).replace("-", "−")


def _with_interval(value: float, stderr: float, unit: str) -> str:
    decimals = entry_decimals(unit, stderr)
    half = f" ± {INTERVAL * stderr:.{decimals}f}" if stderr > 0 else ""
    return f"{with_sign(value, decimals)} {unit}{half}"
