"""A name before a curve that says hardly more, and a plain law before one whose mount was scanned."""

from __future__ import annotations

from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

import pytest

from armscope.inference.problem import SelectedEffect
from armscope.motion.fitting.preferred import named_first, plain_first
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, UNKNOWN

WORTHS = {(): 0.0, (0,): 100.0, (1,): 60.0, (2,): 50.0, (3,): 40.0, (1, 2): 80.0, (1, 3): 70.0, (2, 3): 99.0}
"""Log posteriors of sets of names 1 to 3, or of the curve 0 that holds them; of all three it is 79."""


class ToldWorths:
    """A search in which every set of names has the worth that is told."""

    names = frozenset({1, 2, 3})

    def __init__(self) -> None:
        self.space = SimpleNamespace(candidates=range(4))

    def candidate(self, number: int) -> SimpleNamespace:
        family, special = (UNKNOWN, self.names) if number == 0 else ("", frozenset())
        return SimpleNamespace(family=family, is_curve=number == 0, special_cases=special)

    def evaluated(self, effects: Iterable[SelectedEffect], _: object = None) -> SimpleNamespace:
        chosen = tuple(effects)
        worth = WORTHS.get(tuple(sorted(each.candidate for each in chosen)), 79.0)
        return SimpleNamespace(chosen=chosen, log_posterior=worth)

    def without(self, parent: SimpleNamespace, removed: Iterable[int]) -> SimpleNamespace:
        gone = set(removed)
        return self.evaluated(each for each in parent.chosen if each.candidate not in gone)

    def additions(self, parent: SimpleNamespace, count: int, without: Iterable[int]) -> list[SimpleNamespace]:
        there = {each.candidate for each in parent.chosen} | set(without)
        more = [self.evaluated((*parent.chosen, SelectedEffect(n, 0))) for n in sorted(self.names - there)]
        return sorted(more, key=lambda each: -each.log_posterior)[:count]


def test_a_name_that_was_the_best_by_itself_gives_way_to_one_that_is_better_beside_the_others() -> None:
    """One after the other they came, each for what was left: a square of the speed stayed, where friction falls."""
    search: Any = ToldWorths()
    named = named_first(search, search.evaluated([SelectedEffect(0, 0)]))
    assert sorted(each.candidate for each in named.chosen) == [2, 3]


class ToldForms(ToldWorths):
    """A search in which cause 0 is mounted somehow, 1 is plain, both springs of one joint; 2 is something else."""

    names = frozenset({0, 1, 2})

    def __init__(self, worths: dict[tuple[int, ...], float], family: str = "springs") -> None:
        self.worths, how = worths, {"family": family, "is_curve": False, "special_cases": frozenset()}
        spring = {"key": ("spring", "joint 2"), **how}
        mounted = SimpleNamespace(multiplicity=500, excludes=frozenset({1}), **spring)
        plain = SimpleNamespace(multiplicity=1, excludes=frozenset({0}), **spring)
        other = SimpleNamespace(multiplicity=1, excludes=frozenset(), key=("offset", "joint 2"), **how)
        self.space = SimpleNamespace(candidates=[mounted, plain, other])

    def candidate(self, number: int) -> SimpleNamespace:
        return self.space.candidates[number]

    def evaluated(self, effects: Iterable[SelectedEffect], _: object = None) -> SimpleNamespace:
        chosen = tuple(effects)
        worth = self.worths.get(tuple(sorted(each.candidate for each in chosen)), 0.0)
        return SimpleNamespace(chosen=chosen, log_posterior=worth)


@pytest.mark.parametrize(
    ("more", "family", "kept"),
    [
        (0.9 * INDISTINGUISHABLE_NATS, "springs", 1),
        (1.1 * INDISTINGUISHABLE_NATS, "springs", 0),
        (0.9 * INDISTINGUISHABLE_NATS, UNKNOWN, 0),
    ],
)
def test_of_two_laws_of_a_spring_the_plain_one_is_told_unless_the_other_is_clearly_better(
    more: float, family: str, kept: int
) -> None:
    search: Any = ToldForms({(0,): 50.0 + more, (1,): 50.0, (2,): 49.9}, family)
    found = plain_first(search, search.evaluated([SelectedEffect(0, 0)]))
    assert [each.candidate for each in found.chosen] == [kept]
