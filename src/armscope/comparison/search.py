"""Which changes together explain what differs: taken in one by one, then each tried without.

When several causes changed at once, the one that explains most by itself need not be one of them: a wave or a load of
many numbers stands for parts of all. So no step is final. What is not sure beside those that came after it is left out
again, and for each one, and each two, it is tried whether others in their place make the rows likelier: of two causes
that stand for two others, neither is worse than what could take its place alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from armscope.comparison.constants import COMPARING
from armscope.comparison.scoring import Possible, Scored
from armscope.comparison.shared_model import SharedModel
from armscope.verdict.effects import INDISTINGUISHABLE_NATS


def likeliest_changes(model: SharedModel, possible: Sequence[Possible], tried: int) -> list[Possible]:
    """The changes that are sure beside each other, of which none is better left out or exchanged.

    Args:
        model: what recordings share.
        possible: the changes that may be named.
        tried: how many there were to choose from, for which each must be the surer (Bonferroni).

    Returns:
        None, or up to `COMPARING.changes`.
    """
    taken = _sure_together(model, possible, [], tried)
    seen, exchanged = {frozenset(taken)}, True
    while exchanged:
        exchanged = False
        for out in _left_out(taken):
            allowed, start = ([each for each in those if each not in out] for those in (possible, taken))
            other = _sure_together(model, allowed, start, tried)
            if other and frozenset(other) not in seen and _is_better(model, other, taken):
                taken, exchanged = other, True
                seen.add(frozenset(other))
                break
    return taken


def _is_better(model: SharedModel, other: Sequence[Possible], taken: Sequence[Possible]) -> bool:
    """Whether other changes make the rows likelier; of what the rows do not tell apart, fewer numbers are better."""
    gained = model.evidence(other) - model.evidence(taken)
    more = sum(len(each.placed.terms) for each in other) - sum(len(each.placed.terms) for each in taken)
    least = COMPARING.better_nats if more == 0 else INDISTINGUISHABLE_NATS * (1 if more > 0 else -1)
    return gained > least


def _left_out(taken: Sequence[Possible]) -> Iterator[tuple[Possible, ...]]:
    """What is tried without: nothing, each one, each two."""
    for many in range(min(len(taken), 2) + 1):
        yield from combinations(taken, many)


def _sure_together(
    model: SharedModel, possible: Sequence[Possible], start: Sequence[Possible], tried: int
) -> list[Possible]:
    """Changes that are sure beside others are added, the likeliest first; then those that no more are go again."""
    taken = list(start)
    while len(taken) < COMPARING.changes and (rest := [each for each in possible if each not in taken]):
        scores = model.scores(rest, taken)
        sure = [each for each, score in enumerate(scores) if score.p * tried <= COMPARING.level]
        if not sure:
            break
        taken.append(rest[_simplest(scores, sure)])
    while taken:
        beside = [model.scores([each], [e for e in taken if e is not each])[0] for each in taken]
        unsure = [each for each, score in enumerate(beside) if score.p * tried > COMPARING.level]
        if not unsure:
            break
        taken.pop(min(unsure, key=lambda each: beside[each].nats))
    return taken


def _simplest(scores: Sequence[Scored], among: Sequence[int]) -> int:
    """The likeliest; of those that the rows do not tell from it, the one of the fewest numbers."""
    best = max(scores[each].nats for each in among)
    near = [each for each in among if scores[each].nats > best - INDISTINGUISHABLE_NATS]
    return min(near, key=lambda each: (scores[each].statistic.q, -scores[each].nats))


def as_steps(taken: Sequence[Possible], possible: Sequence[Possible]) -> list[Possible]:
    """The same changes, those of one effect as steps from one of the recordings on where these are as many.

    A zero that wears on is larger in each recording than in the one before. "From the third on" and "in the second
    alone" say the same of three recordings, but the second has less of it than the third, and seemed repaired.
    """
    told = list(taken)
    for number in dict.fromkeys(each.number for each in taken):
        alike = [each for each in taken if each.number == number]
        steps = _steps(alike, [each for each in possible if each.number == number])
        if len(alike) > 1 and len(steps) == len(alike):
            told = [each for each in told if each.number != number] + steps
    return told


def _steps(alike: Sequence[Possible], possible: Sequence[Possible]) -> list[Possible]:
    """From each recording on that has not what the one before it has; none where one of them may not be named."""
    family = sorted({*alike[0].sets, *alike[0].against})
    if any(sorted({*each.sets, *each.against}) != family for each in alike):
        return []
    states = [tuple(k in each.sets for each in alike) for k in family]
    later = [tuple(family[at:]) for at in range(1, len(family)) if states[at] != states[at - 1]]
    found = {each.sets: each for each in possible if each.sets in later}
    return [found[sets] for sets in later] if len(found) == len(later) else []
