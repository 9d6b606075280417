"""What a parallelogram says of its bars."""

from __future__ import annotations

from armscope.physics.clause import CLEAR, Told

BARS = ("rocker", "rod")
"""Those of which errors show, the parameters' names."""
OF_WHAT = "of the rocker's length"
"""What errors without a unit are shares of: both bars', where no lengths are stated."""


def bars_differ(told: Told) -> str:
    """Of the bars those whose errors stand out of their uncertainty, or else the one that is off most.

    Raises:
        KeyError: no number is told.
    """
    known = {bar: told.numbers[bar] for bar in BARS if bar in told.numbers}
    largest = max(known, key=lambda bar: abs(known[bar].value), default=BARS[0])
    off = [f"{bar} by {p:+}" for bar, p in known.items() if bar == largest or abs(p.value) > CLEAR * p.stderr]
    of_what = f" {OF_WHAT}" if known[largest].unit == "m/m" else ""
    return f"the parallelogram's bars differ: {' and '.join(off)}{of_what}"
