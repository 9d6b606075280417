"""Colours of the pages, light or dark; every kind of colour vision tells them apart.

A drawing names a variable of the page's style sheet and, for readers outside it, the colour on a light page.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

SHARES = (
    "#fffbf0", "#fcecae", "#fed89a", "#fec488", "#feb27a", "#fe9d6c", "#fc8a62", "#f8765c", "#f2645c", "#e85362",
    "#d9466b", "#ca3e72", "#ba3878", "#a8327d", "#962c80", "#842681", "#762181", "#651a80", "#54137d", "#420f75",
    "#331067",
)  # fmt: skip
"""Light to dark, even in lightness: magma (matplotlib, CC0) without its black end."""
SIGNED = ("#003d61", "#00588a", "#0172b2", "#67a2c4", "#cbd0d4", "#d09669", "#d45d00", "#a04600", "#6e3000")
"""Below and above nothing: blue, grey, vermilion."""
INK, QUIET, LINE, PAPER = "var(--ink, #1b1f24)", "var(--quiet, #5c6670)", "var(--line, #d9dee3)", "var(--paper, #fff)"
OUTLINE, UNTOUCHED = "var(--outline, #3a424a)", "var(--untouched, #e4e8ec)"
BEFORE, AFTER, GOOD = "var(--before, #d55e00)", "var(--after, #0072b2)", "var(--noise, #00795a)"
PALE, GAIN, LOSS, OTHERS = (
    "var(--pale, #cfe6f5)", "var(--gain, #56b4e9)", "var(--loss, #e69f00)", "var(--others, #c9cfd5)",
)  # fmt: skip
MEASURED = "var(--measured, #a9b2ba)"
"""A broad band below thin lines: they are seen on it, on light and on dark pages."""
NOTHING = "#e4e8ec"
"""A place without a share, where a variable can't be named."""


class Key(NamedTuple):
    """What a colour of a drawing stands for, told in the colour itself."""

    colour: str
    words: str
    look: Literal["", "wide", "dashed", "dots"] = ""


def share_level(part: float) -> int:
    """The step of the scale for a part (0 ... 1) of its end."""
    return min(max(round(part * (len(SHARES) - 1)), 0), len(SHARES) - 1)


def share_colour(part: float) -> str:
    """The colour for a part (0 ... 1) of the scale's end."""
    level = share_level(part)
    return f"var(--s{level}, {SHARES[level]})"


def scale_end(share: float) -> float:
    """The end of a scale of shares: the next of 5, 10, 20, 40, 60, 80, 100 %."""
    if share <= 0:
        return 0.0
    return next((step for step in (0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0) if share <= step), share)


def between(stops: Sequence[str], part: float) -> str:
    """The colour at a part (0 ... 1) of the way along colours given as #rrggbb."""
    place = min(max(part, 0.0), 1.0) * (len(stops) - 1)
    left = min(int(place), len(stops) - 2)
    ends = [[int(stops[n][at : at + 2], 16) for at in (1, 3, 5)] for n in (left, left + 1)]
    mixed = [round(a + (place - left) * (b - a)) for a, b in zip(*ends, strict=True)]
    return "#" + "".join(f"{value:02x}" for value in mixed)


def darker(colour: str) -> str:
    """A side that faces away from the light, for #rrggbb."""
    return between(("#000000", colour), 0.78)


def page_variables() -> str:
    """The scale's steps as CSS variables: one order on light and dark pages, which show what has it on a light ground.

    Captions say which end is large, and the error field beside has the same scale; turned round on a dark page it
    would say the opposite of both.
    """
    return f":root {{ {'; '.join(f'--s{n}: {colour}' for n, colour in enumerate(SHARES))}; }}"
