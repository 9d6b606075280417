"""How finely a table's angles are written: what is rounded moves the tool without anybody having commanded it."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.recordings.constants import READING


def angle_steps(motor_angles: Array) -> Array:
    """The decimal steps in which each motor's angles stand.

    A value that was rounded to a step lies anywhere within half of it: its error has step / sqrt(12) as standard
    deviation (uniform distribution).

    Args:
        motor_angles: (N, m) rad.

    Returns:
        (m,) rad: the largest of 1, 0.1, ... degrees or 0.1, 0.01, ... rad of which all values are multiples; 0 where
        there is none, or too few different values to tell.
    """
    return np.array([_step(np.unique(of_motor)) for of_motor in motor_angles.T])


def step_in_words(step: float) -> str:
    """A step (rad) in the unit that it is a decimal of, as the table was written: "0.1 degrees", "0.01 rad"."""
    in_radians = round(np.log10(step))
    if abs(step / 10.0**in_radians - 1) < READING.off_a_step:
        return f"{10.0**in_radians:g} rad"
    return f"{np.degrees(step):.3g} degrees"


def _step(values: Array) -> float:
    if len(values) < READING.fewest_values:
        return 0.0
    steps = [unit * 10.0**-decimals for unit in (np.pi / 180, 1.0) for decimals in range(READING.decimals + 1)]
    return max((step for step in steps if _are_multiples(values / step)), default=0.0)


def _are_multiples(in_steps: Array) -> bool:
    return bool(np.all(np.abs(in_steps - np.round(in_steps)) < READING.off_a_step * np.maximum(1.0, np.abs(in_steps))))
