"""Torque that is read late: shifted as a whole, or through a low-pass."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from armscope.motion.library.causes import Moment
from armscope.motion.library.dry_friction import ChangeOfSides, DryFriction
from armscope.motion.library.read_late import delayed
from armscope.motion.samples.preparation import Signals
from tests.motion.moving import robot

RATE = 500.0
TIME = np.arange(2000) / RATE
TORQUE = np.column_stack([np.sin(2 * np.pi * 0.5 * TIME), np.cos(2 * np.pi * 0.8 * TIME), TIME**2])
SIGNALS = Signals("", 0, TIME, TORQUE, TORQUE, TORQUE, TORQUE, None, TORQUE, np.arange(len(TIME)))
MOMENT = Moment(SIGNALS, TORQUE, TORQUE, RATE)


def test_a_delay_of_several_joints_shifts_each() -> None:
    late = TORQUE[:, [0, 2]] + 0.01 * delayed(MOMENT, (0, 2), 0.01)[:, :, 0]
    np.testing.assert_allclose(late[100:, 0], np.sin(2 * np.pi * 0.5 * (TIME[100:] - 0.01)), atol=1e-6)
    np.testing.assert_allclose(late[100:, 1], (TIME[100:] - 0.01) ** 2, atol=1e-6)


@pytest.mark.parametrize("order", [1, 2])
def test_a_low_pass_of_slow_torque_is_a_delay_and_a_part_of_how_drives_round_it_off(order: int) -> None:
    wide = 2 * np.pi * 25.0
    b, a = butter(order, wide, fs=2 * np.pi * RATE)
    passed = lfilter(b, a, TORQUE[:, 0])
    delay = {1: 1.0, 2: 2**0.5}[order] / wide
    column = delayed(MOMENT, (0,), delay)[:, 0, 0]
    rounded = np.gradient(np.gradient(TORQUE[:, 0], 1 / RATE), 1 / RATE)
    both = np.column_stack([column, rounded])[500:-5]
    found, left, _, _ = np.linalg.lstsq(both, (passed - TORQUE[:, 0])[500:-5], rcond=None)
    assert found[0] == pytest.approx(delay, rel=0.15)
    assert np.sqrt(left[0] / len(both)) < 1e-4


def test_dry_friction_is_late_by_itself() -> None:
    """When it changes sides is each joint's own number, whatever delay all torque has."""
    arm, dry = robot(), np.array([3.0, 2.0, 1.0])
    own = DryFriction(dry, ChangeOfSides.of(arm))
    with_it = TORQUE + dry * own.turning.sides(SIGNALS)
    both = Moment(SIGNALS, TORQUE, with_it, RATE, dry=own)
    for delay in (0.0, 0.01):
        np.testing.assert_allclose(delayed(both, (0, 1, 2), delay), delayed(MOMENT, (0, 1, 2), delay), atol=1e-8)
