"""What gravity explains as well that leans from its stated direction: a base on a wedge, a stand that is not level.

What gives way in an arm on a wedge gives way beside its stated load, in step with the first joint's angle, and so do
a bearing that tilts, a gear off its centre and a base that gives way. Gravity's direction is no effect that competes:
it is stated. So every name is asked whether gravity that leans does as well in its place, through what gives way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.constants import TELLING
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.parameter_layout import current_parameters
from armscope.inference.constants import PRIORS
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import Candidate
from armscope.inference.normal_equations import column_scales
from armscope.inference.problem import Problem, SelectedEffect
from armscope.physics.effect import Part, Placed, Term
from armscope.physics.loads import STATED_MASSES, givings, gravity_that_leans
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import INDISTINGUISHABLE_NATS, Alternative, FoundEffect

LOOK_AT_THE_LEVEL = (
    "See first whether the base stands level: joints that give way to gravity that leans from what robot.yaml states "
    "do the same (`armscope diagnose --estimate-gravity` tells how it leans)."
)
LEVEL_IT = (
    "Level the base, or state how gravity leans (gravity_m_s2), and diagnose again before anything is changed here. "
    "Only if it is told again:"
)


def told_by_gravity(state: DiagnosisState) -> dict[int, Alternative]:
    """Gravity that leans, as the alternative of every effect in whose place it does as well; by candidate.

    Args:
        state: the finished selection.

    Returns:
        Alternatives; none where nothing that gives way is known, or motors' torques tell its load.
    """
    asked = [c for c in state.best.chosen if not c.nested and _may_be(state.space.placed[c.candidate])]
    fitted = [p for p in (*state.fit.model.background, *state.fit.model.parts) if _bears(p)]
    known = list(givings(fitted, state.recordings.torque is not None))
    if not asked or not known or not state.start.arm.has_masses:
        return {}
    problem = _with_terms(state, gravity_that_leans(known))
    told = evaluate(problem, state.best.chosen, state.best.background, state.best.noise)
    found = {}
    for effect in asked:
        others = [c for c in state.best.chosen if c is not effect]
        leaning = max(_leaning(problem, told, others), key=lambda each: each.log_posterior)
        gap = told.log_posterior - leaning.log_posterior
        if gap < INDISTINGUISHABLE_NATS:
            found[effect.candidate] = Alternative(
                "leaning_gravity", "base", "elastic", float(gap), "direction of gravity", float(max(gap, 0.0))
            )
    return found


def better_than_a_name(verdict: Diagnosis) -> FoundEffect | None:
    """The effect that gravity that leans betters by most, at odds of 20 to 1 at least; None where it betters none."""
    gaps = {
        other.evidence_gap_nats: effect
        for effect in verdict.effects
        for other in effect.alternatives
        if other.effect == "leaning_gravity"
    }
    least = min(gaps, default=0.0)
    return gaps[least] if least < -PRIORS.sure_nats else None


def _may_be(placed: Placed) -> bool:
    """Whether gravity that leans may look like an effect: curves follow anything, and loads are what it acts on."""
    return placed.parametrisation != "curve" and not placed.effect.requires and placed.effect.name != "link_geometry"


def _bears(part: Part) -> bool:
    """Whether a part of the model holds what gives way, and not an error of the loads."""
    return part.placed.effect is not STATED_MASSES and not part.placed.effect.requires


def _with_terms(state: DiagnosisState, terms: Sequence[Term]) -> Problem:
    """The problem with a further candidate of some terms, on rows spread evenly; other columns' sums are left out."""
    layout, space, best = state.space.layout, state.space, state.best
    joined = [c.family.columns for c in space.companions if c.joins(best.candidates, best.background)]
    held = np.flatnonzero(current_parameters(layout, state.point))
    asked = np.unique(np.concatenate([best.columns, held, *joined])).astype(np.intp)
    few, count = layout.only(asked), len(layout.terms)
    few = replace(few, terms=(*few.terms, *terms))
    rows = spread_evenly(len(state.recordings), TELLING.homogeneity_rows)
    table, weights = state.recordings.rows(rows), state.fit.weights.take(rows)
    (sums,) = normal_equations_by_block(few, state.point, table, weights, np.zeros(len(rows), dtype=np.intp))
    own = np.arange(count, count + len(terms))
    sums = sums.among(np.concatenate([asked, own]), count + len(terms))
    scale = np.append(state.problem.scale, column_scales(sums, space.frames)[own])
    gravity = Candidate("leaning_gravity", "base", own, np.ones(len(own)), family="elastic")
    price = PRIORS.sure_nats + np.log(space.kinds)
    return replace(
        state.problem,
        space=replace(space, candidates=(*space.candidates, gravity)),
        equations=sums.scaled(scale),
        scale=scale,
        prior_costs=np.append(state.problem.prior_costs, price),
    )


def _leaning(problem: Problem, told: Hypothesis, others: Sequence[SelectedEffect]) -> Iterator[Hypothesis]:
    """Some effects beside gravity that leans, by any size."""
    number = len(problem.space.candidates) - 1
    for size in range(len(problem.sizes)):
        yield evaluate(problem, (*others, SelectedEffect(number, size)), told.background, told.noise, told)
