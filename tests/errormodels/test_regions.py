"""Blended regions: no jumps, no more regions than the data can bear."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.errormodels.features import FDP_CI, SDP_CI, fit_least_squares
from armscope.errormodels.regions import (
    Cut,
    blended,
    chosen_regions,
    compare_regions,
    divide,
    fit_regions,
    halvings_of,
    weights,
)


def rows(count=160, seed=0):
    return np.random.default_rng(seed).uniform([800, -600, 400], [1500, 600, 1400], (count, 3))


def linear(points, seed=1):
    return points @ np.random.default_rng(seed).normal(0, 1e-3, (3, 3))


def kinked(points):
    """Two linear laws that meet at y = 0."""
    return linear(points) + np.maximum(points[:, 1:2], 0) * np.array([6e-3, -4e-3, 5e-3])


@given(st.integers(0, 4), st.integers(0, 1000))
def test_weights_add_up_to_one_and_none_is_negative(halvings, seed):
    by_region = weights(divide(rows(), halvings), rows(50, seed) * 1.3)
    assert by_region.shape == (50, 2**halvings)
    np.testing.assert_allclose(by_region.sum(axis=1), 1.0)
    assert (by_region >= 0).all()


def test_the_blend_has_neither_jumps_nor_kinks():
    points = rows()
    features, cut = FDP_CI.features(points), divide(points, 3)
    coefficients = fit_regions(features, cut, points, kinked(points))
    line = np.linspace(points.min(axis=0), points.max(axis=0), 20001)
    along = blended(features, cut, coefficients, line)
    step = np.diff(along, axis=0)
    assert np.abs(step).max() < 5e-3
    assert np.abs(np.diff(step, axis=0)).max() < 0.02 * np.abs(step).max()


def test_regions_halve_the_rows():
    points = rows()
    sides = weights(divide(points, 2, overlap=1e-9), points)
    assert sides.sum(axis=0).tolist() == [40.0] * 4


def test_one_region_is_the_least_squares_fit():
    points = rows()
    features, errors = SDP_CI.features(points), kinked(points)
    one = blended(features, None, fit_regions(features, None, points, errors), points)
    coefficients, _ = fit_least_squares(features, points, errors)
    np.testing.assert_allclose(one, features.matrix(points) @ coefficients.T, atol=1e-6)


def test_a_law_that_regions_share_is_kept_exactly():
    points = rows()
    features, cut = FDP_CI.features(points), divide(points, 2)
    coefficients = fit_regions(features, cut, points, linear(points))
    np.testing.assert_allclose(blended(features, cut, coefficients, points), linear(points), atol=1e-9)


def test_cross_validation_divides_where_laws_differ_and_not_where_noise_does():
    points = rows()
    noise = np.random.default_rng(3).normal(0, 0.1, (len(points), 3))
    divided = compare_regions(FDP_CI, points, kinked(points) + noise, np.random.default_rng(0))
    assert chosen_regions(divided) >= 2
    whole = compare_regions(FDP_CI, points, linear(points) + noise, np.random.default_rng(0))
    assert chosen_regions(whole) == 1
    assert whole["fit_rms_mm"].is_monotonic_decreasing  # the fit itself would always ask for more
    assert whole["held_out_rms_mm"].iloc[-1] > whole["held_out_rms_mm"].iloc[0]


def test_too_few_rows_for_a_region_are_refused():
    points = rows(30)
    features, cut = SDP_CI.features(points), divide(points, 3)
    with pytest.raises(ValueError, match="7 terms need at least"):
        fit_regions(features, cut, points, linear(points))
    with pytest.raises(ValueError, match="1, 2, 4"):
        halvings_of(6)
    assert halvings_of(8) == 3


def test_borders_come_back_from_plain_values():
    cut = divide(rows(), 3)
    assert Cut.from_dict(cut.to_dict()) == cut
    assert Cut.from_dict(None) is None
