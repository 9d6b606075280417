"""Laws of one joint's own angle side by side: waves once and twice per turn, a trend, a zero; and what rows leave open.

A gear or an encoder's disc may sit off its centre and be oval, so a joint may have both waves. Over less than a turn a
wave is a trend about another zero: rows may then tell one wave, but not what stands beside it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.curve_shapes import zero_without_load
from armscope.diagnosis.summary.rivals import Rival, discriminability, too_close
from armscope.inference.constants import PRIORS
from armscope.inference.edits import by_posterior
from armscope.inference.evidence import Hypothesis
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, INTERVAL


def stand_together(search: Search, one: int, other: int) -> bool:
    """Whether two effects are laws of one joint's own angle: a further wave may then stand in the other's place.

    Args:
        search: on the problem.
        one: candidate.
        other: candidate.

    Returns:
        Whether one free curve contains both.
    """
    return one != other and any(c.is_curve and {one, other} <= c.special_cases for c in search.space.candidates)


def laws_beside_zero(search: Search, best: Hypothesis, number: int) -> list[Rival]:
    """What could replace a law of a joint's own angle beside that joint's zero or a small wave, which every arm has.

    A wave over less than a turn is a trend about another zero, but for its bend: that is a second wave, far smaller
    than the first. Two names pay more than one, and neither does much alone; but a price is no measurement: where the
    two fit as well, rows do not tell.

    Args:
        search: on the problem.
        best: the chosen hypothesis.
        number: of the law.

    Returns:
        The laws that fit as well, each beside the zero; and the trend beside the other wave.
    """
    effect = search.candidate(number)
    curves = [c for c in search.space.candidates if c.is_curve and c.competes and number in c.special_cases - c.common]
    without, found = search.without(best, [number]), []
    every, smaller = range(len(search.problem.sizes)), range(_size(best, number))
    for curve in curves if len(effect.columns) > 1 else ():
        laws = curve.special_cases - best.candidates - curve.common
        beside = [(zero, every, laws) for zero in curve.common - best.candidates]
        trends = frozenset(law for law in laws if len(search.candidate(law).columns) == 1)
        beside += [(wave, smaller, trends) for wave in laws if search.candidate(wave).key == effect.key]
        for each, sizes, others in beside:
            other = _beside(search, without, [SelectedEffect(each, size) for size in sizes], others)
            misfit = np.inf if other is None else (other.rss - best.rss) / (2 * best.noise**2)
            if other is not None and misfit < INDISTINGUISHABLE_NATS:
                gap = best.log_posterior - other.log_posterior
                if gap <= NAMING.listed_nats_of_special_cases:
                    found.append(Rival(gap, search.candidate(other.chosen[-1].candidate), other, near=True))
    return found


def _size(best: Hypothesis, number: int) -> int:
    """The size (index into the problem's sizes) with which an effect was chosen."""
    return next(c.size for c in best.chosen if c.candidate == number)


def curve_of_waves(search: Search, best: Hypothesis, number: int) -> list[Rival]:
    """The free curve in place of all waves of a gear, if these lead by no more than they were spared as one cause.

    A hose or a cable bends smoothly, too: two waves of any size and phase say most of that.

    Args:
        search: on the problem.
        best: the chosen hypothesis.
        number: of a wave.

    Returns:
        The curve, or none.
    """
    found = []
    for at, curve in enumerate(search.space.candidates):
        waves = curve.as_one & best.candidates
        if not curve.competes or number not in waves or len(waves) < 2:
            continue
        others = set(range(len(search.space.candidates))) - {at}
        for other in search.additions(search.without(best, waves), 1, others):
            spared = PRIORS.excess_special_case_nats * (len(waves) - 1)
            gap = best.log_posterior - other.log_posterior
            if gap - spared < INDISTINGUISHABLE_NATS:
                found.append(Rival(gap, curve, other, near=True, spared=spared))
    return found


def _beside(
    search: Search, base: Hypothesis, sized: Sequence[SelectedEffect], laws: Collection[int]
) -> Hypothesis | None:
    """The likeliest law beside an effect of one of some sizes: what does nothing alone may be large beside a trend."""
    others = set(range(len(search.space.candidates))) - set(laws)
    beside = (search.evaluated((*base.chosen, each), base) for each in sized)
    found = (law for each in beside for law in search.additions(each, 1, others))
    return max(found, key=by_posterior, default=None)


def doubts_of_laws(search: Search, best: Hypothesis, rivals: Mapping[int, Sequence[Rival]]) -> dict[int, Array]:
    """What the covariance of a law's values gains where another law of its joint could be a third one; of no curve.

    A zero's gains what a curve of its joint's load could hold of it.

    Args:
        search: on the problem.
        best: the chosen hypothesis.
        rivals: of each of its effects.

    Returns:
        By candidate, (k, k) in SI units: as much as its interval needs to reach the value that it has beside the rival.
    """
    scale, gained = search.problem.scale, {}
    for number in (n for n in best.candidates if not search.candidate(n).is_curve):
        columns = search.candidate(number).columns
        told, extra = best.means(columns), np.zeros((len(columns), len(columns)))
        for rival in _unsettled_beside(search, best, number, rivals):
            away = (rival.hypothesis.means(columns) - told) / scale[columns] / INTERVAL
            extra += np.outer(away, away)
        if (
            at_rest := zero_without_load(search.problem, best, number)
        ) is not None:  # a curve of load may hold the rest
            extra += ((at_rest[0] - told) / scale[columns] / INTERVAL) ** 2
        gained[number] = extra
    return gained


def _unsettled_beside(
    search: Search, best: Hypothesis, number: int, rivals: Mapping[int, Sequence[Rival]]
) -> list[Rival]:
    """Rivals of a law's neighbours that rows do not tell from those, and beside which the law still stands."""
    beside = [other for other in best.candidates if stand_together(search, other, number)]
    found = []
    for other in beside:
        effect, some = search.candidate(other), rivals.get(other, ())
        apart = [discriminability(best, rival.hypothesis, effect, rival.candidate) for rival in some]
        close = too_close(effect, some, apart)
        found += [rival for rival in some if rival.candidate in close and number in rival.hypothesis.candidates]
    return found
