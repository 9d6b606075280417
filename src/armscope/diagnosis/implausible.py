"""Names whose fitted values no arm can have: what pushes against its load, and what something else takes back.

What is merely larger than arms show gives way to a name that explains the rows as well.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from armscope.diagnosis.constants import LOOP
from armscope.diagnosis.model_space import EffectSpace
from armscope.fitting.refit import Refit
from armscope.inference.constants import PRIORS
from armscope.inference.evidence import Hypothesis
from armscope.inference.normal_equations import projected_rms
from armscope.inference.problem import Problem, SelectedEffect
from armscope.inference.search import Search
from armscope.physics.effect import Part
from armscope.physics.tilting import TWO_AXES, stiffest_of_two


def without_implausible(
    problem: Problem, space: EffectSpace, hypothesis: Hypothesis, refit: Callable[[Hypothesis], Refit]
) -> tuple[Hypothesis, Refit]:
    """A hypothesis without the names that don't stand once they are fitted with the exact model.

    Args:
        problem: the sums that the names were chosen on.
        space: which effect each candidate is.
        hypothesis: with the names.
        refit: makes the exact fit of a hypothesis.

    Returns:
        What is left of it, and its fit.
    """
    fit, search = refit(hypothesis), Search.on(problem)
    tried: set[int] = set()
    while True:
        while pushing := _pushing(space, hypothesis, fit):
            hypothesis = search.without(hypothesis, pushing)
            fit = refit(hypothesis)
        untried = [candidate for candidate in _taken_back(problem, space, hypothesis, fit) if candidate not in tried]
        if not untried:
            return hypothesis, fit
        tried.add(untried[0])
        rest = search.without(hypothesis, untried[:1])
        fitted = refit(rest)
        if fitted.noise < LOOP.taken_back * fit.noise and _distance(fitted) < LOOP.nearer * _distance(fit):
            hypothesis, fit = rest, fitted


def _distance(fit: Refit) -> float:
    """How far an arm is from any that was built: the sum of squares of all its values in plausible sizes.

    What two names, or a name and the background, take back from each other is gone once one of them goes. A value that
    the rows hold is there without its name, too.
    """
    parts = (*fit.model.parts, *fit.model.background)
    values = [(each, value) for part in parts for each, value in zip(part.placed.terms, part.values, strict=True)]
    return float(sum((value / term.plausible) ** 2 for term, value in values if np.isfinite(term.plausible)))


def _pushing(space: EffectSpace, hypothesis: Hypothesis, fit: Refit) -> list[int]:
    """Candidates of the names that push against what they give way to."""
    parts = zip(hypothesis.chosen, fit.model.parts, strict=True)
    return [chosen.candidate for chosen, part in parts if _against_its_load(space, chosen, part, fit)]


def _taken_back(problem: Problem, space: EffectSpace, hypothesis: Hypothesis, fit: Refit) -> list[int]:
    """Candidates of the names that something else may take back: larger than arms show, and than the tool misses.

    A link that is 30 mm too long shows at the tool. Where less is seen, other causes may take the rest back, each of
    them as far from any arm that was built: a way to write the rows, and nothing that somebody could find and mend.
    """
    parts = zip(hypothesis.chosen, fit.model.parts, strict=True)
    return [chosen.candidate for chosen, part in parts if _moves_more(problem, space, part)]


def more_plausible(
    problem: Problem, hypothesis: Hypothesis, fit: Refit, refit: Callable[[Hypothesis], Refit]
) -> tuple[Hypothesis, Refit]:
    """Another name in the place of one whose values are larger than arms show, where it explains the rows as well.

    Args:
        problem: the sums that the names were chosen on.
        hypothesis: with the names.
        fit: its exact fit.
        refit: makes the exact fit of a hypothesis.

    Returns:
        A hypothesis and its fit: those given, if there is none that is better in this.
    """
    for chosen, part in zip(hypothesis.chosen, fit.model.parts, strict=True):
        if not part.implausible or chosen.nested:
            continue
        search = Search.on(problem)
        rest = search.without(hypothesis, [chosen.candidate])
        for other in search.additions(rest, search.branches, [chosen.candidate]):
            if other.log_posterior > hypothesis.log_posterior - PRIORS.sure_nats:
                fitted = refit(other)
                if _implausible_names(fitted) < _implausible_names(fit):
                    return other, fitted
    return hypothesis, fit


def _implausible_names(fit: Refit) -> int:
    return sum(bool(part.implausible) for part in fit.model.parts)


def _against_its_load(space: EffectSpace, chosen: SelectedEffect, part: Part, fit: Refit) -> bool:
    """Whether what can only give way pushes: in a background, or surely about one of two axes."""
    if chosen.nested and space.nonnegative[chosen.candidate] and part.values[0] < 0:
        return True
    if not part.placed.variant.startswith(TWO_AXES) or len(part.values) < 3:
        return False
    pushing, stderr = stiffest_of_two(part.values[:3], fit.covariance_of(part.placed)[:3, :3])
    return pushing < -LOOP.surely_negative * stderr


def _moves_more(problem: Problem, space: EffectSpace, part: Part) -> bool:
    """Whether values are larger than arms show, and would move the tool by more than it misses."""
    if not part.implausible:
        return False
    columns = space.layout.of(part.placed)  # a length that another row tells is no term of it
    coefficients = np.zeros(len(problem.scale))
    coefficients[columns] = part.values * problem.scale[columns]
    return projected_rms(problem.equations, problem.space.frames, coefficients) > problem.mismatch
