"""What a noise that follows gains and loses, in numbers."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.inference.linear_algebra import profiled_gain


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
