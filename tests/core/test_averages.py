import numpy as np
import pytest

from armscope.core.averages import rms, rms_distance


def test_per_number_and_per_vector():
    vectors = np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 5.0]])
    assert rms_distance(vectors) == pytest.approx(5.0)
    assert rms(vectors) == pytest.approx(5.0 / np.sqrt(3))
    assert rms(np.empty((0, 3))) == 0.0
