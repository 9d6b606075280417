"""Some rows of many: evenly spread, ends included; and taken without a copy where they follow one another."""

import numpy as np
import pytest

from armscope.core.sampling import in_one_stretch, spread_evenly, spread_over_a_sphere


@pytest.mark.parametrize(("count", "most"), [(10, 4), (3, 7), (1, 1), (1000, 400)])
def test_rows_are_spread_evenly_with_both_ends(count, most):
    rows = spread_evenly(count, most)
    assert len(rows) == min(count, most)
    assert rows[0] == 0
    assert rows[-1] == (count - 1 if most > 1 else 0)
    assert len(set(np.diff(rows).tolist())) <= 2


@pytest.mark.parametrize("numbers", [[4], [0, 1, 2], [3, 4, 6], [0, 2]])
def test_a_stretch_takes_what_its_numbers_take(numbers):
    values, rows = np.arange(10.0), np.array(numbers)
    taken = values[in_one_stretch(rows)]
    np.testing.assert_array_equal(taken, values[rows])
    assert np.shares_memory(taken, values) == (np.ptp(rows) == len(rows) - 1)


def test_points_on_a_sphere_are_evenly_spread():
    points = spread_over_a_sphere(300)
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1)
    np.testing.assert_allclose(points.T @ points, 100 * np.eye(3), atol=1)
    cosines = points @ points.T - 2 * np.eye(300)
    assert np.degrees(np.arccos(cosines.max(axis=1))).min() > 8
