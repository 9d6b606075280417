"""What a hypothesis leaves of further columns, and the hypothesis with smaller priors: nothing is factorised anew.

Both follow from the hypothesis' own factor as long as the noise stays: a further column by its Schur complement, a
removal (or another size) by a change of as few ranks as there are columns that it touches.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.linalg.blas import dtrmm

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import crossed, profiled_loss, solve_lower
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.prices import half_line_columns, negative_log_prior
from armscope.inference.problem import Problem, SelectedEffect, prior_variances


@dataclass(frozen=True, eq=False)
class ConditionedColumns:
    """What a hypothesis leaves of q columns once its posterior is conditioned on."""

    columns: Indices  # (q,) of the space
    b: Array  # (q,) their products with the response
    taken: Array  # (q, k) factor^-1 X'WX: what the hypothesis takes of them
    returned: Array | None = None  # (q, r) what it gives back for effects that are taken out of it

    def own(self, problem: Problem, at: Indices) -> Array:
        """(m, c, c) sums over rows within each of m sets (m, c) of the columns."""
        columns = self.columns[at]
        return self.of(problem.equations.G[columns[:, :, None], columns[:, None, :]], at)

    def of(self, products: Array, at: Indices) -> Array:
        """The same where the sums (m, c, c) before anything was taken are known."""
        taken = self.taken[at]
        own = taken @ taken.transpose(0, 2, 1)
        np.subtract(products, own, out=own)
        if self.returned is not None:
            returned = self.returned[at]
            own += returned @ returned.transpose(0, 2, 1)
        return own


def condition_on(problem: Problem, columns: Indices, hypothesis: Hypothesis) -> ConditionedColumns:
    """What a hypothesis leaves of some columns.

    Args:
        problem: the normal equations and priors.
        columns: of the problem.
        hypothesis: what is conditioned on.

    Returns:
        Products of the columns with what the hypothesis leaves, and what it takes of them.
    """
    G, b, inside = problem.equations.G, problem.equations.b, hypothesis.columns
    beside = crossed(G, inside, columns)
    taken = np.ascontiguousarray(dtrmm(1.0, hypothesis.inverse, beside.T, side=1, lower=1, trans_a=1, overwrite_b=1))
    return ConditionedColumns(columns, b[columns] - taken @ solve_lower(hypothesis.cholesky, b[inside]), taken)


@dataclass(frozen=True, eq=False)
class LowRankUpdate:
    """A hypothesis with smaller priors on some of its columns, or without them, at the noise as it is."""

    settled: ClassVar[bool] = False
    whole: Hypothesis  # the hypothesis
    chosen: tuple[SelectedEffect, ...]
    background: BackgroundSizes
    # log_posterior, rss: as of a hypothesis
    log_posterior: float
    rss: float
    at: Indices  # (r,) where the columns stand whose priors changed
    inner: Array  # (r, r) the matrix of the change of rank r: posterior covariance plus what the priors leave

    @property
    def noise(self) -> float:
        """As of the whole hypothesis, mm per axis."""
        return self.whole.noise

    @functools.cached_property
    def candidates(self) -> frozenset[int]:
        """The numbers of its candidates."""
        return frozenset(c.candidate for c in self.chosen)

    def conditioned(self, whole: ConditionedColumns) -> ConditionedColumns:
        """What it leaves of columns, from what the whole hypothesis leaves of them."""
        factor: Array = np.asarray(np.linalg.cholesky(self.inner), dtype=np.float64)
        returned = solve_lower(factor, self.whole.inverse[:, self.at].T @ whole.taken.T)
        b = whole.b + solve_lower(factor, self.whole.mean[self.at]) @ returned
        return ConditionedColumns(whole.columns, b, whole.taken, returned.T)


def low_rank_update(
    problem: Problem, hypothesis: Hypothesis, chosen: tuple[SelectedEffect, ...], background: BackgroundSizes
) -> LowRankUpdate | None:
    """A hypothesis with other effects or sizes, at the noise as it is; None if that needs columns it does not have.

    A prior precision that grows by d (noise units) at columns R turns A into A + E d E': by Woodbury's identity all
    follows from the inverse of A at R.

    Args:
        problem: the normal equations and priors.
        hypothesis: from which it departs.
        chosen: the other's effects, with their sizes.
        background: size of each family's background.

    Returns:
        Log posterior and residual of the other, without its factors.
    """
    prior, before, noise = prior_variances(problem, chosen, background), hypothesis.variance, hypothesis.noise
    after = prior[hypothesis.columns]
    if np.count_nonzero(after) < np.count_nonzero(prior):
        return None
    at = np.flatnonzero(np.abs(after - before) > NUMERICS.rounded * before)
    after, before = after[at], before[at]
    inverse = hypothesis.inverse[:, at]
    inner = inverse.T @ inverse
    inner[np.diag_indices_from(inner)] += after * before / (before - after) / noise**2
    mean = hypothesis.mean[at]
    rss = hypothesis.rss + float(mean @ np.linalg.solve(inner, mean)) if len(at) else hypothesis.rss
    logdet = float(np.linalg.slogdet(inner)[1] + np.sum(np.log(noise**2 * np.abs(before - after) / before**2)))
    evidence = hypothesis.log_evidence - 0.5 * logdet - 0.5 * (rss - hypothesis.rss) / noise**2
    z_scores = _z_scores(problem, hypothesis, chosen, at, inner)
    paid = negative_log_prior(problem, chosen, background, z_scores)
    return LowRankUpdate(hypothesis, chosen, background, evidence - paid, rss, at, inner)


def _z_scores(
    problem: Problem, whole: Hypothesis, chosen: Sequence[SelectedEffect], at: Indices, inner: Array
) -> Array:
    """Standard errors from zero at which values that can't be negative stand after an update."""
    own = np.searchsorted(whole.columns, half_line_columns(problem, chosen))
    inverse = whole.inverse[:, own]
    both = inverse.T @ whole.inverse[:, at]
    moved = np.linalg.solve(inner, both.T).T if len(at) else both
    mean = whole.mean[own] - moved @ whole.mean[at]
    variance = whole.noise**2 * (np.sum(inverse**2, axis=0) - np.sum(moved * both, axis=1))
    return np.asarray(mean / np.sqrt(np.maximum(variance, 1e-300)))


def approximate_removal_loss(problem: Problem, hypothesis: Hypothesis, kept: tuple[SelectedEffect, ...]) -> float:
    """Nats lost with only some effects kept, of which the noise, if it were free, would take up some by growing.

    Args:
        problem: the normal equations and priors.
        hypothesis: with all its effects.
        kept: those that stay.

    Returns:
        Nats.
    """
    rest = low_rank_update(problem, hypothesis, kept, hypothesis.background)
    assert rest is not None
    return profiled_loss(hypothesis.log_posterior - rest.log_posterior, problem.n)
