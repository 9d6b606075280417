"""By how much all links grow, as a formula with its number."""

from __future__ import annotations

import numpy as np

from armscope.physics.effect import Part
from armscope.physics.thermal import all_links_growing
from armscope.verdict.growth import growth_in_words

from ..physics.scenes import arm_named, full_table


def told_of(alike: float, first_besides: float) -> str:
    """What is said of links that grow alike, and the first one by something more."""
    arm = arm_named("six-axis")
    whole, first, *others = all_links_growing(arm, full_table(arm, 30, seed=1))
    parts = [Part(whole, np.array([alike])), Part(first, np.array([first_besides]))]
    return growth_in_words([*parts, *(Part(link, np.zeros(1)) for link in others)])


def test_all_links_that_grow_alike_have_one_number() -> None:
    formula = "length = stated length x (1 + coefficient x (temperature - 20 C))."
    assert told_of(2.2e-5, 0.0) == f"{formula} Here coefficient = 22 millionths per K."


def test_links_that_grow_otherwise_are_told_from_to_and_their_mean_by_length() -> None:
    assert "link by link 22 millionths per K to 28 millionths per K" in told_of(2.2e-5, 6e-6)


def test_nothing_is_said_of_links_that_do_not_grow() -> None:
    assert growth_in_words([]) == told_of(0.0, 0.0) == ""
