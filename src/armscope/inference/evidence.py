"""How well a hypothesis explains the data, as Gaussian marginal likelihood in closed form.

A hypothesis is a set of whole effects with a size each (mm at the tool), a size of the geometric background, and the
noise. Everything is linear, so coefficients are integrated out: log p(y) = -n log sigma - 1/2 log|I + P G / sigma^2|
- 1/2 (yy - b' (G + sigma^2 P^-1)^-1 b) / sigma^2 with the prior variances P. Columns are scaled to
1 mm RMS at the tool.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from scipy.linalg.lapack import dpotrf, dtrtri, dtrtrs
from scipy.special import log_ndtr

from armscope.core.types import Array, Indices
from armscope.fitting.model_space import Pool
from armscope.inference.normal_equations import NormalEquations, column_scales

FRAME_PRIOR_MM = 50.0
"""Frames are free: their prior is wide, and the same in all hypotheses."""
TOLERANCE = 1.0e-3
"""Geometric tolerance of an industrial arm: 1 mm and 1 mrad per D-H value."""
BACKGROUND_SIZES = (0.0, 0.03, 0.1, 0.3, 1.0)
"""Shares of the tolerance that the geometric background may have: from a perfect arm to an ordinary one. None at all
is among them: two dozen free values, however small, would take up any single one that is barely large enough to be
seen."""
FAMILY_SIZES = 4
"""Sizes of an elastic or transmission background: none, then the smallest of the effects' sizes."""
EXCESS_SPECIAL_CASE_NATS = 15.0
"""What every further effect that follows one joint's own angle costs more: one unknown cause is likelier than several
known ones. (In development worlds two names for one kink beat the free curve by at most 22 nats, half of them by less
than 10; 38 of 40 true pairs beat it by more than 15.)"""
PERFECT = (0, 0, 0)
SIZES = 5
"""How many effect sizes compete, evenly in the logarithm between what is barely seen and the mismatch."""
BARELY_SEEN = 4.0
"""The smallest size: what all residuals together show at this many standard errors. A larger one pays for a prior that
is wider than any effect near the threshold."""
SURE_NATS = 3.0
"""What any name costs on top of its share of the library: it must be 20 times as likely as nothing in its place."""
NOISE_STEPS = 3
NOISE_SETTLED = 3e-3


Background = tuple[int, ...]


@dataclass(frozen=True)
class SelectedEffect:
    """An effect in a hypothesis: which candidate, with which size (index into the problem's sizes).

    One that stands ``nested`` a background or a curve is a name for a part of it, and pays nothing for itself.
    """

    candidate: int
    size: int
    nested: bool = False


@dataclass(frozen=True, eq=False)
class Problem:
    """Normal equations made ready for evaluating hypotheses.

    Attributes:
        pool: what the columns are.
        equations: with columns scaled to 1 mm RMS at the tool.
        scale: (p,) what they were divided by, mm per SI unit.
        least_noise: mm; the noise is never taken to be below (stated, or seen in repeats).
        sizes: (SIZES,) effect sizes that compete, mm at the tool.
        prior_costs: (candidates,) log prior odds against each candidate, nats.
        background_cost: of an elastic or transmission background: one kind of error among the others, of some size.
        mismatch: RMS per axis after the free frames, mm.
    """

    pool: Pool
    equations: NormalEquations
    scale: Array
    least_noise: float
    sizes: Array
    prior_costs: Array
    background_cost: float
    mismatch: float

    @property
    def n(self) -> float:
        """Number of residuals."""
        return self.equations.n

    def with_equations(self, equations: NormalEquations) -> Problem:
        """The same problem on other rows; ``equations`` is unscaled."""
        return replace(self, equations=equations.scaled(self.scale))


def problem(pool: Pool, equations: NormalEquations, least_noise: float) -> Problem:
    """Scale a Gram matrix and set prior sizes and costs."""
    scale = column_scales(equations, pool.frames)
    scaled = equations.scaled(scale)
    mismatch = _rms_after_frames(scaled, pool.frames)
    low = max(least_noise * min(BARELY_SEEN / np.sqrt(max(equations.n, 1.0)), 0.5), 0.01 * mismatch)
    sizes = np.geomspace(low, max(2 * mismatch, 4 * low), SIZES)
    spread = float(np.log(kinds(pool)) + np.log(FAMILY_SIZES - 1))
    return Problem(pool, scaled, scale, least_noise, sizes, prior_costs(pool), spread, mismatch)


def _rms_after_frames(equations: NormalEquations, frames: Indices) -> float:
    Gf = equations.G[np.ix_(frames, frames)]
    explained = equations.b[frames] @ np.linalg.lstsq(Gf, equations.b[frames], rcond=1e-12)[0]
    left = float(equations.yy - explained)
    return float(np.sqrt(max(left, 0.0) / max(equations.n - len(frames), 1.0)))


def kinds(pool: Pool) -> int:
    """How many types of effects compete."""
    return max(len({placed.name for placed in pool.candidates}), 1)


def prior_costs(pool: Pool) -> Array:
    """Each effect type is as likely as any other, each of its locations as any other, each scanned number, too."""
    locations: dict[str, set[str]] = {}
    variants: dict[tuple[str, str], int] = {}
    for placed in pool.candidates:
        locations.setdefault(placed.name, set()).add(placed.location)
        if placed.multiplicity == 1 and not placed.refinement:
            variants[placed.key] = variants.get(placed.key, 0) + 1
    return np.array(
        [
            SURE_NATS
            + np.log(kinds(pool))
            + np.log(len(locations[placed.name]))
            + np.log(placed.multiplicity if placed.multiplicity > 1 else variants.get(placed.key, 1))
            for placed in pool.candidates
        ]
    )


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A weighed hypothesis.

    Attributes:
        chosen: its effects.
        background: size of each family's background: an index into `BACKGROUND_SIZES` for the geometric one; 0 for
            none or 1 + an index into the problem's sizes for the others.
        noise: mm per axis.
        log_posterior: log evidence with prior, nats.
        log_evidence: log evidence alone, nats.
        columns: columns of the pool that take part, ascending.
        variance: their prior variances, mm^2 at the tool.
        cholesky: lower Cholesky factor of G + noise^2 / variance.
        mean: posterior mean of the scaled coefficients.
        rss: penalised residual sum of squares, mm^2.
        known_inverse: of the factor, where weighing it needed it.
    """

    settled: ClassVar[bool] = True
    """The noise is this hypothesis' own."""
    chosen: tuple[SelectedEffect, ...]
    background: Background
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
        return np.asarray(dtrtri(self.cholesky, lower=1)[0]) if self.known_inverse is None else self.known_inverse

    @property
    def candidates(self) -> frozenset[int]:
        """The numbers of its candidates."""
        return frozenset(c.candidate for c in self.chosen)

    def coefficients(self, p: int) -> Array:
        """(p,) posterior mean of all scaled coefficients, zero where a column takes no part."""
        full = np.zeros(p)
        full[self.columns] = self.mean
        return full


def evaluate(problem: Problem, chosen: tuple[SelectedEffect, ...], background: Background, noise: float) -> Hypothesis:
    """Evidence of a hypothesis; the noise starts from ``noise`` and is re-estimated (MacKay 1992)."""
    prior = prior_variances(problem, chosen, background)
    columns = np.flatnonzero(prior > 0)
    variance = prior[columns]
    G, b = problem.equations.G[np.ix_(columns, columns)], problem.equations.b[columns]
    factor = first = lower_cholesky(G, noise**2 / variance)
    # how many values the data determine hardly changes with the noise: one inverse is enough
    inverse = np.asarray(dtrtri(first, lower=1)[0])
    effective_dof = len(columns) - noise**2 * float(np.sum(np.einsum("ij,ij->j", inverse, inverse) / variance))
    for step in range(NOISE_STEPS):
        whitened_rhs = solve_lower(factor, b)
        rss = float(problem.equations.yy - whitened_rhs @ whitened_rhs)
        mean = np.asarray(dtrtrs(factor, whitened_rhs, lower=1, trans=1)[0])
        misfit = rss - noise**2 * float(np.sum(mean**2 / variance))
        updated = np.sqrt(max(misfit, 0.0) / max(problem.n - effective_dof, 1.0))
        updated = max(float(updated), problem.least_noise, 1e-6)
        if step == NOISE_STEPS - 1 or abs(updated - noise) < NOISE_SETTLED * noise:
            break
        noise = updated
        factor = lower_cholesky(G, noise**2 / variance)
    logdet = 2 * np.sum(np.log(np.diag(factor))) + np.sum(np.log(variance)) - 2 * len(columns) * np.log(noise)
    evidence = float(-problem.n * np.log(noise) - 0.5 * logdet - 0.5 * rss / noise**2)
    values = [
        int(problem.pool.columns[c.candidate][0])
        for c in chosen
        if not c.nested and problem.pool.nonnegative[c.candidate]
    ]
    at = np.searchsorted(columns, values)
    away = mean[at] / (noise * np.sqrt(np.sum(inverse[:, at] ** 2, axis=0)))
    value = evidence - negative_log_prior(problem, chosen, background, away)
    known = inverse if factor is first else None
    return Hypothesis(chosen, background, noise, value, evidence, columns, variance, factor, mean, rss, known)


def negative_log_prior(
    problem: Problem, chosen: tuple[SelectedEffect, ...], background: Background, away: Array
) -> float:
    """What a hypothesis pays for its effects and backgrounds, nats; infinite if some effect lacks what it rests on.

    Args:
        away: of each effect's value that can't be negative, standard errors from zero; half of the prior goes to the
            other half, each by itself.
    """
    own = [c for c in chosen if not c.nested]
    if not problem.pool.requirements_met(frozenset(c.candidate for c in chosen)):
        return np.inf
    paid = sum(problem.prior_costs[c.candidate] + np.log(len(problem.sizes)) for c in own)
    paid += problem.background_cost * np.count_nonzero(background[1:])
    paid += EXCESS_SPECIAL_CASE_NATS * max(problem.pool.excess_special_cases(frozenset(c.candidate for c in own)), 0)
    return float(paid - np.sum(np.log(2) + log_ndtr(away)))


ROUNDING = 1e-11


def lower_cholesky(G: Array, ridge: Array) -> Array:
    """Cholesky factor (lower) of G + diag(ridge); a ridge below rounding is raised to it (few rows, fitted exactly)."""
    A = G.copy()
    A.reshape(-1)[:: len(A) + 1] += np.maximum(ridge, ROUNDING * np.diag(G))
    # the transpose of a symmetric matrix: itself, in the order that LAPACK works in without another copy
    factor, failed = dpotrf(A.T, lower=1, clean=1, overwrite_a=1)
    if failed:
        raise np.linalg.LinAlgError(f"the Gram matrix is not positive definite at column {failed}")
    return np.asarray(factor)


def solve_lower(factor: Array, right: Array) -> Array:
    """factor^-1 right."""
    return np.asarray(dtrtrs(factor, right, lower=1)[0])


def savage_dickey(problem: Problem, hypothesis: Hypothesis, groups: Sequence[Indices]) -> Array:
    """Nats lost when columns are pinned to zero, group by group, at the noise as it is (Savage-Dickey ratio)."""
    at = {int(column): n for n, column in enumerate(hypothesis.columns)}
    lost = []
    for columns in groups:
        own = np.array([at[int(column)] for column in columns])
        inverse = hypothesis.inverse[:, own]
        sigma = hypothesis.noise**2 * (inverse.T @ inverse)
        mean = hypothesis.mean[own]
        scaled = sigma / np.sqrt(np.outer(hypothesis.variance[own], hypothesis.variance[own]))
        lost.append(0.5 * float(mean @ np.linalg.solve(sigma, mean)) + 0.5 * float(np.linalg.slogdet(scaled)[1]))
    return np.array(lost)


def removal_log_bayes_factors(problem: Problem, hypothesis: Hypothesis) -> Array:
    """What each chosen effect's removal would cost, nats, at the noise as it is (Savage-Dickey ratio)."""
    at = {int(column): n for n, column in enumerate(hypothesis.columns)}
    lost = []
    for c in hypothesis.chosen:
        own = np.array([at[int(column)] for column in problem.pool.columns[c.candidate]])
        added = (problem.sizes[c.size] * np.array(problem.pool.candidates[c.candidate].prior_scale)) ** 2
        rest = np.maximum(hypothesis.variance[own] - added, 1e-12 * added)
        inverse = hypothesis.inverse[:, own]
        sigma = hypothesis.noise**2 * (inverse.T @ inverse)
        # removal replaces the prior precision 1/v by 1/rest; where nothing is left, the columns are pinned to zero
        extra = 1 / rest - 1 / hypothesis.variance[own]
        M = np.eye(len(own)) + sigma * extra[None, :]
        mean = hypothesis.mean[own]
        quadratic = mean @ (extra * np.linalg.solve(M, mean))
        logdet = np.linalg.slogdet(M)[1] - np.sum(np.log(hypothesis.variance[own] / rest))
        lost.append(0.5 * quadratic + 0.5 * logdet - problem.prior_costs[c.candidate] - np.log(len(problem.sizes)))
    return np.array(lost)


def prior_variances(problem: Problem, chosen: tuple[SelectedEffect, ...], background: Background) -> Array:
    """(p,) prior variances of the scaled columns, mm^2; zero where a column takes no part."""
    prior = np.zeros(len(problem.scale))
    pool = problem.pool
    geometric, *others = pool.background
    tolerance = BACKGROUND_SIZES[background[0]] * TOLERANCE
    prior[geometric] = (tolerance * problem.scale[geometric]) ** 2
    for size, columns, shape in zip(background[1:], others, pool.background_shape[1:], strict=True):
        if size:
            prior[columns] += (problem.sizes[size - 1] * shape) ** 2
    prior[pool.frames] = FRAME_PRIOR_MM**2
    for c in chosen:
        own = np.array(pool.candidates[c.candidate].prior_scale)
        prior[pool.columns[c.candidate]] += (problem.sizes[c.size] * own) ** 2
    return prior


def background_sizes(problem: Problem, hypothesis: Hypothesis) -> tuple[float, ...]:
    """Size of each family's background: share of the tolerance for the geometric one, mm at the tool for the others."""
    first, *others = hypothesis.background
    return BACKGROUND_SIZES[first], *(float(problem.sizes[size - 1]) if size else 0.0 for size in others)
