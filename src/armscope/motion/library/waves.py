"""Waves of a joint's angle, where samples show them.

A wave that passes faster than half the samples' rate would come back as a slow one, which the torque has not.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.samples.preparation import Signals


def wave(signals: Signals, joint: int, count: float) -> Array:
    """Sine and cosine of a joint's angle times a count.

    Args:
        signals: N samples.
        joint: from 0.
        count: waves per turn.

    Returns:
        (N, 2).
    """
    turned = count * signals.q[:, joint]
    return np.column_stack([np.sin(turned), np.cos(turned)]) * _shown(signals, joint, np.array([count]))


def fewest_waves(turns: float) -> int:
    """Per turn, that a joint shows whose range is so many turns: with fewer a wave is no more than a bend."""
    return max(2, int(np.ceil(LIBRARY.least_waves / max(turns, 1e-9))))


def most_waves(turns: float, knots: float) -> float:
    """Per turn, that a cubic spline with so many columns over a range of so many turns can follow.

    Its slope has a column less, and changes its sign less often than that by one (variation diminishes); a wave's does
    so twice.
    """
    return (knots - 2) / 2 / max(turns, 1e-9)


def successive_waves(signals: Signals, joint: int, first: int, number: int) -> Array:
    """As `wave` has them of successive counts, each from the one before, which takes an eighth of the time.

    Args:
        signals: N samples.
        joint: from 0.
        first: count, waves per turn.
        number: of counts.

    Returns:
        (N, number, 2).
    """
    angle, waves = signals.q[:, joint], np.empty((len(signals.q), number, 2))
    now, further = np.exp(1j * first * angle), np.exp(1j * angle)
    for k in range(number):
        waves[:, k, 0], waves[:, k, 1] = now.imag, now.real
        now = now * further
    return waves * _shown(signals, joint, first + np.arange(number))[:, :, None]


def _shown(signals: Signals, joint: int, counts: Array | NDArray[np.int_]) -> NDArray[np.bool_]:
    """(N, C) which samples show waves of (C,) counts."""
    return np.abs(signals.dq[:, joint])[:, None] * counts * signals.period < np.pi
