"""Powers of the speed: what they are near rest, and what of them is ordinary friction."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.library.power_law import nearest_ordinary, power_of_speed

SPEEDS = (0.1, 0.4, 0.7, 1.1, 1.6)


def test_a_root_of_the_speed_is_not_steep_at_rest() -> None:
    """It was told in place of how friction changes sides: four of four clean tables had a name."""
    speed = np.array([-2.0, -0.004, 0.0, 0.01, 0.25])
    assert power_of_speed(speed, 0.01, 0.5) == pytest.approx([np.sqrt(2), 0.1, 0.1, 0.1, 0.5])


def test_what_a_square_leaves_beside_the_nearest_friction_is_neither_dry_nor_viscous() -> None:
    viscous, dry = nearest_ordinary(0.01, 2.0, 1.0, 1.0, *SPEEDS)
    at = np.array(SPEEDS)
    left = at**2 - viscous * at - dry
    assert [left.sum(), left @ at] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert np.linalg.norm(left) > 0.05 * np.linalg.norm(at**2)


def test_of_friction_that_is_stated_a_power_takes_nothing_off() -> None:
    assert nearest_ordinary(0.01, 2.0, 0.0, 1.0, *SPEEDS) == pytest.approx([0.0, np.mean(np.square(SPEEDS))])
    assert not nearest_ordinary(0.01, 2.0, 0.0, 0.0, *SPEEDS).any()
