"""What may be looked at first where masses are off without a name."""

from __future__ import annotations

import re

import pytest
from benchmarks.motion_changing_load import World

from armscope.motion.summary.likeliest import likeliest_in_words
from tests.motion.test_changing_load import diagnosed
from tests.seeds import seeds


@pytest.mark.parametrize("seed", seeds(4, 8))
def test_a_load_that_masses_without_a_name_may_be_is_the_likeliest_of_names(seed: int) -> None:
    """Three joints from point to point: what is carried is 10 to 19 times likelier than that the last link is off."""
    world = World("always", 3, seed, by_points=True)
    verdict = diagnosed(world)[0].verdict
    assert (verdict.answer, verdict.effects) == ("cannot tell", ())
    told = re.search(r"too unsure to be told as one \(\d+ to 1\): payload error, mass \+([\d.]+) kg", verdict.headline)
    assert told, verdict.headline
    assert float(told[1]) == pytest.approx(world.mass, rel=0.15)


def test_nothing_is_likely_where_masses_are_as_stated() -> None:
    assert likeliest_in_words(diagnosed(World("none", 3, 1))[0].selected) == ""
