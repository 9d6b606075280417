"""Places in an arm: the words of the files, and what they mean."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.core.location import Location


@given(st.sampled_from(["joint", "link", "motor"]), st.integers(1, 99), st.integers(0, 99))
def test_words_and_parts_are_one(kind: str, number: int, source: int) -> None:
    place = Location(kind, number, source)
    assert Location.of(str(place)) == place


@pytest.mark.parametrize("words", ["base", "tool", "instrument", "payload", "parallelogram", "joint", "joint two"])
def test_words_without_a_number_are_a_kind_of_their_own(words: str) -> None:
    assert Location.of(words) == Location(words)
    assert Location.of(words).region == words


def test_a_coupling_stands_at_the_joint_that_moves_and_knows_what_moves_it() -> None:
    place = Location.of("joint 6 from joint 5")
    assert (place.number, place.index, place.source, place.region) == (6, 5, 5, "6")
    assert Location.of("link 2").region == "2"
