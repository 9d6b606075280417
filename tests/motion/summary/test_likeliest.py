"""What may be looked at first where masses are off without a name."""

from __future__ import annotations

import re

import pytest
from benchmarks.motion_changing_load import World

from armscope.motion.summary.likeliest import likeliest_in_words
from armscope.verdict.effects import INTERVAL
from tests.motion.test_changing_load import diagnosed
from tests.seeds import seeds


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(4, 8))
def test_a_load_that_nobody_stated_is_told_though_the_last_link_may_be_off_in_any_way(seed: int) -> None:
    """Three joints from point to point: that link would need ten numbers of its own, and to be the only one."""
    world = World("always", 3, seed, by_points=True)
    (found,) = diagnosed(world)[0].verdict.effects
    assert (found.effect, found.location) == ("payload_error", "payload")
    mass = found.parameters[0]
    assert abs(mass.value - world.mass) < INTERVAL * mass.stderr < 0.6 * world.mass


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(204))
def test_a_load_that_masses_without_a_name_may_be_is_the_likeliest_of_names(seed: int) -> None:
    """Here the same arm moves so that all links a little off say it nearly as well."""
    world = World("always", 3, seed, by_points=True)
    verdict = diagnosed(world)[0].verdict
    assert (verdict.answer, verdict.effects) == ("cannot tell", ())
    told = re.search(r"too unsure to be told as one \(\d+ to 1\): payload error, mass \+([\d.]+) kg", verdict.headline)
    assert told, verdict.headline
    assert float(told[1]) == pytest.approx(world.mass, rel=0.15)


@pytest.mark.long
def test_nothing_is_likely_where_masses_are_as_stated() -> None:
    assert likeliest_in_words(diagnosed(World("none", 3, 1))[0].selected) == ""
