"""Where the tool stands, and what moves it."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.registry import library
from armscope.physics.scene import Posture, Scene
from armscope.physics.terms import Direction
from tests.physics.scenes import arm_named, full_table


@pytest.fixture(scope="module")
def posture() -> Posture:
    arm = arm_named("six-axis")
    return Scene(arm, full_table(arm, 10, 1)).posture()


def test_a_base_that_is_shifted_takes_the_tool_along_and_turns_nothing(posture: Posture) -> None:
    np.testing.assert_allclose(posture.displacement(Direction("base", "ty")), np.tile([0.0, 1.0, 0.0], (10, 1)))
    np.testing.assert_allclose(posture.turn(Direction("base", "ty")), 0.0)


def test_an_instrument_that_reads_long_sees_the_tool_farther_and_an_unknown_direction_moves_nothing(
    posture: Posture,
) -> None:
    np.testing.assert_allclose(posture.displacement(Direction("instrument", "scale")), posture.tool)
    assert posture.displacement(Direction("weather", "rain")) is None


def test_what_all_parts_do_together_is_the_sum_of_their_products_one_by_one() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 10, 1)
    scene, rng = Scene(arm, table), np.random.default_rng(0)
    linear = [placed for placed in library(arm, table) if placed.effect.exact is None]
    parts = [Part(placed, rng.normal(size=len(placed.terms)) * (rng.random() < 0.7)) for placed in linear]
    parts[0].values[:] = 0.0
    expected: dict[Direction, np.ndarray] = {}
    for part in parts:
        for value, term in zip(part.values, part.placed.terms, strict=True):
            for product in term.products if value else ():
                amount = value * product.factor * scene.driver(product.driver)
                expected[product.direction] = expected.get(product.direction, 0.0) + amount
    bent = scene._bent(scene.nominal)
    for found in (scene.amounts(parts), scene.amounts(parts), bent.amounts(parts)):
        assert found.keys() == expected.keys()
        for direction, amount in expected.items():
            np.testing.assert_allclose(found[direction], amount, rtol=1e-12, atol=1e-12 * np.abs(amount).max())
