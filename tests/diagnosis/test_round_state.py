"""Rounds of a selection end when neither the effects nor the rows that count change any more."""

from __future__ import annotations

import numpy as np

from armscope.diagnosis.round_state import RoundState

ROWS = 2000


def state(effects: set[str], suspect: int) -> RoundState:
    """With so many suspect rows, the first ones."""
    return RoundState(frozenset(effects), np.arange(ROWS) < suspect)


def test_rounds_with_the_same_effects_and_rows_ended_alike():
    assert state({"joint offset joint 2"}, 7).is_like(state({"joint offset joint 2"}, 7))


def test_another_effect_is_another_end():
    assert not state({"joint offset joint 2"}, 7).is_like(state({"joint offset joint 3"}, 7))
    assert not state(set(), 0).is_like(state({"joint offset joint 3"}, 0))


def test_two_rows_in_a_thousand_may_come_and_go():
    assert state(set(), 4).is_like(state(set(), 0))
    assert not state(set(), 5).is_like(state(set(), 0))
