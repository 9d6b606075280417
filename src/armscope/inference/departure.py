"""A hypothesis beside one whose factor is known, at the noise as it is: nothing is factorised anew.

With A = G + s P^-1 of the known one (s: noise squared) and prior variances that change by d at a few columns X_R, the
data's covariance changes by X_R d X_R': Woodbury's identity gives evidence, residual, and how many values the data
determine, from products of those columns with what the known one leaves. Columns whose variance falls are counted in
units of it, so that what is well determined does not cancel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.inference.linear_algebra import among, crossed
from armscope.inference.normal_equations import NormalEquations


class Known(Protocol):
    """What is asked of a known hypothesis (`armscope.inference.evidence.Hypothesis`)."""

    @property
    def equations(self) -> NormalEquations:
        """The sums that it is of."""

    @property
    def noise(self) -> float:
        """mm per axis."""

    @property
    def columns(self) -> Indices:
        """(k,) ascending."""

    @property
    def variance(self) -> Array:
        """(k,) prior variances."""

    @property
    def mean(self) -> Array:
        """(k,) posterior means."""

    @property
    def rss(self) -> float:
        """Penalised residual sum of squares."""

    @property
    def log_evidence(self) -> float:
        """Nats."""

    @property
    def inverse(self) -> Array:
        """(k, k) of its lower factor."""

    @property
    def effective_dof(self) -> float:
        """How many values the data determine at its noise."""


@dataclass(frozen=True, eq=False)
class Departure:
    """A hypothesis of other prior variances at a known one's noise."""

    known: Known  # from which it departs
    log_evidence: float  # nats
    rss: float  # penalised residual sum of squares, mm^2
    misfit: float  # the residual's own sum of squares, mm^2
    effective_dof: float  # how many values the data determine
    # gained, lost: columns whose prior variance is larger, smaller
    gained: Indices
    lost: Indices
    moves: Array  # (k, r) by how much the known columns' means move per unit of each change
    inner: Array  # (r, r) matrix of the change
    change: Array  # (r,) the change

    def means(self, columns: Indices) -> Array | None:
        """(h,) values of some columns; None where one has a smaller variance than it had."""
        if np.isin(self.lost, columns).any():
            return None
        mean = np.zeros(len(self.known.equations.b))
        mean[self.known.columns] = self.known.mean + self.moves @ self.change
        mean[self.gained] += self.change[len(self.lost) :]
        return np.asarray(mean[columns])

    def spread(self, columns: Indices) -> Array | None:
        """(h,) their standard errors, in units of the noise; None where one has a smaller variance than it had."""
        if np.isin(columns, self.lost).any():
            return None
        square, there, at = np.zeros(len(columns)), *self._known(columns)
        square[there] = np.sum(self.known.inverse[:, at] ** 2, axis=0)
        moved = self._moved(columns)
        square += np.einsum("hr,rh->h", moved, np.linalg.solve(self.inner, moved.T)) / self.known.noise**2
        return np.asarray(np.sqrt(np.maximum(square, 1e-300)))

    def _moved(self, columns: Indices) -> Array:
        """(h, r) by how much some columns' values move per unit of each change."""
        moved, there, at = np.zeros((len(columns), len(self.change))), *self._known(columns)
        moved[there] = self.moves[at]
        moved[:, len(self.lost) :] += columns[:, None] == self.gained
        return moved

    def _known(self, columns: Indices) -> tuple[NDArray[np.bool_], Indices]:
        """Which of some columns take part in the known hypothesis, and where those stand there."""
        there = np.isin(columns, self.known.columns)
        return there, np.searchsorted(self.known.columns, columns[there])


def departure(known: Known, columns: Indices, variance: Array) -> Departure | None:
    """The hypothesis of some prior variances at the noise of a known one.

    Args:
        known: from which it departs.
        columns: (k,) that take part, ascending.
        variance: (k,) their prior variances, mm^2.

    Returns:
        It, or None where so much changes that a factor of its own takes less.
    """
    before, after = np.zeros(len(known.equations.b)), np.zeros(len(known.equations.b))
    before[known.columns], after[columns] = known.variance, variance
    changed = np.flatnonzero(np.abs(after - before) > NUMERICS.rounded * np.maximum(after, before))
    if len(changed) > NUMERICS.departs * len(known.columns):
        return None
    by = after[changed] - before[changed]
    gained, lost = changed[by > 0], changed[by < 0]
    change = _Change(known, gained, lost, by[by > 0], before[lost], after[lost])
    return change.departure()


@dataclass(frozen=True, eq=False)
class _Change:
    """Columns whose prior variances change, those that lose some of it first."""

    known: Known  # what they change in
    # gained, lost: columns
    gained: Indices
    lost: Indices
    by: Array  # what the gaining ones gain
    # was, left: variances of the losing ones before and after
    was: Array
    left: Array

    def departure(self) -> Departure:
        """What the change comes to."""
        known, s = self.known, self.known.noise**2
        moves, own, shared, pull = self._probed()
        r = len(self.lost)
        inner = shared.copy()
        inner[np.arange(r), np.arange(r)] -= self.left * self.was / (self.was - self.left)
        inner[np.arange(r, len(inner)), np.arange(r, len(inner))] += 1 / self.by
        change = np.asarray(np.linalg.solve(inner, pull), dtype=np.float64)
        # what the known hypothesis leaves of the columns, and of the response, once more left by it
        twice = own - s * (moves.T / known.variance) @ moves
        towards = s * moves.T @ (known.mean / known.variance)
        towards[r:] += s * pull[r:]
        sizes = np.concatenate([(self.was - self.left) / self.was**2, self.by])
        logdet = float(np.linalg.slogdet(inner)[1] + np.log(sizes).sum())
        gain = float(pull @ change)
        misfit = known.rss - s * float(known.mean**2 @ (1 / known.variance))
        return Departure(
            known,
            known.log_evidence - 0.5 * logdet + 0.5 * gain,
            known.rss - s * gain,
            misfit + float(change @ twice @ change - 2 * change @ towards),
            known.effective_dof + float(np.trace(np.linalg.solve(inner, twice))) / s,
            self.gained,
            self.lost,
            moves,
            inner,
            change,
        )

    def _probed(self) -> tuple[Array, Array, Array, Array]:
        """(k, r) how the known means move; (r, r) own products; (r, r) what is left of them; (r,) what pulls."""
        known, s = self.known, self.known.noise**2
        G, b, inside, inverse = known.equations.G, known.equations.b, known.columns, known.inverse
        at = np.searchsorted(inside, self.lost)
        taken = inverse @ crossed(G, inside, self.gained)
        both = inverse.T @ np.concatenate([inverse[:, at], taken], axis=1)
        r = len(at)
        moves = np.concatenate([s * both[:, :r], -both[:, r:]], axis=1)
        left = among(G, self.gained) - taken.T @ taken
        own, shared = np.zeros((moves.shape[1],) * 2), np.zeros((moves.shape[1],) * 2)
        own[:r, :r], own[r:, r:] = s * moves[at, :r], left
        shared[:r, :r], shared[r:, r:] = -moves[at, :r], left / s
        shared[:r, r:] = both[at, r:]
        shared[r:, :r] = both[at, r:].T
        pull = np.concatenate([known.mean[at], (b[self.gained] - crossed(G, self.gained, inside) @ known.mean) / s])
        return moves, own, shared, pull
