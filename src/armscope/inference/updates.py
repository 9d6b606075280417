"""What further effects would add to a hypothesis, and what it would be without some, with nothing factorised anew.

Both follow from the hypothesis' own factor as long as the noise stays: an addition by its Schur complement, a removal
(or another size) by a change of as few ranks as there are columns that it touches.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dtrtrs

from armscope.core.types import Array, Indices
from armscope.fitting.model_space import Pool
from armscope.inference.evidence import (
    Background,
    Hypothesis,
    Problem,
    SelectedEffect,
    negative_log_prior,
    prior_variances,
    solve_lower,
)

MANY_COLUMNS = 8
"""Sets of at least this many columns are factorised size by size, which takes less time than their eigenvalues."""
ROUNDED = 1e-12
"""Prior variances that differ by a smaller part than this are the same."""


@dataclass(frozen=True, eq=False)
class CandidateGroups:
    """Candidates of equal numbers of columns, so that they are scored together.

    Attributes:
        competing: (q,) all their columns.
        members: (m,) candidates of each group.
        columns: (m, c) where their columns stand in ``competing``.
        shapes: (m, c) relative sizes.
    """

    competing: Indices
    members: tuple[Indices, ...]
    columns: tuple[Indices, ...]
    shapes: tuple[Array, ...]


def group_candidates(pool: Pool) -> CandidateGroups:
    """Candidates that compete, by their number of columns."""
    by_size: dict[int, list[int]] = {}
    for number, columns in enumerate(pool.columns):
        if not pool.candidates[number].refinement:
            by_size.setdefault(len(columns), []).append(number)
    all_columns = [pool.columns[m] for members in by_size.values() for m in members]
    competing = np.unique(np.concatenate(all_columns)) if all_columns else np.empty(0, dtype=np.intp)
    return CandidateGroups(
        competing,
        tuple(np.array(members) for members in by_size.values()),
        tuple(np.searchsorted(competing, [pool.columns[m] for m in members]) for members in by_size.values()),
        tuple(np.array([pool.candidates[m].prior_scale for m in members]) for members in by_size.values()),
    )


@dataclass(frozen=True, eq=False)
class ConditionedColumns:
    """What a hypothesis leaves of q columns once its posterior is conditioned on.

    Attributes:
        columns: (q,) of the pool.
        b: (q,) their products with the response.
        taken: (q, k) factor^-1 X'WX: what the hypothesis takes of them.
        returned: (q, r) what it gives back for effects that are taken out of it.
    """

    columns: Indices
    b: Array
    taken: Array
    returned: Array | None = None

    def own(self, problem: Problem, at: Indices) -> Array:
        """(m, c, c) sums over rows within each of m sets (m, c) of the columns."""
        columns, taken = self.columns[at], self.taken[at]
        own = problem.equations.G[columns[:, :, None], columns[:, None, :]] - taken @ np.swapaxes(taken, 1, 2)
        if self.returned is not None:
            returned = self.returned[at]
            own += returned @ np.swapaxes(returned, 1, 2)
        return np.asarray(own)


def condition_on(problem: Problem, columns: Indices, hypothesis: Hypothesis) -> ConditionedColumns:
    """What a hypothesis leaves of some columns."""
    G, b, inside = problem.equations.G, problem.equations.b, hypothesis.columns
    taken = np.asarray(dtrtrs(hypothesis.cholesky, G[np.ix_(columns, inside)].T, lower=1, overwrite_b=1)[0]).T
    return ConditionedColumns(columns, b[columns] - taken @ solve_lower(hypothesis.cholesky, b[inside]), taken)


@dataclass(frozen=True, eq=False)
class LowRankUpdate:
    """A hypothesis with smaller priors on some of its columns, or without them, at the noise as it is.

    Attributes:
        whole: the hypothesis.
        log_posterior, rss: as of a hypothesis.
        at: (r,) where the columns stand whose priors changed.
        inner: (r, r) the matrix of the change of rank r: posterior covariance plus what the priors leave.
    """

    settled: ClassVar[bool] = False
    whole: Hypothesis
    chosen: tuple[SelectedEffect, ...]
    background: Background
    log_posterior: float
    rss: float
    at: Indices
    inner: Array

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
    problem: Problem, hypothesis: Hypothesis, chosen: tuple[SelectedEffect, ...], background: Background
) -> LowRankUpdate | None:
    """A hypothesis with other effects or sizes, at the noise as it is; None if that needs columns it does not have.

    A prior precision that grows by d (noise units) at columns R turns A into A + E d E': by Woodbury's identity all
    follows from the inverse of A at R.
    """
    prior, before, noise = prior_variances(problem, chosen, background), hypothesis.variance, hypothesis.noise
    after = prior[hypothesis.columns]
    if np.count_nonzero(after) < np.count_nonzero(prior):
        return None
    at = np.flatnonzero(np.abs(after - before) > ROUNDED * before)
    after, before = after[at], before[at]
    inverse = hypothesis.inverse[:, at]
    inner = inverse.T @ inverse
    inner[np.diag_indices_from(inner)] += after * before / (before - after) / noise**2
    mean = hypothesis.mean[at]
    rss = hypothesis.rss + float(mean @ np.linalg.solve(inner, mean)) if len(at) else hypothesis.rss
    logdet = float(np.linalg.slogdet(inner)[1] + np.sum(np.log(noise**2 * np.abs(before - after) / before**2)))
    evidence = hypothesis.log_evidence - 0.5 * logdet - 0.5 * (rss - hypothesis.rss) / noise**2
    paid = _negative_log_prior(problem, hypothesis, chosen, background, at, inner)
    return LowRankUpdate(hypothesis, chosen, background, evidence - paid, rss, at, inner)


def _negative_log_prior(
    problem: Problem,
    whole: Hypothesis,
    chosen: tuple[SelectedEffect, ...],
    background: Background,
    at: Indices,
    inner: Array,
) -> float:
    """What a changed hypothesis pays, nats; values that can't be negative are looked at where they now stand."""
    pool = problem.pool
    values = [int(pool.columns[c.candidate][0]) for c in chosen if not c.nested and pool.nonnegative[c.candidate]]
    own = np.searchsorted(whole.columns, values)
    inverse = whole.inverse[:, own]
    both = inverse.T @ whole.inverse[:, at]
    moved = np.linalg.solve(inner, both.T).T if len(at) else both
    mean = whole.mean[own] - moved @ whole.mean[at]
    variance = whole.noise**2 * (np.sum(inverse**2, axis=0) - np.sum(moved * both, axis=1))
    return negative_log_prior(problem, chosen, background, mean / np.sqrt(np.maximum(variance, 1e-300)))


def approximate_removal_loss(problem: Problem, hypothesis: Hypothesis, kept: tuple[SelectedEffect, ...]) -> float:
    """Nats lost with only some effects kept, of which the noise, if it were free, would take up some by growing."""
    rest = low_rank_update(problem, hypothesis, kept, hypothesis.background)
    assert rest is not None
    return problem.n / 2 * float(np.log1p(2 * max(hypothesis.log_posterior - rest.log_posterior, 0.0) / problem.n))


def best_additions(problem: Problem, groups: CandidateGroups, hypothesis: Hypothesis) -> tuple[Array, Indices]:
    """What each candidate would add to a hypothesis' value at its best size, nats, and the index of that size."""
    by_size = addition_scores(problem, groups, hypothesis)
    return by_size.max(axis=0), by_size.argmax(axis=0)


def addition_scores(
    problem: Problem,
    groups: CandidateGroups,
    hypothesis: Hypothesis | LowRankUpdate,
    asked: NDArray[np.bool_] | None = None,
    rest: ConditionedColumns | None = None,
) -> Array:
    """(SIZES, candidates) what each candidate would add to a hypothesis' value at each size, nats.

    The posterior of the hypothesis is conditioned on (Schur complement), so the gain is exact up to the noise's
    re-estimation, for which the profile of the likelihood over the noise is used; a noise that is not the hypothesis'
    own stays.

    Args:
        asked: (candidates,) about which the question is; -inf for others.
        rest: what the hypothesis leaves of the columns that compete.
    """
    if rest is None:
        assert isinstance(hypothesis, Hypothesis)
        rest = condition_on(problem, groups.competing, hypothesis)
    noise, chi2 = hypothesis.noise, hypothesis.rss / hypothesis.noise**2
    s2 = problem.sizes**2
    by_size = np.full((len(problem.sizes), len(problem.prior_costs)), -np.inf)
    for members, columns, shapes in zip(groups.members, groups.columns, groups.shapes, strict=True):
        inside = np.ones(len(members), dtype=np.bool_) if asked is None else asked[members]
        if not np.any(inside):
            continue
        at, shape = columns[inside], shapes[inside]
        D = rest.own(problem, at) / noise**2 * shape[:, :, None] * shape[:, None, :]
        r = rest.b[at] / noise**2 * shape
        quadratic, logdet = _at_sizes(D, r, s2)
        if hypothesis.settled:
            likelier = _profiled(quadratic, chi2, problem.n, noise, problem.least_noise)
        else:
            likelier = 0.5 * quadratic
        by_size[:, members[inside]] = likelier - 0.5 * logdet
    # what can't be negative and would be is not worth looking at; the others' prior is twice as dense
    along = np.flatnonzero(problem.pool.nonnegative & np.isfinite(by_size[0]))
    first = [int(problem.pool.columns[number][0]) for number in along]
    pushed = rest.b[np.searchsorted(groups.competing, first)] > 0
    by_size[:, along] += np.where(pushed, np.log(2), -np.inf)
    return by_size - problem.prior_costs - np.log(len(problem.sizes))


def _at_sizes(D: Array, r: Array, s2: Array) -> tuple[Array, Array]:
    """(sizes, m) r' (D + 1 / s^2)^-1 r and log|1 + s^2 D| of m sets of columns."""
    if D.shape[1] >= MANY_COLUMNS:
        try:
            return _factorised(D, r, s2)
        except np.linalg.LinAlgError:
            pass  # of a noise near nothing: rounding makes the smallest eigenvalues negative
    if D.shape[1] == 1:
        eigenvalues, u2 = np.maximum(D[:, :, 0], 0.0), r**2
    else:
        eigenvalues, vectors = np.linalg.eigh(D)
        eigenvalues = np.maximum(eigenvalues, 0.0)
        u2 = np.einsum("mij,mi->mj", vectors, r) ** 2
    widened = 1 + s2[:, None, None] * eigenvalues
    return np.sum(u2 * s2[:, None, None] / widened, axis=2), np.sum(np.log(widened), axis=2)


def _factorised(D: Array, r: Array, s2: Array) -> tuple[Array, Array]:
    """`_at_sizes` by a factorisation per size: with r as one more row, the factor holds factor^-1 r, too."""
    m, c = r.shape
    bordered = np.empty((len(s2), m, c + 1, c + 1))
    bordered[:, :, :c, :c] = s2[:, None, None, None] * D + np.eye(c)
    bordered[:, :, c, :c] = bordered[:, :, :c, c] = r
    bordered[:, :, c, c] = 1 + 2 * np.sum(r**2, axis=1)  # any number that keeps it positive definite
    factor = np.linalg.cholesky(bordered)
    diagonal = np.diagonal(factor, axis1=2, axis2=3)[:, :, :c]
    return s2[:, None] * np.sum(factor[:, :, c, :c] ** 2, axis=2), 2 * np.sum(np.log(diagonal), axis=2)


def joint_addition_scores(problem: Problem, rest: Hypothesis, sets: Sequence[tuple[SelectedEffect, ...]]) -> Array:
    """What each set of effects together would add to a hypothesis' value, nats; for small sets of small effects."""
    members = sorted({c.candidate for chosen in sets for c in chosen})
    columns = np.concatenate([problem.pool.columns[m] for m in members])
    noise, remaining = rest.noise, condition_on(problem, columns, rest)
    inner = remaining.own(problem, np.arange(len(columns))[None])[0] / noise**2
    r = remaining.b / noise**2
    ends = np.cumsum([len(problem.pool.columns[m]) for m in members])
    at = {m: np.arange(end - len(problem.pool.columns[m]), end) for m, end in zip(members, ends, strict=True)}
    totals = []
    for chosen in sets:
        own = np.concatenate([at[c.candidate] for c in chosen])
        size = np.concatenate(
            [problem.sizes[c.size] * np.array(problem.pool.candidates[c.candidate].prior_scale) for c in chosen]
        )
        A = np.eye(len(own)) + inner[np.ix_(own, own)] * np.outer(size, size)
        u = size * r[own]
        quadratic = np.array(float(u @ np.linalg.solve(A, u)))
        gain = _profiled(quadratic, rest.rss / noise**2, problem.n, noise, problem.least_noise)
        paid = sum(problem.prior_costs[c.candidate] + np.log(len(problem.sizes)) for c in chosen)
        totals.append(float(gain) - 0.5 * float(np.linalg.slogdet(A)[1]) - paid)
    return np.array(totals)


def _profiled(quadratic: Array, chi2: float, n: float, noise: float, least: float) -> Array:
    """Gain of log likelihood when chi2 falls by ``quadratic`` and the noise follows, not below its least value."""
    remaining = np.maximum(chi2 - quadratic, 1e-9 * chi2)
    ratio = np.maximum(np.sqrt(remaining / chi2), min(1.0, least / noise))
    return np.asarray(-n * np.log(ratio) + 0.5 * chi2 - 0.5 * remaining / ratio**2)
