"""The hypotheses next to one: additions, swaps, merges, splits, and what moves between names and backgrounds."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from armscope.inference.additions import best_additions, joint_addition_scores
from armscope.inference.conditioning import condition_on, low_rank_update
from armscope.inference.constants import BUDGET
from armscope.inference.edits import Edits
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import ModelSpace
from armscope.inference.problem import SelectedEffect


def neighbours(edits: Edits, hypothesis: Hypothesis) -> list[Hypothesis]:
    """Additions; swaps of one effect for another; merges of all effects in one region; splits of curves; and more."""
    whole = condition_on(edits.problem, edits.groups.competing, hypothesis)
    found = edits.additions(hypothesis, edits.branches, least=-BUDGET.slack_nats, remaining=whole)
    for effect in hypothesis.chosen:
        if edits.candidate(effect.candidate).is_curve:
            found += _split(edits, hypothesis, effect)
    for removed in block_removals(edits.space, [c.candidate for c in hypothesis.chosen]):
        # at the noise as it is: without what is taken out the noise would be larger, and fine detail worth nothing
        kept = edits.kept(hypothesis, removed)
        rest = low_rank_update(edits.problem, hypothesis, kept, hypothesis.background)
        assert rest is not None
        least = hypothesis.log_posterior - rest.log_posterior - BUDGET.slack_nats
        found += edits.additions(rest, edits.branches, removed, least, rest.conditioned(whole))
    moves = (_out_of_backgrounds, _into_background, _exchanges)
    return [*found, *(each for move in moves for each in move(edits, hypothesis))]


def block_removals(space: ModelSpace, chosen: Sequence[int]) -> list[tuple[int, ...]]:
    """Which effects are taken out together: each by itself; all of one region; those that pair up."""
    by_region: dict[str, list[int]] = {}
    for number in chosen:
        by_region.setdefault(space.candidates[number].region, []).append(number)
    regions = [tuple(members) for members in by_region.values() if len(members) > 1]
    pairs = [(one, other) for one in chosen for other in chosen if other in space.candidates[one].removed_with]
    return [*((number,) for number in chosen), *regions, *pairs]


def _out_of_backgrounds(edits: Edits, hypothesis: Hypothesis) -> Iterator[Hypothesis]:
    """Less of what everything has a little of, and names for what then stands out."""
    for number, family in enumerate(edits.space.families):
        for size in range(hypothesis.background[number] if family.takes_one or not family.is_priced else 0):
            smaller = edits.with_background(hypothesis, number, size)
            for _ in range(BUDGET.named_at_once):
                larger = edits.additions(smaller, 1, least=0.0)
                if not larger:
                    break
                smaller = larger[0]
            yield smaller


def _into_background(edits: Edits, hypothesis: Hypothesis) -> Iterator[Hypothesis]:
    """A family's background in place of all its names: one of them may pass for what is so everywhere."""
    for number, family in enumerate(edits.space.families):
        members = [c.candidate for c in hypothesis.chosen if edits.candidate(c.candidate).taken_up_by == family.name]
        if family.is_priced and len(members) >= (1 if family.takes_one else 2) and len(family.columns):
            yield from _instead(edits, hypothesis, members, number)


def into_own_family(edits: Edits, hypothesis: Hypothesis) -> Iterator[Hypothesis]:
    """The background of their own family in place of names that look like another one, and of all its own names.

    One link that bends is fewer numbers than all drives that give way a little, and looks like them.
    """
    names = [c.candidate for c in hypothesis.chosen]
    for number, family in enumerate(edits.space.families):
        own = [name for name in names if edits.candidate(name).family == family.name]
        look_like_others = [name for name in own if edits.candidate(name).taken_up_by != family.name]
        if family.is_priced and look_like_others and len(family.columns):
            yield from _instead(edits, hypothesis, own, number)


def _instead(edits: Edits, hypothesis: Hypothesis, names: Sequence[int], family: int) -> Iterator[Hypothesis]:
    """A family's background of any size in the place of some names."""
    rest = edits.without(hypothesis, names)
    for size in range(1, edits.space.families[family].sizes):
        yield edits.with_background(rest, family, size)


def _exchanges(edits: Edits, hypothesis: Hypothesis) -> Iterator[Hypothesis]:
    """Candidates that leave all at once, each for its twin, while one more candidate enters."""
    for exchange in edits.space.exchanges:
        leaving = [c for c in hypothesis.chosen if c.candidate in exchange.twins]
        twins = [(exchange.twins[c.candidate], c.size) for c in leaving]
        entered = [SelectedEffect(twin, size) for twin, size in twins if twin is not None]
        kept = [c for c in hypothesis.chosen if c not in leaving and c.candidate not in exchange.entering]
        for entering in exchange.entering if leaving else ():
            for size in range(1, len(edits.problem.sizes) - 1):
                yield edits.evaluated((*kept, *entered, SelectedEffect(entering, size)), hypothesis)


def _split(edits: Edits, hypothesis: Hypothesis, curve: SelectedEffect) -> list[Hypothesis]:
    """A curve taken apart into special cases that it contains, or into one and something that it took the place of."""
    special = edits.candidate(curve.candidate).special_cases
    if not special:
        return []
    rest = edits.without(hypothesis, [curve.candidate])
    gain, size = best_additions(edits.problem, edits.groups, rest)
    likely = sorted(special, key=lambda c: -gain[c])[: BUDGET.special_cases]
    one = edits.evaluated((*rest.chosen, SelectedEffect(likely[0], int(size[likely[0]]))), rest)
    least = hypothesis.log_posterior - one.log_posterior - BUDGET.slack_nats
    others = edits.additions(one, edits.branches, [curve.candidate], least)
    return [*others, *_special_cases(edits, hypothesis, rest, curve, likely)]


def _special_cases(
    edits: Edits, hypothesis: Hypothesis, rest: Hypothesis, curve: SelectedEffect, likely: Sequence[int]
) -> list[Hypothesis]:
    """Two or three of a curve's special cases in its place, each as large as the curve."""
    sets = [
        tuple(SelectedEffect(c, curve.size) for c in members)
        for count in (2, 3)
        for members in itertools.combinations(likely, count)
        if not any(b in edits.candidate(a).excludes for a, b in itertools.combinations(members, 2))
    ]
    if not sets:
        return []
    promised = joint_addition_scores(edits.problem, rest, sets)
    best = int(np.argmax(promised))
    if rest.log_posterior + promised[best] < hypothesis.log_posterior - BUDGET.slack_nats:
        return []
    return [edits.pruned(edits.evaluated((*rest.chosen, *sets[best]), rest))]
