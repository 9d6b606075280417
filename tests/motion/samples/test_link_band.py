"""A link's encoder is listened to as far as it tells motion."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.samples.link_band import link_bands
from armscope.motion.samples.preparation import parts, preparation
from armscope.motion.samples.timing import Stretch

RATE, SECONDS, NOISE = 250.0, 14.0, 2e-5


def beside() -> Array:
    """Noise; noise and a sway of 2 Hz; no encoder."""
    time = np.arange(int(RATE * SECONDS)) / RATE
    found = NOISE * np.random.default_rng(4).normal(size=(len(time), 3))
    found[:, 1] += 20 * NOISE * np.sin(2 * np.pi * 2.0 * time)
    found[:, 2] = np.nan
    return np.asarray(found)


def test_noise_has_no_band_and_a_sway_one_that_lets_it_through() -> None:
    silent, sways, none = link_bands(beside(), RATE)
    assert (silent, none) == (0.0, 0.0)
    assert 4.0 <= sways < 12.0


def test_links_move_as_their_motors_where_their_encoders_tell_noise() -> None:
    q = np.zeros((int(RATE * SECONDS), 3))
    stretch = Stretch("one", RATE, np.arange(len(q)) / RATE, q, q, None, None, q + beside())
    signals, *_ = parts([stretch], preparation(RATE, 20.0, "test", 14.0))
    assert signals.shift is not None
    _, _, acceleration = (values[signals.kept] for values in signals.shift)
    np.testing.assert_array_equal(acceleration[:, [0, 2]], 0.0)
    assert acceleration[:, 1].std() == pytest.approx(20 * NOISE / np.sqrt(2) * (2 * np.pi * 2.0) ** 2, rel=0.1)
