"""What a noise that follows gains and loses, in numbers."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.inference.linear_algebra import among, crossed, profiled_gain, spanned


@pytest.mark.parametrize("chi2", [-1e-10, 0.0])
def test_sums_of_what_is_fitted_to_all_digits_gain_next_to_nothing_and_never_no_number(chi2: float) -> None:
    """Squares that are left may come out below zero there: a difference of two sums of as many digits."""
    gain = profiled_gain(np.array([0.0, 1.0]), chi2, 100.0, 1e-6, 1e-6)
    assert np.isfinite(gain).all()
    assert (gain < 1e-6).all()


def test_what_chi2_falls_by_is_gained_and_what_the_noise_takes_with_it() -> None:
    n, chi2, fall = 200.0, 200.0, 60.0
    (gain,) = profiled_gain(np.array([fall]), chi2, n, 1.0, 0.0)
    assert gain == pytest.approx(n / 2 * np.log(chi2 / (chi2 - fall)))
    (held,) = profiled_gain(np.array([fall]), chi2, n, 1.0, 1.0)
    assert held == pytest.approx(fall / 2)


@pytest.mark.parametrize("some", [[], [4], [0, 1, 2, 3, 4, 5], [0, 2, 5], [9, 3, 4, 5, 6, 7, 8, 0]])
@pytest.mark.parametrize("others", [[], [1, 2, 3, 7, 8, 9], [8, 6, 0]])
def test_products_are_looked_up_wherever_their_columns_stand(some: list[int], others: list[int]) -> None:
    G = np.random.default_rng(0).normal(size=(10, 10))
    down, right = (np.array(each, dtype=np.intp) for each in (some, others))
    np.testing.assert_array_equal(crossed(G, down, right), G[np.ix_(down, right)])
    np.testing.assert_array_equal(among(G, down), G[np.ix_(down, down)])


def test_what_rounding_alone_makes_of_a_column_is_no_direction() -> None:
    rng = np.random.default_rng(1)
    columns = rng.normal(size=(50, 4)) * [1.0, 40.0, 1e-3, 1.0]
    nothing, twice = 1e-15 * rng.normal(size=(50, 1)), (columns[:, :1] + columns[:, 1:2]).astype(np.float32)
    basis = spanned(np.hstack([columns, nothing, twice]), 1e-6)
    assert basis.shape == (50, 4)
    np.testing.assert_allclose(basis.T @ basis, np.eye(4), atol=1e-12)
    np.testing.assert_allclose(basis @ (basis.T @ columns), columns, atol=1e-5)


def test_of_no_columns_nothing_is_spanned() -> None:
    assert spanned(np.empty((7, 0)), 1e-6).shape == (7, 0)
    assert spanned(np.zeros((7, 2)), 1e-6).shape == (7, 0)
