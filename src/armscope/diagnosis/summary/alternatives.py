"""How sure: what else could stand in an effect's place, how often it is chosen when rows are resampled."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.curve_shapes import DRIVE, rest_of
from armscope.diagnosis.held_out_worth import held_out_errors
from armscope.diagnosis.naming import named
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.laws_of_one_joint import curve_of_waves, laws_beside_zero, stand_together
from armscope.diagnosis.summary.rivals import Rival
from armscope.diagnosis.summary.turning_tilts import is_a_turned_link
from armscope.inference.confidence_set import confidence_set
from armscope.inference.constants import BUDGET, PRIORS
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import Candidate
from armscope.inference.normal_equations import weighted_total
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.physics.geometric import JOINT_OFFSET, LINK_GEOMETRY
from armscope.physics.wobble import RUNS_OUT
from armscope.verdict.effects import Alternative, Specific
from armscope.verdict.wording import effect_in_words, places_in_words

CONSTANT_GEOMETRY = (JOINT_OFFSET.name, LINK_GEOMETRY.name)


def alternatives(search: Search, best: Hypothesis) -> dict[int, list[Rival]]:
    """What could replace each effect, by its candidate: nearest first, each name once.

    What got its name out of a background is rivalled by what could be out of the ordinary instead, its own values held
    right; what is in a background, too, pays as little for its name. A line taken from a curve of load is rivalled by
    what rivals the curve, and by what could stand beside the curve's rest; a curve of another drive's load is told as
    its compliance. What would be worth as much beside the effect takes no place of it: held-out rows have refused it.
    """
    refused = _Refused(search, best, none=not search.additions(best, 1, least=0.0))
    return {c.candidate: _of_one(search, best, c.candidate, refused) for c in best.chosen}


@dataclass(eq=False)
class _Refused:
    """What effects would gain beside all that were chosen, had held-out rows not refused them; ``none`` were."""

    search: Search
    best: Hypothesis
    none: bool
    known: dict[tuple[SelectedEffect, bool], float] = field(default_factory=dict)

    def gain(self, effect: SelectedEffect, of_background: bool) -> float:
        """Nats; what is in a background, too, pays nothing for its name."""
        if self.none:
            return 0.0
        if (effect, of_background) not in self.known:
            added = self.search.evaluated((*self.best.chosen, effect), self.best)
            added = self.search.unpaid(added) if of_background else added
            self.known[effect, of_background] = max(added.log_posterior - self.best.log_posterior, 0.0)
        return self.known[effect, of_background]


def _of_one(search: Search, best: Hypothesis, number: int, refused: _Refused) -> list[Rival]:
    """What could replace one effect."""
    candidate, rest = search.candidate(number), rest_of(search.problem, best, number)
    explained_anyway = search.in_background(best, number)
    paid = _price_of_curve(search, candidate) if rest and candidate.kind == DRIVE else 0.0
    rivals = _in_place_of(search, best, number, rest, paid, refused)
    rivals += [*laws_beside_zero(search, best, number), *curve_of_waves(search, best, number)]
    if rest and not explained_anyway:
        alone = _in_place_of(search, best, number, [], 0.0, refused)
        rivals += [rival for rival in alone if not rival.candidate.is_curve]
    if candidate.kind in CONSTANT_GEOMETRY:
        rivals = [rival._replace(same_motion=is_a_turned_link(search.problem, rival)) for rival in rivals]
    nearest: dict[tuple[str, str], Rival] = {}
    for rival in sorted(rivals, key=lambda rival: rival.gap):
        nearest.setdefault(rival.candidate.key, rival)
    return list(nearest.values())


def _in_place_of(
    search: Search, best: Hypothesis, number: int, rest: Sequence[int], paid: float, refused: _Refused
) -> list[Rival]:
    """What could replace an effect together with the rest of its curve, or alone; ``paid``: the curve's price, nats."""
    candidate, found = search.candidate(number), []
    explained_anyway = search.in_background(best, number)
    held: tuple[int, ...] = ()
    if explained_anyway and not rest:
        held = tuple(int(column) for column in candidate.held)
        search = search.holding(candidate.held)
    base, likeness = search.without(best, [number, *rest]), best.log_posterior
    if held:  # a name that had paid before its background was there is weighed at the price of its rivals there: none
        likeness = max(likeness, _at_no_price(search, best, number).log_posterior)
    taken = {search.candidate(c).key for c in best.candidates if not stand_together(search, c, number)}
    lines = {c.location: c for c in search.space.candidates if c.kind == DRIVE and not c.variant}
    # what a coarse prediction puts far behind is not weighed
    lost = best.log_posterior - base.log_posterior
    least = lost - paid - NAMING.listed_nats_of_special_cases - NAMING.coarsely * max(lost, 0.0) - BUDGET.slack_nats
    for added in search.additions(base, NAMING.looked_at, [number], least):
        of_background = held and search.in_background(added, added.chosen[-1].candidate)
        other = search.unpaid(added) if of_background else added
        rival, own = search.candidate(other.chosen[-1].candidate), refused.gain(added.chosen[-1], bool(of_background))
        gap = (likeness if of_background else best.log_posterior) - other.log_posterior - paid + own
        excluded = other.chosen[-1].candidate in candidate.excludes
        misfit = (other.rss - best.rss) / (2 * best.noise**2)
        # an axis that runs out anyhow has eight numbers, and imitates much
        asks = not rival.variant.endswith(RUNS_OUT)
        alike = asks and misfit < NAMING.alike_nats and _is_other(candidate, rival)
        as_likely = (candidate.is_curve and excluded) or alike
        near = gap <= (NAMING.listed_nats_of_special_cases if as_likely else NAMING.listed_nats)
        asks = asks and misfit < NAMING.listed_nats and not rival.is_curve
        asked = asks and gap <= NAMING.listed_nats_of_special_cases
        if (rest and excluded) or rival.key in taken or _is_more_than(candidate, rival) or not (near or asked):
            continue
        worth = PRIORS.sure_nats if explained_anyway or own else 0.0
        if other.log_posterior - own < base.log_posterior + worth:
            continue  # it explains nothing of what the effect does: nothing at all is likelier in its place
        if rest and rival.variant == "load" and rival.is_curve:
            rival = lines.get(rival.location, rival)
        found.append(Rival(gap, rival, other, near, held))
    return found


def _at_no_price(search: Search, best: Hypothesis, number: int) -> Hypothesis:
    """A hypothesis with an effect as a name out of its background."""
    chosen = tuple(replace(c, nested=True) if c.candidate == number else c for c in best.chosen)
    return best if chosen == best.chosen else search.evaluated(chosen, best)


def _is_more_than(effect: Candidate, rival: Candidate) -> bool:
    """Whether a rival with a name is the effect and something beside: as likely wherever that may be nothing."""
    return not rival.is_curve and set(effect.columns) < set(rival.columns)


def _is_other(effect: Candidate, rival: Candidate) -> bool:
    """Whether a rival has a name, and does not contain the effect."""
    return not (rival.is_curve or set(effect.columns) <= set(rival.columns))


def _price_of_curve(search: Search, line: Candidate) -> float:
    """What the curve that a line was taken from cost, nats: its names were free."""
    curves = [n for n in line.excludes if search.candidate(n).is_curve]
    return search.problem.cost(curves[0]) if curves else 0.0


def judged_elsewhere(
    state: DiagnosisState, rivals: Mapping[int, Sequence[Rival]], rng: np.random.Generator
) -> dict[int, list[Rival]]:
    """The rivals of each effect that are near, or that rows that took no part do not exclude at 95 %.

    Args:
        state: the finished selection.
        rivals: by candidate.
        rng: draws blocks of rows.

    Returns:
        Those rivals, judged; those of one effect and the chosen hypothesis compete for one confidence set.
    """
    nearest = sorted((rival for some in rivals.values() for rival in some), key=lambda rival: rival.gap)
    asked = {id(rival) for rival in nearest[: NAMING.asked_elsewhere]}
    rivals = {n: [rival for rival in some if rival.near or id(rival) in asked] for n, some in rivals.items()}
    every = [rival for some in rivals.values() for rival in some if id(rival) in asked]
    errors = _held_out_errors(state, every)
    judged, at = {}, 1
    for number, some in rivals.items():
        those = [rival for rival in some if id(rival) in asked]
        inside = confidence_set(errors[:, [0, *range(at, at + len(those))]], rng)[1:]
        excluded = {id(rival): not bool(i) for rival, i in zip(those, inside, strict=True)}
        known = [rival._replace(excluded=excluded.get(id(rival))) for rival in some]
        judged[number] = [rival for rival in known if rival.near or not rival.excluded]
        at += len(those)
    return judged


def _held_out_errors(state: DiagnosisState, rivals: Sequence[Rival]) -> Array:
    """(blocks, 1 + rivals) mm^2 that the chosen hypothesis and its rivals leave of held-out blocks."""
    every = [((), state.best), *((rival.held, rival.hypothesis) for rival in rivals)]
    errors = np.zeros((len(state.blocks), len(every)))
    for held in dict.fromkeys(held for held, _ in every):
        those = [n for n, (columns, _) in enumerate(every) if columns == held]
        readings = [(every[n][1].chosen, every[n][1].background) for n in those]
        problem = state.problem.holding(np.array(held, dtype=np.intp))
        errors[:, those] = held_out_errors(problem, state.blocks, readings, state.best.noise)
    return errors


def listed(found: Sequence[Rival], apart: Sequence[float]) -> tuple[Alternative, ...]:
    """Alternatives as a verdict lists them; ``apart``: the `discriminability` of each."""
    return tuple(
        Alternative(
            c.kind, c.location, c.family, float(rival.gap), c.driver, float(nats), rival.excluded, rival.same_motion
        )
        for rival, c, nats in zip(found, (rival.candidate for rival in found), apart, strict=True)
    )


def specific_name(effect: Candidate, rivals: Sequence[Candidate]) -> tuple[Specific, str]:
    """How specific the name may be, and the name in words, given the rivals that cannot be told apart from it."""
    if not rivals and effect.is_curve:
        return "effect", f"an unknown error at {effect.location} that follows the {effect.driver}"
    if not rivals:
        return "effect", effect_in_words(effect.kind, effect.location)
    together = [effect, *rivals]
    regions = sorted({c.region for c in together})
    families = sorted({c.family for c in together})
    kinds = list(dict.fromkeys((c.kind, c.location) for c in together))
    at_one_place = len({c.location for c in together}) == 1 < len(kinds)
    if len(families) > 1 or at_one_place:
        return "region", " or ".join(effect_in_words(*kind) for kind in kinds[:3])
    if len(regions) == 1 or _adjacent(regions):
        return "region", f"{families[0]}, around {_places(regions)}"
    return "family", f"{families[0]}, somewhere around {_places(regions)}"


def _adjacent(regions: Sequence[str]) -> bool:
    """Whether regions lie beside each other along the arm; the base lies beside joint 1."""
    numbers = sorted(0 if r == "base" else int(r) for r in regions if r == "base" or r.isdigit())
    return len(numbers) == len(regions) and all(b - a <= 1 for a, b in itertools.pairwise(numbers))


def _places(regions: Sequence[str]) -> str:
    return places_in_words([f"joint {r}" if r.isdigit() else r for r in regions])


def inclusion_frequency(state: DiagnosisState, draws: int, rng: np.random.Generator) -> dict[int, float]:
    """How often each chosen effect's place is chosen again when blocks of rows are drawn with replacement.

    A block that is drawn twice repeats to the last digit, which no noise does: that of all rows is the least.
    Hypotheses of many columns (several free curves) are looked for with coarse curves, and without a local search.

    Args:
        state: the finished selection.
        draws: how often.
        rng: draws them.

    Returns:
        Share of the draws, by candidate.
    """
    best, blocks = state.best, state.blocks
    if not blocks or not best.chosen or not draws:
        return {}
    places = {c: state.space.candidates[c].key for c in best.candidates}
    hits = dict.fromkeys(best.candidates, 0)
    problem = replace(state.problem, least_noise=max(state.problem.least_noise, best.noise))
    for _ in range(draws):
        times = np.bincount(rng.integers(0, len(blocks), len(blocks)), minlength=len(blocks))
        search = Search.on(problem.with_equations(weighted_total(blocks, times)), beam=1, branches=2)
        found = search.best((best.background,), search.coarsened(state.found), local=len(best.columns) <= BUDGET.large)
        again = {state.space.candidates[c].key for c in named(search, state.space, found).candidates}
        for candidate, place in places.items():
            hits[candidate] += place in again
    return {candidate: count / draws for candidate, count in hits.items()}
