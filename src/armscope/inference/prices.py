"""What a hypothesis pays for its effects and backgrounds before the rows speak."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import log_ndtr

from armscope.core.types import Array
from armscope.inference.constants import PRIORS
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.problem import Problem, SelectedEffect


def half_line_columns(problem: Problem, chosen: Sequence[SelectedEffect]) -> list[int]:
    """Columns of the effects, named for themselves, whose one coefficient can't be negative."""
    candidates = (problem.space.candidates[effect.candidate] for effect in chosen if not effect.nested)
    return [int(candidate.columns[0]) for candidate in candidates if candidate.nonnegative]


def negative_log_prior(
    problem: Problem, chosen: Sequence[SelectedEffect], background: BackgroundSizes, z_scores: Array
) -> float:
    """What a hypothesis pays for its effects and backgrounds, nats; infinite if some effect lacks what it requires.

    Args:
        problem: the priors.
        chosen: the effects.
        background: size of each family's background.
        z_scores: standard errors from zero of each effect's value that can't be negative; half of the prior goes to
            the other half, each by itself.

    Returns:
        Nats.
    """
    own = [c for c in chosen if not c.nested]
    if not problem.space.requirements_met(frozenset(c.candidate for c in chosen)):
        return np.inf
    paid = sum(problem.cost(c.candidate) for c in own)
    paid += sum(cost for cost, size in zip(problem.family_costs, background, strict=True) if size)
    paid += PRIORS.excess_special_case_nats * max(
        problem.space.excess_special_cases(frozenset(c.candidate for c in own)), 0
    )
    return float(paid - half_line_gain(z_scores))


def half_line_gain(z_scores: Array) -> float:
    """What values gain that can't be negative, nats: priors twice as dense, posteriors' share above zero.

    Args:
        z_scores: standard errors from zero at which each value would stand if it could be negative.

    Returns:
        Nats; below zero where they would be negative.
    """
    return float(np.sum(np.log(2) + log_ndtr(z_scores)))
