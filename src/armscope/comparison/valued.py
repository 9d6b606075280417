"""A number that changed between recordings, with what the poses leave open of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from armscope.comparison.constants import COMPARING
from armscope.core.words import shown_unit
from armscope.physics.constants import PLAUSIBLE
from armscope.verdict.effects import INTERVAL
from armscope.verdict.wording import decimals_for

WHOLE_RANGE = {"m": PLAUSIBLE.length_m, "rad": PLAUSIBLE.zero_rad, "rad/rad": PLAUSIBLE.ratio}
"""What such a number is on arms at most: an interval that reaches as far says nothing."""


@dataclass(frozen=True)
class Valued:
    """A number in every recording, in its file unit, with standard errors; the change with its 95 % interval."""

    name: str
    unit: str
    values: tuple[float, ...]
    stderrs: tuple[float, ...]
    # since_first, since_first_stderrs: the same of its difference from the first recording, which is known far better
    # where all share what these poses leave open
    since_first: tuple[float, ...]
    since_first_stderrs: tuple[float, ...]
    difference: float  # with the change less without it
    interval_95: tuple[float, float]
    plausible: float = math.inf  # how large it is on arms

    @property
    def left_open(self) -> bool:
        """Whether the poses leave open how large it is in all recordings, though not how far it changed."""
        return max(map(abs, self.values)) < INTERVAL * min(self.stderrs)

    @property
    def unknown(self) -> bool:
        """Whether the poses leave open how far it changed, too: what is known is only how it moves beside others."""
        low, high = self.interval_95
        half = (high - low) / 2
        if not low < 0 < high:
            return False
        return half > COMPARING.beyond_all * self.plausible or (
            self.left_open and half > WHOLE_RANGE.get(self.unit, math.inf)
        )


def wave_part(name: str) -> str:
    """What "cosine_2" and "sine_rx" are; empty for other numbers."""
    part, _, of = name.partition("_")
    if part not in ("cosine", "sine"):
        return ""
    of = {"rx": "about x", "ry": "about y", "rz": "about z"}.get(of, f"{of} per turn" if of else "")
    return f"{part} part of the wave{', ' * bool(of)}{of}"


def number_line(number: Valued) -> str:
    """In words: before, after, and the change with its interval, as far as they are known."""
    name = wave_part(number.name) or number.name.replace("_", " ")
    if number.unknown:
        return f"{name}: these poses leave open what it is, and how far it changed"
    factor, unit = shown_unit(number.unit, max(map(abs, (*number.values, number.difference))))
    low, high = number.interval_95
    digits = decimals_for(factor * (high - low) / (2 * INTERVAL))

    def told(value: float) -> str:
        return f"{round(factor * value, digits) + 0.0:.{digits}f}"

    change = f"change {told(number.difference)} ({told(low)} ... {told(high)}) {unit}"
    if number.left_open:
        return f"{name}: {change}; how large it is in all of them, these poses leave open"
    values = " -> ".join(map(told, number.values))
    return f"{name}: {values} {unit}; {change}"
