"""What further candidates would add to a hypothesis, all of them scored together from its own factor."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.conditioning import ConditionedColumns, LowRankUpdate, condition_on
from armscope.inference.constants import NUMERICS
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import ColumnBlocks, profiled_gain, quadratic_and_logdet
from armscope.inference.model_space import Candidate
from armscope.inference.problem import Problem, SelectedEffect, within


@dataclass(frozen=True, eq=False)
class CandidateGroups:
    """Candidates of about as many columns, so that they are scored together.

    One of fewer columns than its group is filled up with columns that may not move.
    """

    problem: Problem  # the normal equations and priors
    competing: Indices  # (q,) all their columns
    members: tuple[Indices, ...]  # (m,) candidates of each group, those of fewest columns first
    columns: tuple[Indices, ...]  # (m, c) where their columns stand in ``competing``

    @functools.cached_property
    def widths(self) -> tuple[Array, ...]:
        """(SIZES, m, c) prior standard deviations, mm, of each group; 0 for what fills up."""
        candidates = [[self.problem.space.candidates[n] for n in members] for members in self.members]
        widths = []
        for group, columns in zip(candidates, self.columns, strict=True):
            room = columns.shape[1]
            scales = np.array([_filled(c.prior_scale, room, 0.0) for c in group])
            plausible = np.array([_filled(_or(c.plausible, c, np.inf), room, np.inf) for c in group])
            usual = np.array([_filled(_or(c.usual, c, 0.0), room, 0.0) for c in group])
            expected = self.problem.sizes[:, None, None] * scales
            widths.append(within(expected, plausible, self.problem.scale[self.competing[columns]], usual))
        return tuple(widths)

    @functools.cached_property
    def products(self) -> tuple[Array, ...]:
        """(m, c, c) sums over rows within each candidate of each group."""
        G, inside = self.problem.equations.G, [self.competing[columns] for columns in self.columns]
        return tuple(G[columns[:, :, None], columns[:, None, :]] for columns in inside)


def group_candidates(problem: Problem) -> CandidateGroups:
    """Candidates that compete, by about how many columns they have."""
    by_size: dict[int, list[int]] = {}
    candidates = problem.space.candidates
    for number, candidate in enumerate(candidates):
        if candidate.competes:
            by_size.setdefault(_room(len(candidate.columns)), []).append(number)
    columns = [
        np.array([_filled(candidates[n].columns, size, candidates[n].columns[0]) for n in by_size[size]])
        for size in sorted(by_size)
    ]
    competing = np.unique(np.concatenate([each.ravel() for each in columns])) if columns else np.empty(0, dtype=np.intp)
    return CandidateGroups(
        problem,
        competing,
        tuple(np.array(by_size[size]) for size in sorted(by_size)),
        tuple(np.searchsorted(competing, each) for each in columns),
    )


def _room(columns: int) -> int:
    """For how many columns there is room in the group of a candidate with so many."""
    return next((room for room in NUMERICS.rooms if columns <= room), columns)


def _filled(values: Array | Indices, room: int, filling: float) -> Array:
    return np.concatenate([values, np.full(room - len(values), filling, dtype=values.dtype)])


def _or(values: Array | None, candidate: Candidate, otherwise: float) -> Array:
    return np.full(len(candidate.columns), otherwise) if values is None else values


def best_additions(problem: Problem, groups: CandidateGroups, hypothesis: Hypothesis) -> tuple[Array, Indices]:
    """What each candidate would add to the log posterior at its best size, nats, and the index of that size.

    Args:
        problem: the normal equations and priors.
        groups: the candidates.
        hypothesis: to which they are added.

    Returns:
        (candidates,) nats, and (candidates,) indices of sizes.
    """
    by_size = addition_scores(problem, groups, hypothesis)
    return by_size.max(axis=0), by_size.argmax(axis=0)


@dataclass(frozen=True)
class AskedAdditions:
    """Which scores are asked for: others need not be computed."""

    asked: NDArray[np.bool_]  # (candidates,) about which the question is
    count: int  # the best so many of them
    least: float  # that gain more than this, nats

    def bar(self, scores: Array) -> float:
        """What a candidate must beat once some have scores, nats."""
        if self.count >= len(scores):
            return self.least
        return max(self.least, float(-np.partition(-scores, self.count - 1)[self.count - 1]))


def addition_scores(
    problem: Problem,
    groups: CandidateGroups,
    hypothesis: Hypothesis | LowRankUpdate,
    wanted: AskedAdditions | None = None,
    rest: ConditionedColumns | None = None,
) -> Array:
    """(SIZES, candidates) what each candidate would add to a hypothesis' log posterior at each size, nats.

    The posterior of the hypothesis is conditioned on (Schur complement), so the gain is exact up to the noise's
    re-estimation, for which the profile of the likelihood over the noise is used; a noise that is not the hypothesis'
    own stays.

    Args:
        problem: the normal equations and priors.
        groups: the candidates.
        hypothesis: to which they are added.
        wanted: which scores are of use; all where not given.
        rest: what the hypothesis leaves of the columns that compete.

    Returns:
        (SIZES, candidates) nats, their price taken off; -inf where not wanted.
    """
    if rest is None:
        assert isinstance(hypothesis, Hypothesis)
        rest = condition_on(problem, groups.competing, hypothesis)
    by_size = np.full((len(problem.sizes), len(problem.prior_costs)), -np.inf)
    paid = problem.prior_costs + np.log(len(problem.sizes))
    for members, columns, widths, products in zip(
        groups.members, groups.columns, groups.widths, groups.products, strict=True
    ):
        inside = np.arange(len(members)) if wanted is None else np.flatnonzero(wanted.asked[members])
        if not len(inside):
            continue
        columns, widths = columns[inside], widths[:, inside]
        D, r = rest.of(products[inside], columns), rest.b[columns] / hypothesis.noise**2
        D /= hypothesis.noise**2
        if wanted is not None and columns.shape[1] > 1:
            # a gain grows with the prior's width; what it costs in volume is left out
            most = _likelier(problem, hypothesis, quadratic_and_logdet(D, r, widths[-1:])[0])[0] - paid[members[inside]]
            promising = np.flatnonzero(most > wanted.bar(by_size.max(axis=0)))
            if not len(promising):
                continue
            inside, D, r, widths = inside[promising], D[promising], r[promising], widths[:, promising]
        quadratic, logdet = quadratic_and_logdet(D, r, widths)
        scores = _likelier(problem, hypothesis, quadratic) - 0.5 * logdet
        if columns.shape[1] == 1:
            scores += _half_line(problem, members[inside], r[:, 0])
        by_size[:, members[inside]] = scores - paid[members[inside]]
    return by_size


def _half_line(problem: Problem, members: Indices, r: Array) -> Array:
    """(m,) what can't be negative and would be is not worth looking at; else its prior is twice as dense; nats."""
    return np.where(problem.space.nonnegative[members], np.where(r > 0, np.log(2), -np.inf), 0.0)


def _likelier(problem: Problem, hypothesis: Hypothesis | LowRankUpdate, quadratic: Array) -> Array:
    """What a smaller chi2 gains at the noise that then follows, or at one that stays, nats."""
    if not hypothesis.settled:
        return 0.5 * quadratic
    noise = hypothesis.noise
    return profiled_gain(quadratic, hypothesis.rss / noise**2, problem.n, noise, problem.least_noise)


def joint_addition_scores(problem: Problem, rest: Hypothesis, sets: Sequence[tuple[SelectedEffect, ...]]) -> Array:
    """What each set of effects together would add to the log posterior, nats; for small sets of small effects.

    Args:
        problem: the normal equations and priors.
        rest: the hypothesis to which they are added.
        sets: effects that are added together.

    Returns:
        (sets,) nats.
    """
    members = {c.candidate: problem.space.candidates[c.candidate].columns for chosen in sets for c in chosen}
    columns = np.concatenate([members[m] for m in sorted(members)])
    noise, remaining = rest.noise, condition_on(problem, columns, rest)
    inner = remaining.own(problem, np.arange(len(columns))[None])[0] / noise**2
    r = remaining.b / noise**2
    ends = np.cumsum([len(members[m]) for m in sorted(members)])
    at = {m: np.arange(end - len(members[m]), end) for m, end in zip(sorted(members), ends, strict=True)}
    totals = []
    for chosen in sets:
        own = np.concatenate([at[c.candidate] for c in chosen])
        size = np.concatenate([problem.prior_scale(c) for c in chosen])
        A = np.eye(len(own)) + inner[np.ix_(own, own)] * np.outer(size, size)
        u = size * r[own]
        quadratic = np.array(float(u @ np.linalg.solve(A, u)))
        gain = profiled_gain(quadratic, rest.rss / noise**2, problem.n, noise, problem.least_noise)
        paid = sum(problem.cost(c.candidate) for c in chosen)
        totals.append(float(gain) - 0.5 * float(np.linalg.slogdet(A)[1]) - paid)
    return np.array(totals)


def background_scores(problem: Problem, hypothesis: Hypothesis, number: int) -> Array:
    """What a family's background would add to the log posterior of a hypothesis that has none, nats.

    Args:
        problem: the normal equations and priors.
        hypothesis: to which it is added; columns that an effect has, too, get a second share.
        number: of the family.

    Returns:
        (sizes,) nats of each size but none, its price taken off.
    """
    family, some = problem.space.families[number], range(1, problem.space.families[number].sizes)
    columns, variances = [family.columns], [[family.prior_variance(size, problem.scale) for size in some]]
    for companion in problem.space.companions:
        if number in companion.backgrounds and not companion.joins(hypothesis.candidates, hypothesis.background):
            with_it = companion.family
            columns.append(with_it.columns)
            variances.append([with_it.prior_variance(with_it.sizes - 1, problem.scale)] * len(some))
    rest, own = condition_on(problem, np.concatenate(columns), hypothesis), np.arange(sum(map(len, columns)))[None]
    D, r = rest.own(problem, own) / hypothesis.noise**2, rest.b[own] / hypothesis.noise**2
    quadratic, logdet = quadratic_and_logdet(D, r, np.sqrt(np.concatenate(variances, axis=1))[:, None])
    gain = _likelier(problem, hypothesis, quadratic) - 0.5 * logdet
    return np.asarray(gain[:, 0] - problem.family_costs[number])


def block_scores(problem: Problem, hypothesis: Hypothesis, blocks: ColumnBlocks) -> Array:
    """(m,) nats that blocks outside the problem promise at their best sizes; their price is not taken off.

    Args:
        problem: the normal equations and priors.
        hypothesis: to which one of the blocks would be added.
        blocks: against the hypothesis' columns, mm per SI unit.

    Returns:
        (m,) nats.
    """
    own, b = blocks.conditioned(*unscaled_factor(problem, hypothesis))
    scale = np.sqrt(np.maximum(blocks.diagonal, 1e-300) / problem.n)
    D = own / (scale[:, :, None] * scale[:, None, :]) / hypothesis.noise**2
    quadratic, logdet = quadratic_and_logdet(D, b / scale / hypothesis.noise**2, problem.sizes[:, None, None])
    return np.asarray((0.5 * (quadratic - logdet)).max(axis=0))


def unscaled_factor(problem: Problem, hypothesis: Hypothesis) -> tuple[Array, Array]:
    """The hypothesis' Cholesky factor for columns in mm per SI unit, and factor^-1 b."""
    at = hypothesis.columns
    whitened_rhs = hypothesis.inverse @ problem.equations.b[at]
    return hypothesis.cholesky * problem.scale[at][:, None], whitened_rhs
