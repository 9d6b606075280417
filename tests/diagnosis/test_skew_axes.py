"""Axes that should be parallel and are not: a number of the link between them, and no bearing that wobbles."""

from __future__ import annotations

import pytest

from armscope.physics.geometric import row_terms
from armscope.robot import Arm

from ..physics.scenes import arm_named
from .numpy_arms import UR5E, said, still


@pytest.mark.parametrize(("link", "skew", "seed"), [(2, 8e-4, 1), (3, -1.2e-3, 2)])
def test_skew_axes_are_an_error_of_their_link_and_no_bearing_that_wobbles(link: int, skew: float, seed: int) -> None:
    (effect,) = said(UR5E, still, seed, skew=(link, skew)).effects
    assert (effect.effect, effect.location) == ("link_geometry", f"link {link}")
    (beta,) = [number for number in effect.parameters if number.name == "beta"]
    assert beta.value == pytest.approx(skew, abs=3 * beta.stderr + 1e-4), "the arm's own tolerances beside it"


def test_only_rows_between_parallel_axes_have_a_number_more() -> None:
    arm: Arm = arm_named("six-axis")
    assert [("beta" in row_terms(arm, j)) for j in range(1, 6)] == [False, True, False, False, False]
