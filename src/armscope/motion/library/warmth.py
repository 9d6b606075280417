"""Friction that changes as gears warm up: with the temperature that was recorded, or while the arm runs."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment

RUNNING = ("speed while running", "side while running")
"""Laws of how long the arm has run, which is known of the motion alone to which they were fitted."""


def is_while_running(law: object) -> bool:
    """Whether a cause's columns follow how long the arm has run."""
    return getattr(law, "kind", "") in RUNNING


def warmth(m: Moment, joint: int) -> Array:
    """(N,) deg C of a joint; whoever uses a law of it has made sure that it is recorded."""
    assert m.signals.temperature is not None
    return m.signals.temperature[:, joint]


def warm(m: Moment, joint: int, friction: Array, middle: float, constant: float = 0.0) -> Array:
    """Friction times the kelvin above the middle of those that were recorded.

    Args:
        m: N samples.
        joint: from 0.
        friction: (N,) per unit of its number.
        middle: deg C.
        constant: 1 adds what friction is off at the middle, too: nobody knows at which temperature it was stated.

    Returns:
        (N,), or (N, 2) with the constant.
    """
    return _beside_constant((warmth(m, joint) - middle) * friction, friction, constant)


def while_running(m: Moment, joint: int, friction: Array, middle: float, constant: float = 0.0) -> Array:
    """Friction times the minutes since the middle of what was recorded; as at its end where nobody knows them.

    An arm in use is warm.

    Args:
        m: N samples.
        joint: from 0.
        friction: (N,) per unit of its number.
        middle: min.
        constant: as in `warm`.

    Returns:
        (N,), or (N, 2) with the constant.
    """
    minutes = np.full(len(friction), 2 * middle) if m.signals.running is None else m.signals.running / 60
    return _beside_constant((minutes - middle) * friction, friction, constant)


def _beside_constant(changing: Array, friction: Array, constant: float) -> Array:
    return np.column_stack([changing, friction]) if constant else changing
