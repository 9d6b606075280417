"""Waves of a joint's angle, by one count and by many."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from armscope.core.types import Array
from armscope.motion.library.waves import fewest_waves, most_waves, successive_waves, wave
from armscope.motion.samples.preparation import Signals


def speeding_up() -> Signals:
    """A joint that turns ever faster."""
    time = np.arange(400) / 200.0
    q, none = np.column_stack([time**2]), np.zeros((400, 1))
    return Signals("", 0, time, q, 2 * time[:, None], none, none, None, None, np.arange(400))


def test_a_wave_that_samples_do_not_show_is_none() -> None:
    signals = speeding_up()
    shown = 300 * 2 * signals.time / (2 * np.pi) < 100.0
    made = wave(signals, 0, 300.0)
    np.testing.assert_allclose(np.hypot(*made.T), shown)


def test_successive_waves_are_each_counts_own() -> None:
    signals = speeding_up()
    made = successive_waves(signals, 0, 280, 50)
    each = np.stack([wave(signals, 0, 280.0 + k) for k in range(50)], axis=1)
    np.testing.assert_allclose(made, each, atol=1e-11)


def left_of(columns: Array, values: Array) -> float:
    """Share of values that a fit leaves."""
    remains = values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
    return float(np.linalg.norm(remains) / np.linalg.norm(values))


@pytest.mark.parametrize("knots", [4, 7, 10])
def test_a_curve_follows_as_many_waves_as_it_turns_twice_for_and_not_twice_as_many(knots: int) -> None:
    turns = 0.6
    angle = np.linspace(0, 2 * np.pi * turns, 500)
    ends = np.linspace(0, angle[-1], knots - 2)
    curve = BSpline.design_matrix(angle.clip(0, angle[-1]), np.r_[[0] * 3, ends, [angle[-1]] * 3], 3).toarray()
    most = most_waves(turns, knots)
    assert left_of(curve, np.sin(most * angle)) < 0.4
    assert left_of(curve, np.sin(2 * most * angle)) > 0.6


def test_a_range_holds_waves_and_no_bend_from_one_and_a_half_on() -> None:
    assert fewest_waves(0.5) == 3
    assert fewest_waves(3.0) == 2
