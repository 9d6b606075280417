"""How much rows count, channel by channel: by the noise that each shows."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.measurement.channel import ORIENTATIONS, POSITIONS, ChannelResiduals
from armscope.measurement.row_weights import RowNoise


def scale_of_turns(rows: int, own_values: int) -> float:
    """By which turns of a milliradian count beside points of 0.1 mm (m per rad), with values that only turns see."""
    rng = np.random.default_rng(rows)
    left = {POSITIONS: rng.normal(0, 1e-4, (rows, 3)), ORIENTATIONS: rng.normal(0, 1e-3, (rows, 3))}
    noise = RowNoise(np.ones(rows), np.ones(rows))
    _, turns = noise.weights(ChannelResiduals(left, {ORIENTATIONS: own_values}), 0.0).of_channels
    return turns.scale


def test_a_channel_counts_by_the_ratio_of_the_noises() -> None:
    assert scale_of_turns(2000, 0) == pytest.approx(0.1, rel=0.05)


def test_values_that_only_one_channel_sees_take_some_of_its_noise_up() -> None:
    """102 values of 240 numbers leave 0.76 of the noise: turns that count by what is left count too much."""
    assert scale_of_turns(80, 102) / scale_of_turns(80, 0) == pytest.approx(np.sqrt(1 - 102 / 240))


def test_few_of_many_rows_hold_fewer_numbers_than_the_model_has_values_and_still_count() -> None:
    assert scale_of_turns(21, 102) / scale_of_turns(21, 0) == pytest.approx(np.sqrt(0.5))


def test_rows_that_are_left_out_count_nothing_in_any_channel_and_the_others_as_before() -> None:
    rng = np.random.default_rng(4)
    left = {POSITIONS: rng.normal(0, 1e-4, (30, 3)), ORIENTATIONS: rng.normal(0, 1e-3, (30, 3))}
    weights = RowNoise(np.ones(30), np.ones(30)).weights(ChannelResiduals(left, {}), 0.0)
    out = np.arange(30) < 4
    for before, after in zip(weights.of_channels, weights.without(out).of_channels, strict=True):
        assert (before.weight[out] > 0).all()
        assert not after.weight[out].any()
        np.testing.assert_array_equal(after.weight[~out], before.weight[~out])
