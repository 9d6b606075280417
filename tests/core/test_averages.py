import numpy as np
import pytest

from armscope.core.averages import rms, rms_distance, robust_scale


def test_per_number_and_per_vector():
    vectors = np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 5.0]])
    assert rms_distance(vectors) == pytest.approx(5.0)
    assert rms(vectors) == pytest.approx(5.0 / np.sqrt(3))
    assert rms(np.empty((0, 3))) == 0.0


def test_the_robust_scale_is_the_standard_deviation_of_normal_numbers_and_bad_ones_hardly_move_it():
    values = 3.0 * np.random.default_rng(0).standard_normal(100_000)
    assert robust_scale(values) == pytest.approx(3.0, rel=0.01)
    values[:10_000] = 1e6
    assert 3.0 < robust_scale(values) < 3.6
