"""The fitness of a coefficient vector in a few multiplications, whatever the rows.

With the design matrix A = Q R of N rows, |A z - y|^2 = |R z - Q'y|^2 + (what no z can explain), so that

    fitness(z) = RMS residual = sqrt( (|R z - Q'y|^2 + rest) / N ),

the same function with the triangular factor in place of the rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices


@dataclass(frozen=True)
class LeastSquares:
    """S least-squares problems in D coefficients, as an objective: fitness = sqrt(|R z - b|^2 + rest)."""

    factors: Array  # the different upper triangular factors R / sqrt(N), M x D x D
    factor_of: Indices  # which of them each swarm uses, S
    targets: Array  # b = Q'y / sqrt(N), S x D
    rests: Array  # the mean square that no coefficients can explain, S

    def __post_init__(self) -> None:
        swarms, dimensions = self.targets.shape
        if self.factors.shape[1:] != (dimensions, dimensions) or np.any(np.tril(self.factors, -1)):
            raise ValueError(
                f"factors of shape {self.factors.shape}: must be upper triangular, M x D x D, D = {dimensions}"
            )
        if self.factor_of.shape != (swarms,) or self.rests.shape != (swarms,):
            raise ValueError(f"factor_of and rests must have one value for each of the {swarms} swarms")
        if not np.isin(self.factor_of, np.arange(len(self.factors))).all():
            raise ValueError(f"factor_of = {self.factor_of!r}: must lie between 0 and {len(self.factors) - 1}")

    @cached_property
    def is_orthonormal(self) -> bool:
        """Whether every factor is the identity, as on an orthonormal (QR) basis."""
        return bool(np.array_equal(self.factors, np.broadcast_to(np.eye(self.factors.shape[1]), self.factors.shape)))

    def __call__(self, positions: Array, swarms: Indices, /) -> Array:
        """The fitness of ``positions`` (n x particles x D) for the swarms numbered ``swarms``."""
        return np.sqrt(self.mean_squares(positions, swarms))

    def mean_squares(self, positions: Array, swarms: Indices, /) -> Array:
        """The squares of the fitness; for a swarm, which only compares, as good as the fitness and cheaper."""
        if self.is_orthonormal:
            gaps = positions - self.targets[swarms, None, :]
        else:
            # one product per swarm, of the same shape whatever the chunk: the bits do not depend on the chunk
            gaps = np.matmul(positions, self.factors[self.factor_of[swarms]].transpose(0, 2, 1))
            gaps -= self.targets[swarms, None, :]
        squares = np.einsum("spd,spd->sp", gaps, gaps)
        squares += self.rests[swarms, None]
        return np.asarray(squares)


Integers = NDArray[np.int64]
Words = NDArray[np.uint64]

LANES = 16  # So many swarms are computed side by side


class Problems(NamedTuple):
    """What all swarms look for, and how: S swarms, D dimensions, T iterations."""

    factors: Array  # M x D x D
    factor_of: Integers  # S
    targets: Array  # S x D
    rests: Array  # S
    lower: Array  # S x D
    width: Array  # S x D
    speed_limits: Array  # S x D
    coefficients: Array  # T x 3
    first_blocks: Words  # D: the block of rows in which each column of the factors begins
    particles: int
    threshold: float
    orthonormal: bool
    clamped: bool
    ring: bool


class Outcome(NamedTuple):
    """Where the results go, one row per swarm."""

    states: Words  # S x 4, also where the streams begin
    positions: Array  # S x D
    fitness: Array  # S
    history: Array  # S x (T + 1)
    iterations: Integers  # S
    codes: Integers  # S


class Pack(NamedTuple):
    """The state of `LANES` swarms; flat arrays whose fastest index is the lane."""

    swarms: Integers  # which swarm each lane computes
    stream: Words  # a, b, c, counter of each SFC64
    cells: Array  # particles x dimensions x (position, velocity, personal best)
    aims: Array  # (particles or 1) x dimensions x (neighbourhood's best, target, speed limit)
    factor: Array  # columns x rows (padded with zeros to whole blocks)
    image: Array  # rows (padded): factor times position
    tally: Array  # sum of squares (zero between particles), rest, whether better; how many finite, best fitness, whose
    best_fitness: Array  # particles
    progress: Array  # iterations + 1
    at_work: NDArray[np.bool_]
