"""The polynomials of the place are Legendre's, and stand still beyond the volume."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.place_drivers import legendre_product
from armscope.physics.registry import library

from .scenes import arm_named, full_table


def test_a_product_is_that_of_the_written_out_polynomials():
    points = np.random.default_rng(3).uniform(-1, 1, (50, 3))
    x, y, z = points.T
    expected = x * (3 * y**2 - 1) / 2 * (5 * z**3 - 3 * z) / 2
    np.testing.assert_allclose(legendre_product(points, (1, 2, 3), (0.0, 0.0, 0.0), 1.0), expected, atol=1e-15)
    moved = 0.7 * points + [1.0, 2.0, 3.0]
    np.testing.assert_allclose(legendre_product(moved, (1, 2, 3), (1.0, 2.0, 3.0), 0.7), expected, atol=1e-12)


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_beyond_the_volume_it_is_as_on_the_border(degree):
    at = [legendre_product(np.array([[x, 0.0, 0.0]]), (degree, 0, 0), (0.0, 0.0, 0.0), 0.5) for x in (0.5, 2.0)]
    assert at[0] == at[1] == 1.0


def test_a_tool_that_stays_in_one_place_shows_no_error_that_changes_from_place_to_place():
    arm = arm_named("six-axis")
    table = full_table(arm, 60, seed=13)
    still = replace(table, motor_angles=np.tile(table.motor_angles[:1], (60, 1)))
    assert any(placed.name == "instrument_distortion" for placed in library(arm, table))
    assert not any(placed.name == "instrument_distortion" for placed in library(arm, still))
