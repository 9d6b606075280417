"""Torque that is read late: at another moment than it acted, or through a low-pass that all of it passes."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.library.causes import Moment
from armscope.motion.library.dry_friction import seen_later
from armscope.motion.samples.constants import FILTER

LATE_BY_ORDER = {1: 1.0, 2: 2.0**0.5}
"""By how much a Butterworth low-pass of an order makes slow torque late, in units of one over its angular cut-off."""


def delayed(m: Moment, joints: tuple[int, ...], delay: float = 0.0) -> Array:
    """What a delay that joints have in common changes, per second of it: exactly at the delay, for none by the slope.

    Args:
        m: N samples.
        joints: from 0.
        delay: s.

    Returns:
        (N, joints, 1) N m/s (N/s).
    """
    return np.stack([_delayed_at(m, joint, delay) for joint in joints], axis=1)[:, :, None]


def _delayed_at(m: Moment, joint: int, delay: float) -> Array:
    torque = m.predicted[:, joint]
    if delay == 0:
        return np.asarray(-np.gradient(torque, 1 / m.rate))
    if m.dry is None:
        return (seen_later(m.signals.time, m.path, joint, delay) - torque) / delay
    return (m.dry.delayed(m.signals, m.path, joint, delay) - torque) / delay


def low_passed(m: Moment, joints: tuple[int, ...], order: float, delay: float) -> Array:
    """What a low-pass that joints have in common changes, per second by which it makes slow torque late.

    A delay moves a step of friction as a whole; a low-pass makes it a slope besides, and neither fits the other's.

    Args:
        m: N samples.
        joints: from 0.
        order: of a Butterworth low-pass, of `LATE_BY_ORDER`.
        delay: s; one that is not above zero, or whose cut-off is beyond what samples show, is a delay as it stands.

    Returns:
        (N, joints, 1) N m/s (N/s).
    """
    late = LATE_BY_ORDER[int(order)]
    if delay <= 0 or late / (2 * np.pi * delay) >= FILTER.nyquist * m.rate / 2:
        return delayed(m, joints, delay)
    from scipy.signal import butter, lfilter, lfilter_zi  # take long to import: most commands need none

    b, a = butter(int(order), late / delay, fs=2 * np.pi * m.rate)
    torque = m.predicted[:, list(joints)]
    passed, _ = lfilter(b, a, torque, axis=0, zi=lfilter_zi(b, a)[:, None] * torque[0])
    return np.asarray((passed - torque) / delay)[:, :, None]
