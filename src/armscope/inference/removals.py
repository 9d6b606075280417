"""What is lost when effects are taken out of a hypothesis, from its own factor, at the noise as it is."""

from __future__ import annotations

import math

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import lower_cholesky, solve_lower
from armscope.inference.problem import Problem


def savage_dickey(hypothesis: Hypothesis, columns: Indices) -> float:
    """Nats lost when columns are pinned to zero, at the noise as it is: the Savage-Dickey ratio (Dickey 1971)."""
    sigma, mean, variance = hypothesis.covariance(columns), hypothesis.means(columns), hypothesis.variance
    own = variance[hypothesis.at(columns)]
    scaled = sigma / np.sqrt(np.outer(own, own))
    return 0.5 * float(mean @ np.linalg.solve(sigma, mean)) + 0.5 * float(np.linalg.slogdet(scaled)[1])


def removal_log_bayes_factors(problem: Problem, hypothesis: Hypothesis) -> Array:
    """What each chosen effect's removal would cost, nats, at the noise as it is.

    Removal replaces a prior precision 1/v by 1/rest; where nothing is left, the columns are pinned to zero.
    """
    members = [problem.space.candidates[effect.candidate].columns for effect in hypothesis.chosen]
    at = hypothesis.at(np.concatenate(members))
    variance, inverse = hypothesis.variance[at], hypothesis.inverse[:, at]
    added = np.concatenate([problem.prior_scale(effect) for effect in hypothesis.chosen]) ** 2
    rest = np.maximum(variance - added, 1e-12 * added)
    root = np.sqrt(1 / rest - 1 / variance)
    seen = hypothesis.noise * inverse * root
    pull, widened = root * hypothesis.mean[at], np.log(variance / rest)
    ends, lost = np.cumsum([len(columns) for columns in members]).tolist(), []
    for effect, start, end in zip(hypothesis.chosen, [0, *ends[:-1]], ends, strict=True):
        if end - start == 1:  # most of them: a number needs no LAPACK
            square = float(seen[:, start] @ seen[:, start])
            inner = max(1.0, NUMERICS.rounding * square) + square
            quadratic, logdet = pull[start] ** 2 / inner, math.log(inner) - widened[start]
        else:
            own = slice(start, end)
            factor = lower_cholesky(seen[:, own].T @ seen[:, own], np.ones(end - start))
            quadratic = float((solve_lower(factor, pull[own]) ** 2).sum())
            logdet = float(2 * np.log(factor.diagonal()).sum() - widened[own].sum())
        lost.append(0.5 * quadratic + 0.5 * logdet - problem.cost(effect.candidate))
    return np.array(lost)
