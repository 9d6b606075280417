"""Links that grow with temperature: alike, and each a little otherwise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.thermal import THERMAL_EXPANSION, all_links_growing

from .scenes import arm_named, full_table


def test_all_links_grow_as_one_and_each_a_little_otherwise() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 30, seed=1)
    whole, *links = all_links_growing(arm, table)
    assert whole.location == "arm"
    assert whole.prior_scale == (PLAUSIBLE.expansion_per_k,)
    assert {link.location for link in links} == {link.location for link in THERMAL_EXPANSION.place(arm, table)}
    assert {link.prior_scale for link in links} == {(PLAUSIBLE.uneven_expansion_per_k,)}
    assert set(whole.terms[0].products) == {product for link in links for product in link.terms[0].products}


@pytest.mark.parametrize("temperature", [None, np.full(30, 23.0)])
def test_nothing_grows_that_does_not_get_warmer(temperature: np.ndarray | None) -> None:
    arm = arm_named("six-axis")
    assert all_links_growing(arm, replace(full_table(arm, 30, seed=1), temperature=temperature)) == []
