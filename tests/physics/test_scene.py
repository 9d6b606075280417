"""Where the tool stands, and what moves it."""

from __future__ import annotations

import numpy as np
import pytest

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
