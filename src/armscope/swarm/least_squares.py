"""Swarms on linear least squares: the fitness of a coefficient vector in a few multiplications, whatever the rows.

With the design matrix A = Q R of N rows, |A z - y|^2 = |R z - Q'y|^2 + (what no z can explain), so that

    fitness(z) = RMS residual = sqrt( (|R z - Q'y|^2 + rest) / N ),

the same function with the triangular factor in place of the rows. Where numba is installed, a compiled kernel runs the
same algorithm on the same random numbers as the NumPy engine.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from armscope.core.types import Array, Indices
from armscope.swarm.engine import checked_box, minimise
from armscope.swarm.result import SwarmResult
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import are_sfc64

ENGINES = ("auto", "numba", "numpy")


@dataclass(frozen=True)
class LeastSquares:
    """S least-squares problems in D coefficients, as an objective: fitness = sqrt(|R z - b|^2 + rest).

    Attributes:
        factors: the different upper triangular factors R / sqrt(N), M x D x D.
        factor_of: which of them each swarm uses, S.
        targets: b = Q'y / sqrt(N), S x D.
        rests: the mean square that no coefficients can explain, S.
    """

    factors: Array
    factor_of: Indices
    targets: Array
    rests: Array

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


def minimise_least_squares(
    problems: LeastSquares,
    lower: ArrayLike,
    upper: ArrayLike,
    generators: Sequence[np.random.Generator],
    settings: SwarmSettings | None = None,
    engine: str = "auto",
) -> SwarmResult:
    """Let one swarm per problem look for its least RMS residual; see `minimise`.

    Args:
        problems: S problems.
        lower, upper: the search box, D or S x D.
        generators: one for each problem.
        settings: see `SwarmSettings`.
        engine: "numba" (needs SFC64 generators), "numpy", or "auto": numba where it can be used. Both follow the same
            trajectories up to rounding.

    Returns:
        As `minimise`, the fitness being the RMS residual.

    Raises:
        ValueError: as `minimise`; an unknown engine, or one that cannot be used here.
    """
    settings = settings or SwarmSettings()
    if engine not in ENGINES:
        raise ValueError(f"engine = {engine!r}: must be one of {', '.join(ENGINES)}")
    if len(generators) != len(problems.targets):
        raise ValueError(f"{len(generators)} generators for {len(problems.targets)} problems: one is needed for each")
    if engine == "numba" and not _kernel_can_run(generators):
        raise ValueError("engine = 'numba': needs numba installed and SFC64 generators (see spawn_generators)")
    squared = replace(settings, threshold=_square_of(settings.threshold))
    if engine == "numpy" or not _kernel_can_run(generators):
        result = minimise(problems.mean_squares, lower, upper, generators, squared)
    else:
        from armscope.swarm.kernel import run_kernel  # numba takes a third of a second to import

        low, high = checked_box(lower, upper, len(generators))
        result = run_kernel(problems, low, high, generators, squared)
    return replace(result, fitness=np.sqrt(result.fitness), history=np.sqrt(result.history))


def _square_of(threshold: float | None) -> float | None:
    """A threshold for the mean square; an RMS is never below a threshold of zero or less."""
    return None if threshold is None else max(threshold, 0.0) ** 2


def _kernel_can_run(generators: Sequence[np.random.Generator]) -> bool:
    return importlib.util.find_spec("numba") is not None and are_sfc64(generators)
