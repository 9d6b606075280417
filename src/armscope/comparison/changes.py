"""Which causes differ between recordings, each tested beside all that the recordings share.

Linear about the nominal arm. Shared by all recordings: every effect of the library that belongs to the arm, each held
by a prior of some millimetres at the tool (what no data tell apart stays small). Of each recording's own: base and
tool. A change is one effect more in some of the recordings. Its F statistic beside all that is shared says how likely
chance makes it; the smallest of all, times their number (Bonferroni), is the joint test that nothing changed. While it
is below the level, the surest change is taken in and the rest are tested beside it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc, stdtrit

from armscope.comparison.result import Change, Comparison, Kind, Valued
from armscope.comparison.sets import stacked
from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.linearisation import linearised, point_residuals
from armscope.fitting.registration import fit_frames
from armscope.fitting.transfer import belongs_to_the_arm
from armscope.measurement import robust
from armscope.physics.effect import Placed, Term
from armscope.physics.frames import free_frames
from armscope.physics.model import FittedModel
from armscope.physics.registry import library
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.wording import plain

LEVEL = 0.05
"""How often something is named although nothing changed: convention."""
PRIOR_MM = 3.0
"""Of a shared effect at the tool: an arm's own errors are of this size (ISO 9283 accuracies of uncalibrated arms)."""
MOST_TERMS = 12
"""Of an effect whose change is tested; free curves are left out: they would stand for any other."""
MOST_CHANGES = 8
UNSEEN = 1e-3
"""Share of a column's square that must be left beside what is shared for its change to be seen at all."""
HELD = 1e-9
"""Penalty on frames and changes of unit length: too little for any that the rows tell."""
AS_GOOD_NATS = 3.0
"""20 to 1: causes closer than this are not told apart."""


@dataclass(frozen=True, eq=False)
class _Possible:
    """A change that may be: an effect's columns (3N, q), mm per unit, in the rows of some recordings."""

    placed: Placed
    columns: Array
    sets: tuple[int, ...]


@dataclass(frozen=True)
class _Scored:
    f: float
    q: int
    p: float
    nats: float


def compare(arm: Arm, recordings: Mapping[str, Recordings], of_arms: bool = False) -> Comparison:
    """What changed between recordings of one arm, or which of several arms of a type is unlike the others.

    Args:
        arm: the nominal arm.
        recordings: two or more by name, in the order of time.
        of_arms: several arms: a change is in one recording alone; else it holds from a recording on.

    Returns:
        The joint test, and every change with its interval.

    Raises:
        InputError: fewer than two recordings, or one that does not fit the arm.
    """
    table, group = stacked(arm, recordings)
    problem = _Problem(arm, table, group)
    possible = problem.possible_changes(_masks(len(recordings), of_arms))
    taken: list[_Possible] = []
    found: list[tuple[_Possible, _Scored, tuple[str, ...]]] = []
    joint, tried = 1.0, len(possible)
    while possible and len(taken) < MOST_CHANGES:
        scores = problem.scores(possible, taken)
        p = min(1.0, min(score.p for score in scores) * tried)
        joint = p if not taken else joint
        if p > LEVEL:
            break
        sure = [each for each, score in enumerate(scores) if score.p * tried <= LEVEL]
        best = max(sure, key=lambda each: scores[each].nats)
        found.append((possible[best], scores[best], _as_good(possible, scores, best)))
        taken.append(possible.pop(best))
    names = tuple(recordings)
    return Comparison(
        arm=arm.name,
        names=names,
        rows=tuple(np.bincount(group).tolist()),
        noise_mm=float(np.sqrt(problem.variance(taken))),
        p_nothing_changed=joint,
        level=LEVEL,
        tried=tried,
        changes=tuple(problem.change(each, score.p, others, taken, names) for each, score, others in found),
    )


def _masks(count: int, of_arms: bool) -> list[tuple[int, ...]]:
    if of_arms:
        return [(each,) for each in range(count)] if count > 2 else [(1,)]
    return [tuple(range(first, count)) for first in range(1, count)]


def _as_good(possible: Sequence[_Possible], scores: Sequence[_Scored], best: int) -> tuple[str, ...]:
    ranked = sorted(range(len(possible)), key=lambda each: -scores[each].nats)
    near = [each for each in ranked if scores[each].nats > scores[best].nats - AS_GOOD_NATS and each != best]
    there = [possible[each].placed for each in near if possible[each].sets == possible[best].sets]
    return tuple(dict.fromkeys(plain(str(each)) for each in there))


class _Problem:
    """Frames and shared effects, what they leave, and changes beside them."""

    def __init__(self, arm: Arm, table: Recordings, group: Indices) -> None:
        self.group = np.repeat(group, 3)
        model = fit_frames(arm, table)
        residual = point_residuals(model, table)
        weight = np.repeat(np.sqrt(robust.huber_weights(residual, np.ones(len(residual)), 0.0)), 3)
        placed = [each for each in library(arm, table) if belongs_to_the_arm(each)]
        self.placed = [each for each in placed if len(each.terms) <= MOST_TERMS and each.family != "unknown"]
        frames = [term for each in free_frames(table, False) for term in each.terms]
        terms = [term for each in self.placed for term in each.terms]
        columns = weight[:, None] * _columns(model, table, [*frames, *terms])
        self.residual = weight * residual.reshape(-1)
        self.frames, self.effects = columns[:, : len(frames)], columns[:, len(frames) :]
        size = np.sqrt(np.mean(self.effects**2, axis=0))
        self.scale = np.where(size > 0, PRIOR_MM / np.where(size > 0, size, 1), 0.0)
        self._start = np.cumsum([0, *(len(each.terms) for each in self.placed)])
        self._noise = self._settled_noise()

    def possible_changes(self, masks: Sequence[tuple[int, ...]]) -> list[_Possible]:
        """Every effect of the library in every one of some groups of recordings."""
        return [
            _Possible(each, self._columns_of(number, mask), mask)
            for number, each in enumerate(self.placed)
            for mask in masks
            if np.abs(self._columns_of(number, mask)).max() > 0
        ]

    def scores(self, possible: Sequence[_Possible], taken: Sequence[_Possible]) -> list[_Scored]:
        """How much better each change makes the fit, beside those that were taken."""
        base, penalty = self._base(taken)
        variance, free = self._left(base, penalty)
        factor = np.linalg.cholesky(base.T @ base + np.diag(penalty))
        half = np.linalg.solve(factor, base.T)
        left = self.residual - half.T @ (half @ self.residual)
        return [self._score(each.columns, half, left, variance, free) for each in possible]

    @staticmethod
    def _score(columns: Array, half: Array, left: Array, variance: float, free: float) -> _Scored:
        size = np.sqrt(np.sum(columns**2, axis=0))
        columns = columns[:, size > 0] / size[size > 0]
        across = half @ columns
        values, vectors = np.linalg.eigh(columns.T @ columns - across.T @ across)
        seen = values > UNSEEN
        if not seen.any():
            return _Scored(0.0, 0, 1.0, 0.0)
        along = (vectors[:, seen].T @ (columns.T @ left)) / np.sqrt(values[seen])
        gain, q = float(along @ along), int(seen.sum())
        total = variance * free
        # the variance without what the change explains: of the model in which it is free
        without = max(total - gain, 1e-12 * total)
        f = (gain / q) / (without / (free - q))
        # the noise is as unknown as the change: profile likelihood, and what q numbers cost (Schwarz 1978)
        nats = free / 2 * np.log(total / without) - q / 2 * np.log(max(free, 2.0))
        return _Scored(f, q, float(fdtrc(q, free - q, f)), float(nats))

    def variance(self, taken: Sequence[_Possible]) -> float:
        """Of what is left, per axis, mm^2."""
        return self._left(*self._base(taken))[0]

    def change(
        self, each: _Possible, p: float, others: tuple[str, ...], taken: Sequence[_Possible], names: tuple[str, ...]
    ) -> Change:
        """A change in numbers: the effect with a value of its own in every recording.

        Args:
            each: the change.
            p: its own test's.
            others: what explains it as well.
            taken: all changes.
            names: of the recordings.

        Returns:
            The change in words and file units.
        """
        number = self.placed.index(each.placed)
        beside = [other for other in taken if other is not each]
        values, covariance = self._own_values(number, beside, len(names))
        q = len(each.placed.terms)
        inside = np.isin(np.arange(len(names)), each.sets)
        contrast = np.where(inside, 1 / inside.sum(), -1 / (~inside).sum())
        parameters = []
        for place, term in enumerate(each.placed.terms):
            at = place + q * np.arange(len(names))
            difference = float(contrast @ values[at])
            error = float(np.sqrt(contrast @ covariance[np.ix_(at, at)] @ contrast))
            stderrs = np.sqrt(np.diag(covariance)[at])
            parameters.append(_valued(term, values[at], stderrs, difference, error, self._free))
        by_set = values.reshape(len(names), q)
        moved = each.columns @ (by_set[each.sets[0]] - by_set[~inside].mean(axis=0))
        moved = moved - self.frames @ np.linalg.lstsq(self.frames, moved, rcond=None)[0]
        rms = float(np.sqrt(np.sum(moved**2) / (np.isin(self.group, each.sets).sum() / 3)))
        title, where = plain(str(each.placed)), tuple(names[k] for k in each.sets)
        kind = _kind(parameters, inside)
        return Change(each.placed.name, each.placed.location, title, where, kind, rms, p, tuple(parameters), others)

    def _own_values(self, number: int, beside: Sequence[_Possible], count: int) -> tuple[Array, Array]:
        base, penalty = self._base(beside, without=number)
        own = np.hstack([self._columns_of(number, (k,)) for k in range(count)])
        # what one recording alone does not tell stays at the prior
        scale = np.tile(self.scale[self._start[number] : self._start[number + 1]], count)
        scale = np.where(scale > 0, scale, 1.0)
        design = np.hstack([base, own])
        held = np.concatenate([penalty, self._noise / (10 * scale) ** 2])
        inverse = np.linalg.inv(design.T @ design + np.diag(held))
        values = (inverse @ (design.T @ self.residual))[-own.shape[1] :]
        variance, self._free = self._left(design, held)
        return values, variance * inverse[-own.shape[1] :, -own.shape[1] :]

    def _columns_of(self, number: int, sets: tuple[int, ...]) -> Array:
        columns = self.effects[:, self._start[number] : self._start[number + 1]]
        return columns * np.isin(self.group, sets)[:, None]

    def _base(self, taken: Sequence[_Possible], without: int | None = None) -> tuple[Array, Array]:
        """Columns that all changes stand beside, and the penalty on each."""
        kept: NDArray[np.bool_] = self.scale > 0
        if without is not None:
            kept = kept.copy()
            kept[self._start[without] : self._start[without + 1]] = False
        free = np.hstack([self.frames, *(each.columns for each in taken)])
        free = free / np.maximum(_length(free), 1e-30)
        shared = self.effects[:, kept] * self.scale[kept]
        small = np.full(free.shape[1], HELD)  # a wrist that was held leaves part of its tool to the base
        return np.hstack([free, shared]), np.concatenate([small, np.full(shared.shape[1], self._noise)])

    def _left(self, base: Array, penalty: Array) -> tuple[float, float]:
        """Variance per number, and how many numbers are free, beside columns with penalties."""
        gram = base.T @ base
        inverse = np.linalg.inv(gram + np.diag(penalty))
        values = inverse @ (base.T @ self.residual)
        left = self.residual - base @ values
        used = float(np.trace(inverse @ gram))
        free = max(len(left) - used, 1.0)
        return float((left @ left + values**2 @ penalty) / free), free

    def _settled_noise(self) -> float:
        """The variance that the prior is weighed by, found with itself."""
        self._noise = float(np.mean(self.residual**2)) / 100 + 1e-12
        for _ in range(4):
            self._noise = max(self._left(*self._base(()))[0], 1e-12)
        return self._noise


def _length(columns: Array) -> Array:
    return np.asarray(np.sqrt(np.sum(columns**2, axis=0)))


def _columns(model: FittedModel, table: Recordings, terms: Sequence[Term]) -> Array:
    """(3N, p) columns in the order of the rows."""
    found = np.empty((len(table), 3, len(terms)))
    for rows, posture in linearised(table).chunks(model):
        found[rows] = point_columns(posture, terms).reshape(-1, 3, len(terms))
    return found.reshape(-1, len(terms))


def _valued(term: Term, values: Array, stderrs: Array, difference: float, error: float, free: float) -> Valued:
    half = float(stdtrit(free, 0.975)) * error / term.si
    told, errors = tuple((values / term.si).tolist()), tuple((stderrs / term.si).tolist())
    change = difference / term.si
    return Valued(term.name, term.unit, told, errors, change, (change - half, change + half))


def _kind(parameters: Sequence[Valued], inside: NDArray[np.bool_]) -> Kind:
    """What became of the parameter that changed most surely."""
    surest = max(parameters, key=lambda each: abs(each.difference) / (each.interval_95[1] - each.interval_95[0]))
    values, errors = np.array(surest.values), np.array(surest.stderrs)
    before, after = np.mean(values[~inside]), np.mean(values[inside])
    was = abs(before) > 1.96 * np.sqrt(np.mean(errors[~inside] ** 2))
    is_now = abs(after) > 1.96 * np.sqrt(np.mean(errors[inside] ** 2))
    if was != is_now:
        return "came" if is_now else "went"
    if before * after < 0:
        return "changed"
    return "grew" if abs(after) > abs(before) else "shrank"
