"""What further candidates would add to a hypothesis, all of them scored together from its own factor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.conditioning import ConditionedColumns, LowRankUpdate, condition_on
from armscope.inference.evidence import Hypothesis
from armscope.inference.linear_algebra import ColumnBlocks, profiled_gain, quadratic_and_logdet
from armscope.inference.model_space import Candidate, ModelSpace, within
from armscope.inference.problem import Problem, SelectedEffect


@dataclass(frozen=True, eq=False)
class CandidateGroups:
    """Candidates of equal numbers of columns, so that they are scored together.

    Attributes:
        competing: (q,) all their columns.
        members: (m,) candidates of each group.
        columns: (m, c) where their columns stand in ``competing``.
        prior_scales: (m, c) relative sizes.
        plausible: (m, c) sizes in the columns' own units that no coefficient is expected to exceed.
    """

    competing: Indices
    members: tuple[Indices, ...]
    columns: tuple[Indices, ...]
    prior_scales: tuple[Array, ...]
    plausible: tuple[Array, ...]


def group_candidates(space: ModelSpace) -> CandidateGroups:
    """Candidates that compete, by their number of columns."""
    by_size: dict[int, list[int]] = {}
    for number, candidate in enumerate(space.candidates):
        if candidate.competes:
            by_size.setdefault(len(candidate.columns), []).append(number)
    columns = {number: space.candidates[number].columns for members in by_size.values() for number in members}
    competing = np.unique(np.concatenate(list(columns.values()))) if columns else np.empty(0, dtype=np.intp)
    return CandidateGroups(
        competing,
        tuple(np.array(members) for members in by_size.values()),
        tuple(np.searchsorted(competing, [columns[m] for m in members]) for members in by_size.values()),
        tuple(np.array([space.candidates[m].prior_scale for m in members]) for members in by_size.values()),
        tuple(np.array([_plausible(space.candidates[m]) for m in members]) for members in by_size.values()),
    )


def _plausible(candidate: Candidate) -> Array:
    return np.full(len(candidate.columns), np.inf) if candidate.plausible is None else candidate.plausible


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


def addition_scores(
    problem: Problem,
    groups: CandidateGroups,
    hypothesis: Hypothesis | LowRankUpdate,
    asked: NDArray[np.bool_] | None = None,
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
        asked: (candidates,) about which the question is; -inf for others.
        rest: what the hypothesis leaves of the columns that compete.

    Returns:
        (SIZES, candidates) nats, their price taken off.
    """
    if rest is None:
        assert isinstance(hypothesis, Hypothesis)
        rest = condition_on(problem, groups.competing, hypothesis)
    noise, chi2 = hypothesis.noise, hypothesis.rss / hypothesis.noise**2
    by_size = np.full((len(problem.sizes), len(problem.prior_costs)), -np.inf)
    for members, columns, scales, plausible in zip(
        groups.members, groups.columns, groups.prior_scales, groups.plausible, strict=True
    ):
        inside = np.ones(len(members), dtype=np.bool_) if asked is None else asked[members]
        if not np.any(inside):
            continue
        at = columns[inside]
        largest = plausible[inside] * problem.scale[groups.competing[at]]
        D, r = rest.own(problem, at) / noise**2, rest.b[at] / noise**2
        quadratic, logdet = _by_size(D, r, problem.sizes, scales[inside], largest)
        if hypothesis.settled:
            likelier = profiled_gain(quadratic, chi2, problem.n, noise, problem.least_noise)
        else:
            likelier = 0.5 * quadratic
        by_size[:, members[inside]] = likelier - 0.5 * logdet
    # what can't be negative and would be is not worth looking at; the others' prior is twice as dense
    half_line = np.flatnonzero(problem.space.nonnegative & np.isfinite(by_size[0]))
    first = [int(problem.space.candidates[number].columns[0]) for number in half_line]
    pushed = rest.b[np.searchsorted(groups.competing, first)] > 0
    by_size[:, half_line] += np.where(pushed, np.log(2), -np.inf)
    return np.asarray(by_size - problem.prior_costs - np.log(len(problem.sizes)))


def _by_size(D: Array, r: Array, sizes: Array, scale: Array, largest: Array) -> tuple[Array, Array]:
    """As `quadratic_and_logdet`, with prior sizes (m, c) sizes x scale, but no larger than ``largest``, mm."""
    held = (largest < sizes[-1] * scale).any(axis=1)
    if not held.any():
        return quadratic_and_logdet(D * scale[:, :, None] * scale[:, None, :], r * scale, sizes**2)
    quadratic, logdet = np.empty((len(sizes), len(D))), np.empty((len(sizes), len(D)))
    free = ~held
    if free.any():
        own = scale[free]
        inner = D[free] * own[:, :, None] * own[:, None, :]
        quadratic[:, free], logdet[:, free] = quadratic_and_logdet(inner, r[free] * own, sizes**2)
    # each size has a shape of its own: as many blocks
    own = within(sizes[:, None, None] * scale[held], largest[held], np.ones(1))
    inner = (D[held] * own[..., :, None] * own[..., None, :]).reshape(-1, *D.shape[1:])
    (told,), (spread,) = quadratic_and_logdet(inner, (r[held] * own).reshape(-1, D.shape[1]), np.ones(1))
    quadratic[:, held], logdet[:, held] = told.reshape(len(sizes), -1), spread.reshape(len(sizes), -1)
    return quadratic, logdet


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
    quadratic, logdet = quadratic_and_logdet(D, b / scale / hypothesis.noise**2, problem.sizes**2)
    return np.asarray((0.5 * (quadratic - logdet)).max(axis=0))


def unscaled_factor(problem: Problem, hypothesis: Hypothesis) -> tuple[Array, Array]:
    """The hypothesis' Cholesky factor for columns in mm per SI unit, and factor^-1 b."""
    at = hypothesis.columns
    whitened_rhs = hypothesis.inverse @ problem.equations.b[at]
    return hypothesis.cholesky * problem.scale[at][:, None], whitened_rhs
