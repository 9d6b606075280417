"""Fourier paths: derivatives against differences, limits, rest at the ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.design.fourier import FourierPath, Limits, random_path

LIMITS = Limits(np.array([[-1.0, 2.0], [0.5, 0.9], [-3.0, 3.0]]), np.array([1.0, 2.0, 0.3]), np.array([3.0, np.inf, 9]))


def test_speed_and_acceleration_are_the_derivatives_of_the_angle():
    path = random_path(LIMITS, 5, 8.0, np.random.default_rng(1))
    time, step = np.linspace(0.5, 7.5, 40), 1e-4
    before, now, after = (path.at(time + shift)[0] for shift in (-step, 0, step))
    np.testing.assert_allclose(path.at(time)[1], (after - before) / (2 * step), atol=1e-6)
    np.testing.assert_allclose(path.at(time)[2], (after - 2 * now + before) / step**2, atol=1e-4)


def test_a_single_wave_is_what_is_written():
    path = FourierPath(np.array([0.2]), np.array([[0.0, 0.3]]), np.array([[0.1, 0.0]]), 4.0)
    angle, _, _ = path.at(np.array([0.7]))
    turn = 2 * np.pi / 4 * 0.7
    assert angle[0, 0] == pytest.approx(0.2 + 0.1 * np.cos(turn) + 0.3 * np.sin(2 * turn))


@given(st.integers(0, 10_000), st.integers(2, 12), st.floats(2, 40))
def test_random_paths_keep_the_limits_and_rest_at_their_ends(seed, harmonics, period):
    path = random_path(LIMITS, harmonics, period, np.random.default_rng(seed))
    angle, speed, acceleration = path.at(np.linspace(0, period, 4001))
    assert (angle >= LIMITS.angle[:, 0]).all()
    assert (angle <= LIMITS.angle[:, 1]).all()
    assert (np.abs(speed) <= LIMITS.speed).all()
    assert (np.abs(acceleration) <= LIMITS.acceleration).all()
    np.testing.assert_allclose(speed[[0, -1]], 0, atol=1e-9)
    np.testing.assert_allclose(acceleration[[0, -1]], 0, atol=1e-9)


def test_some_limit_is_used_in_full():
    path = random_path(LIMITS, 5, 8.0, np.random.default_rng(3))
    angle, speed, acceleration = path.over_period()
    used = [
        np.ptp(angle, axis=0) / np.ptp(LIMITS.angle, axis=1),
        np.abs(speed).max(axis=0) / LIMITS.speed,
        np.abs(acceleration).max(axis=0) / LIMITS.acceleration,
    ]
    np.testing.assert_allclose(np.max(used, axis=0), 0.9, rtol=1e-9)
