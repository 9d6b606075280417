"""Friction that grows with a power of the speed: the powers that compete, and closer ones about one that was chosen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from armscope.motion.constants import LIBRARY
from armscope.motion.library.causes import PlacedCause
from armscope.motion.library.laws import Law

_BOUNDS = (LIBRARY.powers[0] ** 2 / LIBRARY.powers[1], *LIBRARY.powers, LIBRARY.powers[-1] ** 2 / LIBRARY.powers[-2], 1)
"""Powers, those beyond their ends, and the first, which is viscous friction and no curve."""


def with_power(cause: PlacedCause, power: float, sliding: bool) -> PlacedCause:
    """Friction at a joint that grows with another power of its speed.

    Args:
        cause: with any power.
        power: the other one.
        sliding: whether the joint is prismatic.

    Returns:
        The same with that power, in its unit.
    """
    assert isinstance(cause.columns, Law)
    width, _, *rest = cause.columns.numbers
    torque, of_position = ("N", "m") if sliding else ("N m", "rad")
    return replace(
        cause,
        parameters=(("bent", f"{torque} s^{power:.3g}/{of_position}^{power:.3g}"), *cause.parameters[1:]),
        columns=replace(cause.columns, numbers=(width, power, *rest)),
        scanned=(("power", "", power),),
        variant=f"{power:.3g}",
    )


def closer(chosen: PlacedCause, others: Mapping[int, PlacedCause], sliding: bool) -> dict[int, PlacedCause]:
    """Powers at a joint about one that was chosen, half the way to those that were scanned beside it.

    Args:
        chosen: with its power.
        others: by their numbers, those that were not chosen at the joint.
        sliding: whether the joint is prismatic.

    Returns:
        The others with closer powers; none where they are close.
    """
    power = chosen.scanned[0][2]
    nearest = min(abs(np.log(each.scanned[0][2] / power)) for each in others.values())
    if nearest < LIBRARY.close_powers:
        return {}
    below, above = max(b for b in _BOUNDS if b < power), min(b for b in _BOUNDS if b > power)
    return _spread(others, float(np.sqrt(below * power)), float(np.sqrt(above * power)), sliding)


def opposite(chosen: PlacedCause, others: Mapping[int, PlacedCause], sliding: bool) -> dict[int, PlacedCause]:
    """Powers on the other side of the first, for one that was chosen as what drives.

    Friction that grows less than the speed looks like a square below zero, and is no such thing.

    Args:
        chosen: with its power.
        others: by their numbers, those that were not chosen at the joint.
        sliding: whether the joint is prismatic.

    Returns:
        The others with powers of that side; none where they are there.
    """
    above = chosen.scanned[0][2] < 1
    if all((each.scanned[0][2] > 1) == above for each in others.values()):
        return {}
    those = [power for power in LIBRARY.powers if (power > 1) == above]
    return _spread(others, min(those), max(those), sliding)


def _spread(causes: Mapping[int, PlacedCause], least: float, most: float, sliding: bool) -> dict[int, PlacedCause]:
    powers = np.geomspace(least, most, len(causes))
    return {n: with_power(each, float(p), sliding) for (n, each), p in zip(causes.items(), powers, strict=True)}
