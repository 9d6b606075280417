"""Which way a joint moves, -1 ... 1, and how slowly it must move for that to be in between."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.samples.constants import FILTER
from armscope.motion.samples.preparation import Signals
from armscope.robot.dynamics import MovingArm


def side(signals: Signals, width: Array) -> Array:
    """(N, m) side of the motion, -1 ... 1, as the mean over each sample's time.

    tanh(speed / width), integrated over a sample in which the acceleration stays: where a joint turns back it crosses
    the width within less than a sample, and where it did so is what the torque holds.
    """
    low, high = signals.dq - signals.ddq * signals.period / 2, signals.dq + signals.ddq * signals.period / 2
    found, width = np.sign(signals.dq), np.broadcast_to(width, signals.dq.shape)
    near = np.nonzero((np.minimum(np.abs(low), np.abs(high)) / width < FILTER.one_side) | (low * high <= 0))
    low, high, width = low[near], high[near], width[near]  # elsewhere it is 1 to all digits
    across = np.abs(high - low) > FILTER.alike * width
    mean = (_log_cosh(high / width) - _log_cosh(low / width)) * width / np.where(across, high - low, 1.0)
    found[near] = np.where(across, mean, np.tanh(signals.dq[near] / width))
    return np.asarray(found)


def _log_cosh(x: Array) -> Array:
    return np.asarray(np.abs(x) + np.log1p(np.exp(-2 * np.abs(x))))


def sharp_width(arm: MovingArm) -> Array:
    """(m,) the least of that speed."""
    return coulomb_width(arm) / FILTER.sharper


def blunt_width(arm: MovingArm, width: Array) -> Array:
    """(m,) the largest beside one of (m,) that was chosen, up to which its shape is free."""
    return np.maximum(coulomb_width(arm), FILTER.blunter * width)


def coulomb_width(arm: MovingArm) -> Array:
    """(m,) speed within which friction changes sides as a rule, at most, rad/s or m/s."""
    return np.where(arm.sliding, FILTER.coulomb_width_m_s, FILTER.coulomb_width_rad_s)
