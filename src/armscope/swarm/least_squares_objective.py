"""The fitness of a coefficient vector in a few multiplications, whatever the rows.

With the design matrix A = Q R of N rows, |A z - y|^2 = |R z - Q'y|^2 + (what no z can explain), so that

    fitness(z) = RMS residual = sqrt( (|R z - Q'y|^2 + rest) / N ),

the same function with the triangular factor in place of the rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

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
