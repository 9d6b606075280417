"""The side of a motion is its mean over each sample's time."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.library.sides import coulomb_width, sharp_width, side
from armscope.motion.samples.preparation import Signals
from tests.motion.moving import robot

PERIOD, WIDTH = 0.01, 0.003


def samples(speed: np.ndarray, acceleration: np.ndarray) -> Signals:
    time = PERIOD * np.arange(len(speed))
    q, dq, ddq = (each[:, None] for each in (0 * time, speed, acceleration))
    return Signals("", 0, time, q, dq, ddq, q[:0], None, None, np.arange(len(time)))


@pytest.mark.parametrize("acceleration", [0.0, 0.02, 4.0, -4.0])
def test_a_side_is_the_mean_over_a_samples_time(acceleration: float) -> None:
    speed = np.linspace(-0.1, 0.1, 41)  # at both ends beyond where it is 1 to all digits
    within = PERIOD * (np.arange(4001) / 4000 - 0.5)
    mean = np.tanh((speed[:, None] + acceleration * within) / WIDTH)
    mean = np.trapezoid(mean, within, axis=1) / PERIOD
    found = side(samples(speed, np.full(41, acceleration)), np.array([WIDTH]))[:, 0]
    assert found == pytest.approx(mean, abs=1e-5)


def test_fits_turn_over_more_sharply_than_the_widest_allowed() -> None:
    assert np.all(sharp_width(robot()) < coulomb_width(robot()))
