"""Waves of a joint's angle, by one count and by many."""

from __future__ import annotations

import numpy as np

from armscope.motion.library.waves import successive_waves, wave
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
