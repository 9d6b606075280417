"""Swarms on linear least squares: where numba is installed, compiled, with the NumPy engine's random numbers."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from armscope.swarm.engine import checked_box, minimise
from armscope.swarm.least_squares_objective import LeastSquares
from armscope.swarm.result import SwarmResult
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import are_sfc64

ENGINES = ("auto", "numba", "numpy")


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
        ValueError: as `minimise`; a box of other dimensions than the problems; an unknown engine, or one that cannot be
            used here.
    """
    settings = settings or SwarmSettings()
    if engine not in ENGINES:
        raise ValueError(f"engine = {engine!r}: must be one of {', '.join(ENGINES)}")
    if len(generators) != len(problems.targets):
        raise ValueError(f"{len(generators)} generators for {len(problems.targets)} problems: one is needed for each")
    if engine == "numba" and not _kernel_can_run(generators):
        raise ValueError("engine = 'numba': needs numba installed and SFC64 generators (see spawn_generators)")
    low, high = checked_box(lower, upper, len(generators))
    if low.shape[1] != problems.targets.shape[1]:  # compiled code would read beyond its ends
        raise ValueError(f"a box of {low.shape[1]} dimensions for problems of {problems.targets.shape[1]} coefficients")
    squared = replace(settings, threshold=_square_of(settings.threshold))
    if engine == "numpy" or not _kernel_can_run(generators):
        result = minimise(problems.mean_squares, low, high, generators, squared)
    else:
        from armscope.swarm.kernel import run_kernel  # numba takes a third of a second to import

        result = run_kernel(problems, low, high, generators, squared)
    return replace(result, fitness=np.sqrt(result.fitness), history=np.sqrt(result.history))


def _square_of(threshold: float | None) -> float | None:
    """A threshold for the mean square; an RMS is never below a threshold of zero or less."""
    return None if threshold is None else max(threshold, 0.0) ** 2


def _kernel_can_run(generators: Sequence[np.random.Generator]) -> bool:
    return importlib.util.find_spec("numba") is not None and are_sfc64(generators)
