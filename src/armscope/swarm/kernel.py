"""The particle swarm on least squares, compiled (numba): the algorithm of `engine`, `LANES` swarms in step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.core.types import Array
from armscope.swarm.compiled import DIVERGED, ONE, ROW_BLOCK, THRESHOLD, run_packs
from armscope.swarm.kernel_data import LANES, Outcome, Pack, Problems
from armscope.swarm.least_squares_objective import LeastSquares
from armscope.swarm.result import StopReason, SwarmResult, final_reason
from armscope.swarm.settings import SwarmSettings
from armscope.swarm.streams import set_sfc64_states, sfc64_states, spawn_generators


def run_kernel(
    problems: LeastSquares,
    lower: Array,
    upper: Array,
    generators: Sequence[np.random.Generator],
    settings: SwarmSettings,
) -> SwarmResult:
    """What `minimise` does for ``problems.mean_squares``. Bounds are S x D; the generators must be SFC64.

    Args:
        problems: S problems.
        lower, upper: S x D, checked.
        generators: S SFC64 generators; each is advanced by the numbers that its swarm drew.
        settings: see `SwarmSettings`; the threshold is of the mean square.

    Returns:
        As `minimise`.
    """
    swarms, dimensions = problems.targets.shape
    count, clamp = settings.iterations, settings.velocity_clamp
    given = Problems(
        # copies, since arrays that are read-only or not contiguous would each need a compilation of their own
        factors=np.array(problems.factors, dtype=float, order="C"),
        factor_of=np.array(problems.factor_of, dtype=np.int64),
        targets=np.array(problems.targets, dtype=float, order="C"),
        rests=np.array(problems.rests, dtype=float),
        lower=np.array(lower, order="C"),
        width=np.array(upper - lower, order="C"),
        speed_limits=np.array((upper - lower) * (0.0 if clamp is None else clamp), order="C"),
        coefficients=np.array([settings.rule.coefficients(i, count) for i in range(count)]).reshape(count, 3),
        particles=settings.particles,
        threshold=-np.inf if settings.threshold is None else float(settings.threshold),
        first_blocks=np.argmax(np.any(problems.factors != 0, axis=0), axis=0).astype(np.uint64) // np.uint64(ROW_BLOCK),
        orthonormal=problems.is_orthonormal,
        clamped=clamp is not None,
        ring=settings.neighbourhood == "ring",
    )
    outcome = Outcome(
        states=sfc64_states(generators),
        positions=np.full((swarms, dimensions), np.nan),
        fitness=np.full(swarms, np.inf),
        history=np.empty((swarms, count + 1)),
        iterations=np.empty(swarms, dtype=np.int64),
        codes=np.empty(swarms, dtype=np.int64),
    )
    run_packs(given, outcome, _empty_pack(given), ONE)
    set_sfc64_states(generators, outcome.states)
    early = {THRESHOLD: StopReason.THRESHOLD, DIVERGED: StopReason.DIVERGED}
    reasons = np.empty(swarms, dtype=object)
    reasons[:] = [
        early.get(code) or final_reason(best)
        for code, best in zip(outcome.codes.tolist(), outcome.fitness, strict=True)
    ]
    return SwarmResult(outcome.positions, outcome.fitness, outcome.history, outcome.iterations, reasons)


def compile_now() -> None:
    """Compile the kernel into its cache, so that no run has to: a part of the installation (Makefile)."""
    least = LeastSquares(np.eye(1)[None], np.zeros(1, dtype=np.intp), np.zeros((1, 1)), np.zeros(1))
    bounds = np.ones((1, 1))
    run_kernel(least, -bounds, bounds, spawn_generators(0, 1), SwarmSettings(particles=2, iterations=1))


def _empty_pack(given: Problems) -> Pack:
    dimensions, particles = given.targets.shape[1], given.particles
    padded = (dimensions + ROW_BLOCK - 1) // ROW_BLOCK * ROW_BLOCK
    return Pack(
        np.empty(LANES, dtype=np.int64),
        np.empty(4 * LANES, dtype=np.uint64),
        np.empty(particles * dimensions * 3 * LANES),
        np.empty((particles if given.ring else 1) * dimensions * 3 * LANES),
        np.zeros(dimensions * padded * LANES),
        np.zeros(padded * LANES),
        np.zeros(6 * LANES),
        np.empty(particles * LANES),
        np.empty((len(given.coefficients) + 1) * LANES),
        np.empty(LANES, dtype=np.bool_),
    )
