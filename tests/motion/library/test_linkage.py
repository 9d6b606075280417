"""A spring between two links: its torque is force times how its length changes with the angle."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.library.linkage import length, pull, pushes_one_way
from armscope.motion.library.linkage_constants import LINKAGE
from armscope.motion.library.remedies import Fitted
from armscope.motion.library.remedies_of_laws import spring
from armscope.verdict.effects import Parameter
from tests.motion.moving import robot

ANGLE, STEP = np.linspace(0.2, 2.5, 40), 1e-6


@pytest.mark.parametrize("ratio", [0.2, 0.7, 0.95])
def test_its_lever_is_the_slope_of_its_length(ratio: float) -> None:
    slope = (length(ANGLE + STEP, ratio) - length(ANGLE - STEP, ratio)) / (2 * STEP)
    middle = 1.1
    force = 3.0 + 2.0 * (length(ANGLE, ratio) - length(middle, ratio))
    assert pull(ANGLE, ratio, middle) @ [3.0, 2.0] * ratio == pytest.approx(force * slope, rel=1e-6)


def test_its_cure_is_the_formula_with_its_numbers() -> None:
    numbers = (Parameter("force_lever", "N m", 6.0, 0.1), Parameter("growth", "N m", -1.0, 0.1))
    fitted = Fitted("Add the spring's or counterweight's torque to the model.", numbers, robot(), (0.3, 0.6, 0.4))
    told = spring(fitted)
    assert "× (l − 0.665)) × sin(x) / l" in told
    assert "x is position + 0.3 rad" in told
    assert "l = √(1.36 − 1.2 cos x)" in told
    assert float(length(0.7, 0.6)) == pytest.approx(0.665, abs=1e-4)


def test_no_spring_is_shorter_than_one_can_be() -> None:
    assert float(length(0.0, 1.0)) == LINKAGE.shortest
    assert np.all(np.isfinite(pull(np.zeros(3), 1.0, 0.0)))


@pytest.mark.parametrize(("growth", "sound"), [(0.5, True), (-1.8, True), (1.8, False), (-9.0, False)])
def test_a_force_that_changes_its_sign_is_no_springs(growth: float, sound: bool) -> None:
    middle = float(np.mean(ANGLE))
    force = 1.0 + growth * (length(ANGLE, 0.6) - length(middle, 0.6))
    assert bool(np.all(force > 0)) == sound
    assert bool(pushes_one_way(np.array([1.0, growth]), ANGLE, 0.6, middle)) == sound
