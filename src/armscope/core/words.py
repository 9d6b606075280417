"""Words in a row, numbers and units as people in the field say them, and tables in Markdown."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence


def enumerated(words: Sequence[str], last: str = "and") -> str:
    """ "one, two and three"."""
    return f" {last} ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else "".join(words)


def uncapitalised(text: str) -> str:
    """With a small first letter, unless it begins with a name."""
    return f"{text[:1].lower() if text[1:2].islower() else text[:1]}{text[1:]}"


def table_lines(head: Sequence[str], rows: Iterable[Iterable[object]]) -> list[str]:
    """A table, line by line."""
    return [_line(head), f"|{'---|' * len(head)}", *map(_line, rows)]


def _line(cells: Iterable[object]) -> str:
    return "|" + "".join(f" {cell} |" if cell != "" else " |" for cell in cells)


UNITS: dict[str, tuple[tuple[float, float, str], ...]] = {
    # file unit: (from this size on, shown per file unit, shown unit), largest first
    "rad": ((5e-4, 1e3, "mrad"), (0.0, 1e6, "µrad")),
    "rad/(N m)": ((1e-3, 1e3, "mrad per N m"), (0.0, 1e6, "µrad per N m")),
    "m/(N m)": ((0.0, 1e6, "µm per N m"),),
    "rad/(N m K)": ((1e-3, 1e3, "mrad per N m and K"), (0.0, 1e6, "µrad per N m and K")),
    "rad/(m/s^2)": ((1e-3, 1e3, "mrad per m/s²"), (0.0, 1e6, "µrad per m/s²")),
    "rad/rad": ((1e-3, 1e3, "mrad per rad"), (0.0, 1e6, "µrad per rad")),
    "rad/K": ((1e-3, 1e3, "mrad per K"), (0.0, 1e6, "µrad per K")),
    "rad/h": ((1e-3, 1e3, "mrad per hour"), (0.0, 1e6, "µrad per hour")),
    "mm/h": ((0.1, 1.0, "mm per hour"), (0.0, 1e3, "µm per hour")),
    "m/m": ((0.0, 1e6, "millionths (ppm)"),),
    "1/K": ((0.0, 1e6, "millionths per K"),),
    "1/(N m^2)": ((0.0, 1e6, "per MN m²"),),
    "mm": ((0.1, 1.0, "mm"), (0.0, 1e3, "µm")),
    "s": ((1.0, 1.0, "s"), (0.0, 1e3, "ms")),
    "1/turn": ((0.0, 1.0, "per turn"),),
    "kg": ((0.0, 1.0, "kg"),),
    "deg": ((0.0, 1.0, "°"),),
    "m": ((1e-4, 1e3, "mm"), (0.0, 1e6, "µm")),
}
"""Units of the files, and what they become in a text."""


def shown_unit(unit: str, size: float) -> tuple[float, str]:
    """(factor, unit) in which a number of that size, given in a file unit, is shown."""
    for least, factor, shown in UNITS.get(unit, ()):
        if size >= least:
            return factor, shown
    return 1.0, unit.replace("^2", "²").replace("^3", "³")


def rounded(value: float) -> str:
    """Two significant digits without an exponent; whole numbers from 10 on."""
    if not math.isfinite(value) or value == 0:
        return "0" if value == 0 else "–"
    decimals = max(0, 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{min(decimals, 6)}f}"


def or_less(value: float, digits: int = 2) -> str:
    """Some digits of an error in mm; what has converged is not told to the last bit."""
    return f"{value:.{digits}g}" if value >= 1e-3 else "below 0.001"


def size_of(value: float, unit: str, sign: bool = False) -> str:
    """A number's size in the field's unit, for a sentence.

    Args:
        value: in a unit of the files.
        unit: that unit.
        sign: whether its sign is said, too.

    Returns:
        Two significant digits and the unit.
    """
    factor, shown = shown_unit(unit, abs(value))
    plus = ("+" if value > 0 else "−") if sign else ""
    return f"{plus}{rounded(factor * abs(value))} {shown}"
