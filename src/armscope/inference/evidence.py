"""How well a hypothesis explains the data, as Gaussian marginal likelihood in closed form.

Everything is linear, so coefficients are integrated out: log p(y) = -n log sigma - 1/2 log|I + P G / sigma^2|
- 1/2 (yy - b' (G + sigma^2 P^-1)^-1 b) / sigma^2 with the prior variances P.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from scipy.linalg.lapack import dtrtrs
from scipy.special import log_ndtr

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS, PRIORS
from armscope.inference.linear_algebra import among, lower_cholesky, lower_inverse, solve_lower
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.problem import Problem, SelectedEffect, prior_variances


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """An evaluated hypothesis.

    Attributes:
        chosen: its effects.
        background: size of each family's background.
        noise: mm per axis.
        log_posterior: log evidence with prior, nats.
        log_evidence: log evidence alone, nats.
        columns: columns of the space that take part, ascending.
        variance: their prior variances, mm^2 at the tool.
        cholesky: lower Cholesky factor of G + noise^2 / variance.
        mean: posterior mean of the scaled coefficients.
        rss: penalised residual sum of squares, mm^2.
        known_inverse: of the factor, where evaluating it needed it.
    """

    settled: ClassVar[bool] = True
    """The noise is this hypothesis' own."""
    chosen: tuple[SelectedEffect, ...]
    background: BackgroundSizes
    noise: float
    log_posterior: float
    log_evidence: float
    columns: Indices = field(repr=False)
    variance: Array = field(repr=False)
    cholesky: Array = field(repr=False)
    mean: Array = field(repr=False)
    rss: float = field(repr=False)
    known_inverse: Array | None = field(default=None, repr=False)

    @functools.cached_property
    def inverse(self) -> Array:
        """The inverse of the factor."""
        return lower_inverse(self.cholesky) if self.known_inverse is None else self.known_inverse

    @functools.cached_property
    def candidates(self) -> frozenset[int]:
        """The numbers of its candidates."""
        return frozenset(c.candidate for c in self.chosen)

    def at(self, columns: Indices) -> Indices:
        """Where some of the space's columns, which take part, stand among its own."""
        return np.searchsorted(self.columns, columns)

    def means(self, columns: Indices) -> Array:
        """Posterior means of some columns that take part, mm."""
        return np.asarray(self.mean[self.at(columns)])

    def variances(self, columns: Indices) -> Array:
        """Posterior variances of some columns that take part, mm^2."""
        return np.asarray(self.noise**2 * np.sum(self.inverse[:, self.at(columns)] ** 2, axis=0))

    def covariance(self, columns: Indices) -> Array:
        """Posterior covariance of some columns that take part, mm^2."""
        inverse = self.inverse[:, self.at(columns)]
        return np.asarray(self.noise**2 * (inverse.T @ inverse))

    def coefficients(self, p: int) -> Array:
        """(p,) posterior mean of all scaled coefficients, zero where a column takes no part."""
        full = np.zeros(p)
        full[self.columns] = self.mean
        return full


def evaluate(
    problem: Problem, chosen: tuple[SelectedEffect, ...], background: BackgroundSizes, noise: float
) -> Hypothesis:
    """Evidence of a hypothesis; the noise starts from ``noise`` and is re-estimated (MacKay 1992).

    Args:
        problem: the normal equations and priors.
        chosen: the effects, with their sizes.
        background: size of each family's background.
        noise: where the noise starts, mm per axis.

    Returns:
        The hypothesis with its evidence, nats, noise, mm, and posterior.
    """
    prior = prior_variances(problem, chosen, background)
    columns = np.flatnonzero(prior)
    variance = prior[columns]
    precision = 1 / variance
    G, b = among(problem.equations.G, columns), problem.equations.b[columns]
    factor = first = lower_cholesky(G, noise**2 * precision)
    # how many values the data determine hardly changes with the noise: one inverse is enough
    inverse = lower_inverse(first)
    effective_dof = len(columns) - noise**2 * float(np.einsum("ij,ij->j", inverse, inverse) @ precision)
    for step in range(NUMERICS.noise_steps):
        whitened_rhs = solve_lower(factor, b)
        rss = problem.equations.yy - float(whitened_rhs @ whitened_rhs)
        mean = np.asarray(dtrtrs(factor, whitened_rhs, lower=1, trans=1)[0])
        misfit = rss - noise**2 * float(mean**2 @ precision)
        updated = math.sqrt(max(misfit, 0.0) / max(problem.n - effective_dof, 1.0))
        updated = max(updated, problem.least_noise, 1e-6)
        if step == NUMERICS.noise_steps - 1 or abs(updated - noise) < NUMERICS.noise_settled * noise:
            break
        noise = updated
        factor = lower_cholesky(G, noise**2 * precision)
    logdet = float(2 * np.log(factor.diagonal()).sum() + np.log(variance).sum()) - 2 * len(columns) * math.log(noise)
    evidence = -problem.n * math.log(noise) - 0.5 * logdet - 0.5 * rss / noise**2
    at = np.searchsorted(columns, half_line_columns(problem, chosen))
    z_scores = mean[at] / (noise * np.sqrt(np.sum(inverse[:, at] ** 2, axis=0)))
    posterior = evidence - negative_log_prior(problem, chosen, background, z_scores)
    known = inverse if factor is first else None
    return Hypothesis(chosen, background, noise, posterior, evidence, columns, variance, factor, mean, rss, known)


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


def fitted_values(problem: Problem, hypotheses: Sequence[Hypothesis]) -> Array:
    """(K, p) the posterior means of K hypotheses, SI units; zero where a column takes no part."""
    return np.array([each.coefficients(len(problem.scale)) / problem.scale for each in hypotheses])


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
