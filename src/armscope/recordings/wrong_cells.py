"""What stands in a cell where a number must, and how to mend it."""

from __future__ import annotations

import re

import numpy as np

from armscope.core.types import Array
from armscope.recordings.constants import POSSIBLE

_UNITS = r"mm|cm|m|rad|deg|°|s|kg|n ?m|°?c|degc|rad/s|-"
_IN_GENERAL = "Correct it, or remove the row."
_CURES = (
    (rf"[\[(]?({_UNITS})?[\])]?", "If this line holds units, remove it: a column's name says its unit."),
    (
        r"[-+]?\d{1,3}(['’ \u00a0\u202f_]\d{3})+([.,]\d+)?|[-+]?\d{1,3}(,\d{3})+\.\d+",
        "Write it without signs between thousands, and with a decimal point.",
    ),
    (r".*\0.*", "These are zero bytes, as a copy that was broken off leaves: save the table again."),
    (r"\d+\s*[°d]\s*\d+\s*['’′m].*", "Write degrees, minutes and seconds as one decimal number."),
    (r"['’`].*", "Remove the apostrophe, by which spreadsheets mark text."),
    (r".*(?![0-9])\d.*", "Write digits 0 to 9 of the narrow kind."),
    (r".*,.*", "Use a decimal point."),
    (r"[-+]?[\d.]+d[-+]?\d+", "Write the exponent with E."),
    (
        r"\d{1,2}[. -][a-z]{3}\.?|\d{1,2}[.-]\d{1,2}[.-](\d\d){1,2}|[a-z]{3}-\d\d",
        "A spreadsheet took a number for a date: give the column the format of numbers, and save it as CSV again.",
    ),
    (r"(\d{4}-\d\d-\d\d[t ])?\d{1,2}:\d\d.*", "Write seconds, from any start: from the first row, say."),
    (r"#.*", "A formula of the spreadsheet failed: correct it, or remove the row."),
    (
        r"[-+]?[\d.]+(e[-+]?\d+)?\s*[^\W\d_]+|[-+]?[\d.]+\s*[°%]",
        "Write the number alone: a column's name says its unit.",
    ),
    (r"[−–].*", "Write the minus as a hyphen (-)."),
)
"""What a word looks like, in small letters, and what to do about it; the first that fits."""


def how_to_mend(word: str, column: str) -> str:
    """How to mend a word that stands in a column where a number must."""
    if word == column:
        return "The header stands here a second time: remove this line."
    return next((cure for looks, cure in _CURES if re.fullmatch(looks, word, re.IGNORECASE | re.DOTALL)), _IN_GENERAL)


def how_to_scale(numbers: Array) -> str:
    """What to do about four numbers (4,) that are no quaternion of length 1."""
    length = f"Its length is {np.linalg.norm(numbers):.4g}"
    if np.abs(numbers).max() > POSSIBLE.unscaled:
        return f"{length}. Are these angles? `armscope import` reads Euler angles: its mapping says so."
    return f"{length}: divide all four by it." if numbers.any() else f"{length}: leave all four empty."
