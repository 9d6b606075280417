"""Torque that is read late: shifted as a whole, or through a low-pass."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.library.causes import Moment
from armscope.motion.library.read_late import LATE_BY_ORDER, delayed, low_passed
from armscope.motion.samples.preparation import Signals

RATE = 500.0
TIME = np.arange(2000) / RATE
TORQUE = np.column_stack([np.sin(2 * np.pi * 0.5 * TIME), np.cos(2 * np.pi * 0.8 * TIME), TIME**2])
SIGNALS = Signals("", 0, TIME, TORQUE, TORQUE, TORQUE, TORQUE, None, TORQUE, np.arange(len(TIME)))
MOMENT = Moment(SIGNALS, TORQUE, TORQUE, None, RATE)


def test_a_delay_of_several_joints_shifts_each() -> None:
    late = TORQUE[:, [0, 2]] + 0.01 * delayed(MOMENT, (0, 2), 0.01)[:, :, 0]
    np.testing.assert_allclose(late[100:, 0], np.sin(2 * np.pi * 0.5 * (TIME[100:] - 0.01)), atol=1e-6)
    np.testing.assert_allclose(late[100:, 1], (TIME[100:] - 0.01) ** 2, atol=1e-6)


@pytest.mark.parametrize("order", sorted(LATE_BY_ORDER))
def test_a_low_pass_makes_slow_torque_as_late_as_it_says(order: int) -> None:
    late = TORQUE[:, [0]] + 0.01 * low_passed(MOMENT, (0,), order, 0.01)[:, :, 0]
    np.testing.assert_allclose(late[500:, 0], np.sin(2 * np.pi * 0.5 * (TIME[500:] - 0.01)), atol=2e-3)


@pytest.mark.parametrize("delay", [0.0, -0.004, 1e-4])
def test_what_no_low_pass_of_these_samples_does_is_a_delay(delay: float) -> None:
    np.testing.assert_array_equal(low_passed(MOMENT, (1,), 2, delay), delayed(MOMENT, (1,), delay))
