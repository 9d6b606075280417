"""How well a hypothesis explains the data, as Gaussian marginal likelihood in closed form.

Everything is linear, so coefficients are integrated out: log p(y) = -n log sigma - 1/2 log|I + P G / sigma^2|
- 1/2 (yy - b' (G + sigma^2 P^-1)^-1 b) / sigma^2 with the prior variances P.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.inference.departure import Departure, departure
from armscope.inference.linear_algebra import among, lower_cholesky, lower_inverse, solve_lower, solve_upper
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.prices import half_line_columns, negative_log_prior
from armscope.inference.problem import Problem, SelectedEffect, prior_variances


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """An evaluated hypothesis."""

    settled: ClassVar[bool] = True
    """The noise is this hypothesis' own."""
    chosen: tuple[SelectedEffect, ...]  # its effects
    background: BackgroundSizes  # size of each family's background
    noise: float  # mm per axis
    log_posterior: float  # log evidence with prior, nats
    log_evidence: float  # log evidence alone, nats
    columns: Indices = field(repr=False)  # columns of the space that take part, ascending
    variance: Array = field(repr=False)  # their prior variances, mm^2 at the tool
    rss: float = field(repr=False)  # penalised residual sum of squares, mm^2
    equations: NormalEquations = field(repr=False)  # the sums that it is of
    # known_factor, known_mean, known_inverse: its factor, means and the factor's inverse, where evaluating it needed
    # them
    known_factor: Array | None = field(default=None, repr=False)
    known_mean: Array | None = field(default=None, repr=False)
    known_inverse: Array | None = field(default=None, repr=False)
    # its means as they follow from those of a hypothesis near by: what it predicts then needs no factor, and what
    # departs from it does not add up rounding
    near_mean: Array | None = field(default=None, repr=False)

    @functools.cached_property
    def cholesky(self) -> Array:
        """Lower Cholesky factor of G + noise^2 / variance."""
        if self.known_factor is not None:
            return self.known_factor
        return lower_cholesky(among(self.equations.G, self.columns), self.noise**2 / self.variance)

    @functools.cached_property
    def mean(self) -> Array:
        """Posterior mean of the scaled coefficients."""
        if self.known_mean is not None:
            return self.known_mean
        return solve_upper(self.cholesky, solve_lower(self.cholesky, self.equations.b[self.columns]))

    @functools.cached_property
    def effective_dof(self) -> float:
        """How many values the data determine at its noise."""
        return _effective_dof(self.inverse, self.noise, 1 / self.variance)

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
        full[self.columns] = self.mean if self.near_mean is None else self.near_mean
        return full


def evaluate(
    problem: Problem,
    chosen: tuple[SelectedEffect, ...],
    background: BackgroundSizes,
    noise: float,
    near: Hypothesis | None = None,
) -> Hypothesis:
    """Evidence of a hypothesis; the noise starts from ``noise`` and is re-estimated (MacKay 1992).

    Args:
        problem: the normal equations and priors.
        chosen: the effects, with their sizes.
        background: size of each family's background.
        noise: where the noise starts, mm per axis.
        near: a hypothesis of most of its columns, from whose factor the first step follows if it is of the same sums
            and noise; the result is the same but for rounding.

    Returns:
        The hypothesis with its evidence, nats, noise, mm, and posterior.
    """
    prior = prior_variances(problem, chosen, background)
    columns = np.flatnonzero(prior)
    asked = _Asked(problem, chosen, background, columns, prior[columns])
    if near is not None and near.equations is problem.equations and near.noise == noise and is_beside(len(columns)):
        step = departure(near, columns, prior[columns])
        if step is not None:
            return asked.beside(step)
    return asked.evaluated(noise)


def at_noise(
    problem: Problem, chosen: tuple[SelectedEffect, ...], background: BackgroundSizes, noise: float
) -> Hypothesis:
    """As `evaluate`, at the noise as it is: from it follow others that start there.

    Args:
        problem: the normal equations and priors.
        chosen: the effects, with their sizes.
        background: size of each family's background.
        noise: mm per axis.

    Returns:
        The hypothesis with its evidence, nats, and posterior.
    """
    prior = prior_variances(problem, chosen, background)
    columns = np.flatnonzero(prior)
    return _Asked(problem, chosen, background, columns, prior[columns]).evaluated(noise, 1)


def is_beside(columns: int) -> bool:
    """Whether a hypothesis of so many columns is quicker evaluated beside a known one than by its own factor."""
    return columns >= NUMERICS.beside


@dataclass(eq=False, slots=True)
class _First:
    """What hardly changes with the noise, where that starts."""

    effective_dof: float  # how many values the data determine
    spread: Array  # (h,) standard errors of the values that can't be negative, in units of the noise


@dataclass(eq=False)
class _Asked:
    """A hypothesis whose evidence is asked for."""

    problem: Problem
    chosen: tuple[SelectedEffect, ...]
    background: BackgroundSizes
    columns: Indices
    variance: Array
    sums: Array | None = None

    def __post_init__(self) -> None:
        self.precision = 1 / self.variance
        self.half_line = np.array(half_line_columns(self.problem, self.chosen), dtype=np.intp)
        """Columns whose values can't be negative."""
        self.at = self.columns.searchsorted(self.half_line)

    def evaluated(self, noise: float, steps: int = NUMERICS.noise_steps) -> Hypothesis:
        """By factors of its own; what the data determine hardly changes with the noise: one inverse is enough."""
        factor = lower_cholesky(self._products(), noise**2 * self.precision)
        inverse = lower_inverse(factor)
        spread = np.sqrt((inverse[:, self.at] ** 2).sum(axis=0))
        first = _First(_effective_dof(inverse, noise, self.precision), spread)
        return self._settled(noise, steps, first, (factor, inverse))

    def beside(self, step: Departure) -> Hypothesis:
        """From a first step beside another hypothesis; by a factor of its own only where the noise moves."""
        spread, means = step.spread(self.half_line), step.means(self.half_line)
        if spread is None or means is None:
            return self.evaluated(step.known.noise)
        updated = self._updated(step.misfit, step.effective_dof)
        if _moves(step.known.noise, updated):
            return self._settled(updated, NUMERICS.noise_steps - 1, _First(step.effective_dof, spread))
        z_scores = means / (step.known.noise * spread)
        near = None, None, None, step.means(self.columns)
        return self._found(step.known.noise, step.log_evidence, step.rss, z_scores, near)

    def _settled(
        self, noise: float, steps: int, first: _First, known: tuple[Array | None, Array | None] = (None, None)
    ) -> Hypothesis:
        """Steps of the noise, the first of them with a factor and its inverse that may be known."""
        b, precision, (factor, inverse) = self.problem.equations.b[self.columns], self.precision, known
        for step in range(steps):
            if factor is None:
                factor = lower_cholesky(self._products(), noise**2 * precision)
            whitened_rhs = solve_lower(factor, b)
            rss = self.problem.equations.yy - float(whitened_rhs @ whitened_rhs)
            mean = solve_upper(factor, whitened_rhs)
            updated = self._updated(rss - noise**2 * float(mean**2 @ precision), first.effective_dof)
            if step == steps - 1 or not _moves(noise, updated):
                break
            noise, factor, inverse = updated, None, None
        assert factor is not None
        logdet = float(2 * np.log(factor.diagonal()).sum() + np.log(self.variance).sum())
        logdet -= 2 * len(self.columns) * math.log(noise)
        evidence = -self.problem.n * math.log(noise) - 0.5 * logdet - 0.5 * rss / noise**2
        z_scores = mean[self.at] / (noise * first.spread)
        return self._found(noise, evidence, rss, z_scores, (factor, mean, inverse))

    def _found(
        self,
        noise: float,
        evidence: float,
        rss: float,
        z_scores: Array,
        known: tuple[Array | None, ...] = (),
    ) -> Hypothesis:
        """The hypothesis, its price taken off, with what is known of factor, means, the factor's inverse, and means."""
        posterior = evidence - negative_log_prior(self.problem, self.chosen, self.background, z_scores)
        named = (self.chosen, self.background, noise, posterior, evidence)
        return Hypothesis(*named, self.columns, self.variance, rss, self.problem.equations, *known)

    def _products(self) -> Array:
        """(k, k) of the columns, looked up once."""
        if self.sums is None:
            self.sums = among(self.problem.equations.G, self.columns)
        return self.sums

    def _updated(self, misfit: float, effective_dof: float) -> float:
        """The noise that leaves so much, mm."""
        updated = math.sqrt(max(misfit, 0.0) / max(self.problem.n - effective_dof, 1.0))
        return max(updated, self.problem.least_noise, 1e-6)


def _moves(noise: float, updated: float) -> bool:
    return abs(updated - noise) >= NUMERICS.noise_settled * noise


def _effective_dof(inverse: Array, noise: float, precision: Array) -> float:
    return len(inverse) - noise**2 * float(np.einsum("ij,ij->j", inverse, inverse) @ precision)


def fitted_values(problem: Problem, hypotheses: Iterable[Hypothesis]) -> Array:
    """(K, p) the posterior means of K hypotheses, SI units; zero where a column takes no part."""
    return np.array([each.coefficients(len(problem.scale)) / problem.scale for each in hypotheses])
