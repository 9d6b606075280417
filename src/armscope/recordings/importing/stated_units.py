"""Units as foreign tables state them: behind a column's name, in brackets, or in a line of their own below it."""

from __future__ import annotations

import re

ANGLE_UNITS = {
    "rad": "rad",
    "radians": "rad",
    "deg": "deg",
    "degree": "deg",
    "degrees": "deg",
    "°": "deg",
    "grad": "deg",
}
"""Grad is German for degrees (a gon is 0.9 of them: the comment says so)."""
LENGTH_UNITS = {
    "mm": "mm",
    "millimeters": "mm",
    "millimetres": "mm",
    "cm": "cm",
    "m": "m",
    "meters": "m",
    "metres": "m",
    "in": "in",
    "inch": "in",
    "inches": "in",
    "zoll": "in",
}
OTHER_UNITS = ("rad/s", "deg/s", "nm", "n m", "s", "ms", "kg", "c", "°c", "degc")


def stated_unit(name: str, below: str, units: dict[str, str]) -> str | None:
    """What a column's name, or the line below it, says its unit is.

    Args:
        name: of the column, "X [mm]".
        below: the cell below the name in a line of units; "" where there is none.
        units: what mappings call each word.

    Returns:
        The unit; None where none of these is stated.
    """
    found = re.search(r"[\s_.\-\[(]+\[?\(?([A-Za-z°]+)[\])]?\s*$", name)
    word = found[1].lower() if found else ""
    return units.get(word) or units.get(below.lower().strip(" []()"))
