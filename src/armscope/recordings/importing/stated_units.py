"""Units as foreign tables state them: behind a column's name, in brackets, or in a line of their own below it."""

from __future__ import annotations

import re
import unicodedata

ANGLE_UNITS = {
    **dict.fromkeys(("rad", "rads", "radian", "radians"), "rad"),
    **dict.fromkeys(("deg", "degree", "degrees", "°", "grad", "grados", "degrés"), "deg"),
    **dict.fromkeys(("gon", "gons", "gradian", "gradians", "grade", "grades"), "gon"),
    **dict.fromkeys(("mrad", "milliradian", "milliradians"), "mrad"),
}
"""Grad is German for degrees (a gon is 0.9 of them: the comment says so)."""
LENGTH_UNITS = {
    **dict.fromkeys(("mm", "millimeters", "millimetres", "millimeter", "millimetre"), "mm"),
    **dict.fromkeys(("um", "µm", "micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres"), "um"),
    **dict.fromkeys(("cm", "centimeters", "centimetres", "centimeter", "centimetre"), "cm"),
    **dict.fromkeys(("m", "meters", "metres", "meter", "metre"), "m"),
    **dict.fromkeys(("in", "inch", "inches", "zoll"), "in"),
    **dict.fromkeys(("ft", "foot", "feet"), "ft"),
}
MOTION_ANGLES = {word: unit for word, unit in ANGLE_UNITS.items() if unit in ("rad", "deg")}
SPEED_UNITS = {f"{word}/{second}": f"{unit}/s" for word, unit in MOTION_ANGLES.items() for second in ("s", "sec")}
TORQUE_UNITS = dict.fromkeys(("nm", "n m", "n*m", "n·m", "n.m", "n-m"), "N m")
OTHER_UNITS = (*SPEED_UNITS, *TORQUE_UNITS, "s", "ms", "kg", "c", "°c", "degc")
NO_UNITS = (
    *("target", "cmd", "command", "commanded", "set", "setpoint", "desired", "nominal", "ref", "reference", "soll"),
    *("measured", "meas", "actual", "act", "ist", "tracker", "laser", "leica", "faro", "mcs", "tcp", "base", "robot"),
    *("world", "tool", "flange", "abs", "rel", "mean", "raw", "x", "y", "z"),
)
"""Words that stand in brackets behind a name and are none."""


def _plain(word: str) -> str:
    """As units are written above; of the two signs for micro, one."""
    return unicodedata.normalize("NFKC", word).replace("μ", "µ").replace("º", "°").lower().strip(" []()\"'")


def _at_end(name: str) -> str:
    found = re.search(r"[\s_.,/\-\[(]+\[?\(?([^\W\d_]+|°)[\])]?\s*$", name)
    return found[1] if found else ""


def _in_brackets(name: str) -> str:
    found = re.search(r"[\[({]([^\[\](){}]*)[\])}]\s*$", name)
    return "" if found is None or found[1].strip().isdigit() else found[1].strip()


def stated_unit(name: str, below: str, units: dict[str, str]) -> str | None:
    """What a column's name, or the line below it, says its unit is.

    Args:
        name: of the column, "X [mm]".
        below: the cell below the name in a line of units; "" where there is none.
        units: what mappings call each word.

    Returns:
        The unit; None where none of these is stated.
    """
    return next(
        (units[word] for word in map(_plain, (_in_brackets(name), _at_end(name), below)) if word in units), None
    )


def unknown_unit(name: str, below: str, units: dict[str, str]) -> str:
    """The word that stands where a column's unit does, and is none of those.

    Args:
        name: of the column, "X [furlong]".
        below: the cell below the name in a line of units; "" where there is none.
        units: what mappings call each word.

    Returns:
        The word; "" where a unit is stated, or nothing is.
    """
    if stated_unit(name, below, units) is not None:
        return ""
    words = (_in_brackets(name), below.strip())
    return next((word for word in words if _plain(word) and _plain(word) not in NO_UNITS), "")
