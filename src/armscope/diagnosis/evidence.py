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

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dtrtri, dtrtrs
from scipy.special import log_ndtr

from armscope.diagnosis.problem import Gram, Indices, Pool, scales

Array = NDArray[np.float64]

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
CROWDED_NATS = 15.0
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
class Chosen:
    """An effect in a hypothesis: which candidate, with which size (index into the problem's sizes).

    One that stands ``within`` a background or a curve is a name for a part of it, and pays nothing for itself.
    """

    candidate: int
    size: int
    within: bool = False


@dataclass(frozen=True, eq=False)
class Problem:
    """A Gram matrix made ready for weighing hypotheses.

    Attributes:
        pool: what the columns are.
        gram: with columns scaled to 1 mm RMS at the tool.
        scale: (p,) what they were divided by, mm per SI unit.
        least_noise: mm; the noise is never taken to be below (stated, or seen in repeats).
        sizes: (SIZES,) effect sizes that compete, mm at the tool.
        costs: (candidates,) log prior odds against each candidate, nats.
        background_cost: of an elastic or transmission background: one kind of error among the others, of some size.
        mismatch: RMS per axis after the free frames, mm.
    """

    pool: Pool
    gram: Gram
    scale: Array
    least_noise: float
    sizes: Array
    costs: Array
    background_cost: float
    mismatch: float

    @property
    def n(self) -> float:
        """Number of residuals."""
        return self.gram.n

    def with_gram(self, gram: Gram) -> Problem:
        """The same problem on other rows; ``gram`` is unscaled."""
        return replace(self, gram=gram.scaled(self.scale))


def problem(pool: Pool, gram: Gram, least_noise: float) -> Problem:
    """Scale a Gram matrix and set prior sizes and costs."""
    scale = scales(gram, pool.frames)
    scaled = gram.scaled(scale)
    mismatch = _rms_after_frames(scaled, pool.frames)
    low = max(least_noise * min(BARELY_SEEN / np.sqrt(max(gram.n, 1.0)), 0.5), 0.01 * mismatch)
    sizes = np.geomspace(low, max(2 * mismatch, 4 * low), SIZES)
    spread = float(np.log(kinds(pool)) + np.log(FAMILY_SIZES - 1))
    return Problem(pool, scaled, scale, least_noise, sizes, costs(pool), spread, mismatch)


def _rms_after_frames(gram: Gram, frames: Indices) -> float:
    Gf = gram.G[np.ix_(frames, frames)]
    explained = gram.b[frames] @ np.linalg.lstsq(Gf, gram.b[frames], rcond=1e-12)[0]
    left = float(gram.yy - explained)
    return float(np.sqrt(max(left, 0.0) / max(gram.n - len(frames), 1.0)))


def kinds(pool: Pool) -> int:
    """How many types of effects compete."""
    return max(len({placed.name for placed in pool.candidates}), 1)


def costs(pool: Pool) -> Array:
    """Each effect type is as likely as any other, each of its locations as any other, each scanned number, too."""
    locations: dict[str, set[str]] = {}
    variants: dict[tuple[str, str], int] = {}
    for placed in pool.candidates:
        locations.setdefault(placed.name, set()).add(placed.location)
        if placed.tried == 1 and not placed.fine:
            variants[placed.key] = variants.get(placed.key, 0) + 1
    return np.array(
        [
            SURE_NATS
            + np.log(kinds(pool))
            + np.log(len(locations[placed.name]))
            + np.log(placed.tried if placed.tried > 1 else variants.get(placed.key, 1))
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
        value: log evidence with prior, nats.
        columns: columns of the pool that take part, ascending.
        variance: their prior variances, mm^2 at the tool.
        factor: Cholesky factor (lower) of G + noise^2 / variance.
        mean: posterior mean of the scaled coefficients.
        rss: penalised residual sum of squares, mm^2.
        settled: whether the noise is this hypothesis' own.
    """

    chosen: tuple[Chosen, ...]
    background: Background
    noise: float
    value: float
    columns: Indices = field(repr=False)
    variance: Array = field(repr=False)
    factor: Array = field(repr=False)
    mean: Array = field(repr=False)
    rss: float = field(repr=False)
    settled: bool = True

    @functools.cached_property
    def inverse(self) -> Array:
        """The inverse of the factor."""
        return np.asarray(dtrtri(self.factor, lower=1)[0])

    @property
    def candidates(self) -> frozenset[int]:
        """The numbers of its candidates."""
        return frozenset(c.candidate for c in self.chosen)

    def coefficients(self, p: int) -> Array:
        """(p,) posterior mean of all scaled coefficients, zero where a column takes no part."""
        full = np.zeros(p)
        full[self.columns] = self.mean
        return full


def weigh(
    problem: Problem, chosen: tuple[Chosen, ...], background: Background, noise: float, steps: int = NOISE_STEPS
) -> Hypothesis:
    """Evidence of a hypothesis; the noise starts from ``noise`` and is re-estimated (MacKay 1992), or kept (1 step)."""
    prior = prior_variances(problem, chosen, background)
    columns = np.flatnonzero(prior > 0)
    variance = prior[columns]
    G, b = problem.gram.G[np.ix_(columns, columns)], problem.gram.b[columns]
    spent = inverse = None
    for step in range(steps):
        factor = lower_factor(G, noise**2 / variance)
        half = forward(factor, b)
        rss = float(problem.gram.yy - half @ half)
        mean = np.asarray(dtrtrs(factor, half, lower=1, trans=1)[0])
        if step == steps - 1:
            break
        if spent is None:
            # how many values the data determine hardly changes with the noise: one inverse is enough
            inverse = dtrtri(factor, lower=1)[0]
            spent = len(columns) - noise**2 * float(np.sum(np.einsum("ij,ij->j", inverse, inverse) / variance))
        misfit = rss - noise**2 * float(np.sum(mean**2 / variance))
        updated = np.sqrt(max(misfit, 0.0) / max(problem.n - spent, 1.0))
        updated = max(float(updated), problem.least_noise, 1e-6)
        if abs(updated - noise) < NOISE_SETTLED * noise:
            break
        noise = updated
    inverse = dtrtri(factor, lower=1)[0] if inverse is None else inverse
    logdet = 2 * np.sum(np.log(np.diag(factor))) + np.sum(np.log(variance)) - 2 * len(columns) * np.log(noise)
    evidence = -problem.n * np.log(noise) - 0.5 * logdet - 0.5 * rss / noise**2
    own = [c for c in chosen if not c.within]
    paid = sum(problem.costs[c.candidate] + np.log(len(problem.sizes)) for c in own)
    paid += problem.background_cost * np.count_nonzero(background[1:])
    paid -= _along(problem, own, columns, mean, noise * np.sqrt(np.sum(inverse**2, axis=0)))
    paid += CROWDED_NATS * max(problem.pool.crowding(frozenset(c.candidate for c in own)), 0)
    if not problem.pool.stands(frozenset(c.candidate for c in chosen)):
        paid = np.inf
    value = float(evidence - paid)
    return Hypothesis(chosen, background, noise, value, columns, variance, factor, mean, rss, steps > 1)


def _along(problem: Problem, chosen: Sequence[Chosen], columns: Indices, mean: Array, stderr: Array) -> float:
    """Nats that values gain, which can't be negative, each by itself: half of the prior goes to the other half."""
    values = [int(problem.pool.columns[c.candidate][0]) for c in chosen if problem.pool.along[c.candidate]]
    at = np.searchsorted(columns, values)
    return float(np.sum(np.log(2) + log_ndtr(mean[at] / stderr[at])))


ROUNDING = 1e-11


def lower_factor(G: Array, ridge: Array) -> Array:
    """Cholesky factor (lower) of G + diag(ridge); a ridge below rounding is raised to it (few rows, fitted exactly)."""
    A = G.copy()
    A[np.diag_indices_from(A)] += np.maximum(ridge, ROUNDING * np.diag(G))
    factor, failed = dpotrf(A, lower=1, clean=1, overwrite_a=1)
    if failed:
        raise np.linalg.LinAlgError(f"the Gram matrix is not positive definite at column {failed}")
    return np.asarray(factor)


def forward(factor: Array, right: Array) -> Array:
    """factor^-1 right."""
    return np.asarray(dtrtrs(factor, right, lower=1)[0])


def pinned_losses(problem: Problem, hypothesis: Hypothesis, groups: Sequence[Indices]) -> Array:
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


def losses(problem: Problem, hypothesis: Hypothesis) -> Array:
    """What each chosen effect's removal would cost, nats, at the noise as it is (Savage-Dickey ratio)."""
    at = {int(column): n for n, column in enumerate(hypothesis.columns)}
    lost = []
    for c in hypothesis.chosen:
        own = np.array([at[int(column)] for column in problem.pool.columns[c.candidate]])
        added = (problem.sizes[c.size] * np.array(problem.pool.candidates[c.candidate].shape)) ** 2
        rest = np.maximum(hypothesis.variance[own] - added, 1e-12 * added)
        inverse = hypothesis.inverse[:, own]
        sigma = hypothesis.noise**2 * (inverse.T @ inverse)
        # removal replaces the prior precision 1/v by 1/rest; where nothing is left, the columns are pinned to zero
        extra = 1 / rest - 1 / hypothesis.variance[own]
        M = np.eye(len(own)) + sigma * extra[None, :]
        mean = hypothesis.mean[own]
        quadratic = mean @ (extra * np.linalg.solve(M, mean))
        logdet = np.linalg.slogdet(M)[1] - np.sum(np.log(hypothesis.variance[own] / rest))
        lost.append(0.5 * quadratic + 0.5 * logdet - problem.costs[c.candidate] - np.log(len(problem.sizes)))
    return np.array(lost)


def prior_variances(problem: Problem, chosen: tuple[Chosen, ...], background: Background) -> Array:
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
        own = np.array(pool.candidates[c.candidate].shape)
        prior[pool.columns[c.candidate]] += (problem.sizes[c.size] * own) ** 2
    return prior


def background_sizes(problem: Problem, hypothesis: Hypothesis) -> tuple[float, ...]:
    """Size of each family's background: share of the tolerance for the geometric one, mm at the tool for the others."""
    first, *others = hypothesis.background
    return BACKGROUND_SIZES[first], *(float(problem.sizes[size - 1]) if size else 0.0 for size in others)


@dataclass(frozen=True, eq=False)
class Groups:
    """Candidates of equal numbers of columns, so that they are scored together."""

    members: tuple[Indices, ...]
    columns: tuple[Indices, ...]
    shapes: tuple[Array, ...]


def group(pool: Pool) -> Groups:
    """Candidates that compete, by their number of columns."""
    by_size: dict[int, list[int]] = {}
    for number, columns in enumerate(pool.columns):
        if pool.candidates[number].fine:
            continue
        by_size.setdefault(len(columns), []).append(number)
    return Groups(
        tuple(np.array(members) for members in by_size.values()),
        tuple(np.array([pool.columns[m] for m in members]) for members in by_size.values()),
        tuple(np.array([pool.candidates[m].shape for m in members]) for members in by_size.values()),
    )


def gains(problem: Problem, groups: Groups, hypothesis: Hypothesis) -> tuple[Array, Indices]:
    """What each candidate would add to a hypothesis' value at its best size, nats, and the index of that size."""
    by_size = gains_by_size(problem, groups, hypothesis)
    return by_size.max(axis=0), by_size.argmax(axis=0)


def gains_by_size(problem: Problem, groups: Groups, hypothesis: Hypothesis) -> Array:
    """(SIZES, candidates) what each candidate would add to a hypothesis' value at each size, nats.

    The posterior of the hypothesis is conditioned on (Schur complement), so the gain is exact up to the noise's
    re-estimation, for which the profile of the likelihood over the noise is used; a noise that is not the hypothesis'
    own stays.
    """
    G, b = problem.gram.G, problem.gram.b
    S, noise = hypothesis.columns, hypothesis.noise
    V = hypothesis.inverse @ G[S]
    half = hypothesis.inverse @ b[S]
    r_all = (b - half @ V) / noise**2
    by_size = np.full((len(problem.sizes), len(problem.costs)), -np.inf)
    s2 = problem.sizes**2
    chi2 = hypothesis.rss / noise**2
    for members, columns, shapes in zip(groups.members, groups.columns, groups.shapes, strict=True):
        Vc = np.moveaxis(V[:, columns], 0, 1)
        inner = G[columns[:, :, None], columns[:, None, :]] - np.swapaxes(Vc, 1, 2) @ Vc
        D = inner / noise**2 * shapes[:, :, None] * shapes[:, None, :]
        r = r_all[columns] * shapes
        eigenvalues, vectors = np.linalg.eigh(D)
        eigenvalues = np.maximum(eigenvalues, 0.0)
        u2 = np.einsum("mij,mi->mj", vectors, r) ** 2
        shrunk = s2[:, None, None] / (1 + s2[:, None, None] * eigenvalues)
        quadratic = np.sum(u2 * shrunk, axis=2)
        logdet = np.sum(np.log1p(s2[:, None, None] * eigenvalues), axis=2)
        if hypothesis.settled:
            likelier = _profiled(quadratic, chi2, problem.n, noise, problem.least_noise)
        else:
            likelier = 0.5 * quadratic
        by_size[:, members] = likelier - 0.5 * logdet
    # what can't be negative and would be is not worth looking at; the others' prior is twice as dense
    for number in np.flatnonzero(problem.pool.along):
        by_size[:, number] += np.log(2) if r_all[problem.pool.columns[number][0]] > 0 else -np.inf
    return by_size - problem.costs - np.log(len(problem.sizes))


def joint_gains(problem: Problem, rest: Hypothesis, sets: Sequence[tuple[Chosen, ...]]) -> Array:
    """What each set of effects together would add to a hypothesis' value, nats; for small sets of small effects."""
    members = sorted({c.candidate for chosen in sets for c in chosen})
    columns = np.concatenate([problem.pool.columns[m] for m in members])
    G, S, noise = problem.gram.G, rest.columns, rest.noise
    V = rest.inverse @ G[np.ix_(S, columns)]
    inner = (G[np.ix_(columns, columns)] - V.T @ V) / noise**2
    r = (problem.gram.b[columns] - V.T @ (rest.inverse @ problem.gram.b[S])) / noise**2
    ends = np.cumsum([len(problem.pool.columns[m]) for m in members])
    at = {m: np.arange(end - len(problem.pool.columns[m]), end) for m, end in zip(members, ends, strict=True)}
    totals = []
    for chosen in sets:
        own = np.concatenate([at[c.candidate] for c in chosen])
        size = np.concatenate(
            [problem.sizes[c.size] * np.array(problem.pool.candidates[c.candidate].shape) for c in chosen]
        )
        A = np.eye(len(own)) + inner[np.ix_(own, own)] * np.outer(size, size)
        u = size * r[own]
        quadratic = np.array(float(u @ np.linalg.solve(A, u)))
        gain = _profiled(quadratic, rest.rss / noise**2, problem.n, noise, problem.least_noise)
        paid = sum(problem.costs[c.candidate] + np.log(len(problem.sizes)) for c in chosen)
        totals.append(float(gain) - 0.5 * float(np.linalg.slogdet(A)[1]) - paid)
    return np.array(totals)


def _profiled(quadratic: Array, chi2: float, n: float, noise: float, least: float) -> Array:
    """Gain of log likelihood when chi2 falls by ``quadratic`` and the noise follows, not below its least value."""
    left = np.maximum(chi2 - quadratic, 1e-9 * chi2)
    ratio = np.maximum(np.sqrt(left / chi2), min(1.0, least / noise))
    return np.asarray(-n * np.log(ratio) + 0.5 * chi2 - 0.5 * left / ratio**2)
