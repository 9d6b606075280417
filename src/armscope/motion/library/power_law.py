"""A power of the speed, and the ordinary friction that is nearest to it."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array


def power_of_speed(speed: Array, width: float, power: float) -> Array:
    """A power of the speed; below the speed over which friction changes sides it is what it is there.

    A root of the speed, steep at rest, would else be told where friction changes sides in another way than the model's.

    Args:
        speed: (N,) rad/s.
        width: speed over which friction changes sides, rad/s.
        power: of the speed.

    Returns:
        (N,), above zero.
    """
    return np.asarray(np.maximum(np.abs(speed), width) ** power)


def nearest_ordinary(width: float, power: float, viscous: float, dry: float, *speeds: float) -> Array:
    """Viscous and dry friction that are nearest to a power of the speed.

    Args:
        width: speed over which friction changes sides, rad/s.
        power: of the speed.
        viscous, dry: 1 where it is fitted; of one that is stated the power takes nothing off, or a curve alone would be
            told as a curve and two departures from what is stated.
        speeds: rad/s, at which they are the nearest.

    Returns:
        (2,) of a power that is 1 N m at 1 rad/s.
    """
    at = np.array(speeds)
    ordinary = np.column_stack([viscous * at, np.full_like(at, dry)])
    return np.asarray(np.linalg.lstsq(ordinary, power_of_speed(at, width, power), rcond=None)[0])
