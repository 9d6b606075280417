"""How sure: what else could stand in an effect's place, how often it is chosen when rows are resampled."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from armscope.diagnosis.promotion import named, rest_of
from armscope.inference.evidence import Hypothesis, Problem
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.search import LARGE, SLACK_NATS, Search
from armscope.physics.effect import Placed, region
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.verdict.schema import Alternative, Specific

LISTED_NATS = 10.0
"""Alternatives that lose more evidence than this are not listed."""
LISTED_NATS_OF_SPECIAL_CASES = 40.0
"""A curve's special cases are listed farther: most of it may be one of them."""
INDISTINGUISHABLE_NATS = 3.0
"""Evidence of 20 to 1: two readings closer than this are both named."""
LOOKED_AT = 12
COARSELY = 0.25
"""Where taking an effect out costs much, the noise is another one without it: predictions miss less than this share."""


def alternatives(search: Search, best: Hypothesis, candidate: int) -> list[tuple[float, Placed, Hypothesis]]:
    """(gap in nats, effect, hypothesis) of what could replace one effect, nearest first, each name once.

    None where a background holds the effect, too: without the name, the background explains the same. A line taken from
    a curve of load is rivalled by what rivals the curve; a curve of another drive's load is told as its compliance.
    """
    rest = rest_of(search.problem, best, candidate)
    if search.in_background(best, candidate) and not rest:
        return []
    base = search.without(best, [candidate, *rest])
    taken = {search.placed(c).key for c in best.candidates}
    nearest: dict[tuple[str, str], tuple[float, Placed, Hypothesis]] = {}
    paid = _price_of_curve(search, candidate) if rest else 0.0
    lines = {p.location: p for p in search.problem.pool.candidates if p.effect is JOINT_COMPLIANCE and not p.variant}
    # what a coarse prediction puts far behind is not weighed
    listed_nats = LISTED_NATS_OF_SPECIAL_CASES if search.placed(candidate).parametrisation == "curve" else LISTED_NATS
    lost = best.log_posterior - base.log_posterior
    least = lost - paid - listed_nats - COARSELY * max(lost, 0.0) - SLACK_NATS
    for other in search.additions(base, LOOKED_AT, [candidate], least):
        placed = search.placed(other.chosen[-1].candidate)
        gap = best.log_posterior - other.log_posterior - paid
        curve = search.placed(candidate).parametrisation == "curve"
        special = curve and other.chosen[-1].candidate in search.problem.pool.excludes[candidate]
        same = bool(rest) and other.chosen[-1].candidate in search.problem.pool.excludes[candidate]
        if same or placed.key in taken or gap > (LISTED_NATS_OF_SPECIAL_CASES if special else LISTED_NATS):
            continue
        if rest and placed.variant == "load" and placed.parametrisation == "curve":
            placed = lines.get(placed.location, placed)
        if placed.key not in nearest or gap < nearest[placed.key][0]:
            nearest[placed.key] = (gap, placed, other)
    return sorted(nearest.values(), key=lambda entry: entry[0])


def _price_of_curve(search: Search, line: int) -> float:
    """What the curve that a line was taken from cost, nats: its names were free."""
    problem = search.problem
    curves = [n for n in problem.pool.excludes[line] if problem.pool.candidates[n].parametrisation == "curve"]
    return float(problem.prior_costs[curves[0]] + np.log(len(problem.sizes))) if curves else 0.0


def discriminability(best: Hypothesis, other: Hypothesis, effect: Placed, rival: Placed) -> float:
    """Nats by which the data tell an effect and its rival apart.

    The evidence also holds what a rival of one parameter more (a wave of free phase) pays for it; where the two fit
    alike, that is no measurement: such a rival counts by its fit alone. Larger ones fit anything and count in full.
    """
    gap = best.log_posterior - other.log_posterior
    if len(rival.terms) > len(effect.terms) + 1:
        return gap
    return min(gap, max((other.rss - best.rss) / (2 * best.noise**2), 0.0))


def listed(found: Sequence[tuple[float, Placed, Hypothesis]]) -> tuple[Alternative, ...]:
    """Alternatives as a verdict lists them."""
    return tuple(
        Alternative(placed.name, placed.location, placed.family, float(gap), placed.driver) for gap, placed, _ in found
    )


def name(placed: Placed, rivals: Sequence[Placed]) -> tuple[Specific, str]:
    """How specific the name may be, and the name in words, given the rivals that cannot be told apart from it."""
    if not rivals and placed.parametrisation == "curve":
        return "effect", f"an unknown error at {placed.location} that follows the {placed.driver}"
    if not rivals:
        return "effect", f"{_words(placed.name)} at {placed.location}"
    together = [placed, *rivals]
    regions = sorted({region(p) for p in together})
    families = sorted({p.family for p in together})
    if len(families) > 1:
        return "region", " or ".join(f"{_words(p.name)} at {p.location}" for p in together[:3])
    if len(regions) == 1 or _adjacent(regions):
        return "region", f"{families[0]}, around {_places(regions)}"
    return "family", f"{families[0]}, somewhere around {_places(regions)}"


def _adjacent(regions: Sequence[str]) -> bool:
    """Whether regions lie beside each other along the arm; the base lies beside joint 1."""
    numbers = sorted(0 if r == "base" else int(r) for r in regions if r == "base" or r.isdigit())
    return len(numbers) == len(regions) and all(b - a <= 1 for a, b in itertools.pairwise(numbers))


def _places(regions: Sequence[str]) -> str:
    return ", ".join(f"joint {r}" if r.isdigit() else r for r in regions)


def _words(effect: str) -> str:
    return effect.replace("_", " ")


def inclusion_frequency(
    problem: Problem,
    blocks: Sequence[NormalEquations],
    best: Hypothesis,
    found: Hypothesis,
    draws: int,
    rng: np.random.Generator,
) -> dict[int, float]:
    """How often each chosen effect's place is chosen again when blocks of rows are drawn with replacement.

    Hypotheses of many columns (several free curves) are looked for with coarse curves, and their ends not polished.

    Args:
        found: the best hypothesis before names were given within its backgrounds and curves.
    """
    if not blocks or not best.chosen:
        return {}
    places = {c: _place(problem.pool.candidates[c]) for c in best.candidates}
    hits = dict.fromkeys(best.candidates, 0)
    large = len(best.columns) > LARGE
    for _ in range(draws):
        times = np.bincount(rng.integers(0, len(blocks), len(blocks)), minlength=len(blocks))
        gram = _weighted(blocks, times)
        search = Search.on(problem.with_equations(gram), beam=1, branches=2)
        again = named(search, search.best(starts=(best.background,), also=search.coarsened(found), polished=not large))
        places_again = {_place(problem.pool.candidates[c]) for c in again.candidates}
        for candidate, place in places.items():
            hits[candidate] += place in places_again
    return {candidate: count / draws for candidate, count in hits.items()}


def _place(placed: Placed) -> tuple[str, str]:
    return placed.key


def _weighted(blocks: Sequence[NormalEquations], times: np.ndarray) -> NormalEquations:
    drawn = [int(k) for k in np.flatnonzero(times)]
    G = sum(times[k] * blocks[k].G for k in drawn)
    b = sum(times[k] * blocks[k].b for k in drawn)
    return NormalEquations(
        np.asarray(G),
        np.asarray(b),
        float(sum(times[k] * blocks[k].yy for k in drawn)),
        float(sum(times[k] * blocks[k].n for k in drawn)),
    )
