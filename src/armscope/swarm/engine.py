"""The particle swarm in NumPy: many swarms at once, any vectorised objective. It is the reference for the kernel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armscope.core.types import Array, Indices
from armscope.swarm.result import StopReason, SwarmResult, final_reason
from armscope.swarm.settings import NEIGHBOURHOODS, SwarmSettings
from armscope.swarm.streams import WEIGHT_UNIT, WeightStream
from armscope.swarm.update import Coefficients, velocity_update

CACHED_VALUES = 20000  # coordinates of a chunk's particles: its ten arrays then fit a megabyte or so


class Objective(Protocol):
    """What a swarm minimises."""

    def __call__(self, positions: Array, swarms: Indices, /) -> Array:
        """The fitness, n x particles, of ``positions`` (n x particles x D) of the swarms numbered ``swarms`` (n)."""


def minimise(
    objective: Objective,
    lower: ArrayLike,
    upper: ArrayLike,
    generators: Sequence[np.random.Generator],
    settings: SwarmSettings | None = None,
    chunk: int | None = None,
) -> SwarmResult:
    """Let one swarm per generator look for the smallest value of ``objective``.

    The particles start at rest (Engelbrecht 2012), uniformly distributed in the search box; the box does not confine
    them afterwards, as the paper's formula doesn't. A fitness that is NaN or infinite never becomes a best.

    Args:
        objective: see `Objective`. It must treat each particle by itself.
        lower, upper: the search box, D or S x D for S generators.
        generators: one for each swarm; each is advanced by the numbers that its swarm drew.
        settings: see `SwarmSettings`.
        chunk: how many swarms are computed side by side; None: as many as a processor's cache holds. The result does
            not depend on it.

    Returns:
        Best positions and fitness by swarm, their history, and why each stopped.

    Raises:
        ValueError: bounds that are not finite, that are in the wrong order, or that do not fit the generators; an
            objective that returns another shape.
    """
    settings = settings or SwarmSettings()
    lower, upper = checked_box(lower, upper, len(generators))
    if chunk is None:
        chunk = max(1, CACHED_VALUES // (settings.particles * lower.shape[1]))
    if chunk < 1:
        raise ValueError(f"chunk = {chunk!r}: must be 1 or more")
    parts = []
    for first in range(0, len(generators), chunk):
        rows = slice(first, first + chunk)
        swarms = np.arange(first, first + len(generators[rows]))
        parts.append(_Chunk(objective, lower[rows], upper[rows], generators[rows], swarms, settings).run())
    return SwarmResult.joined(parts)


def checked_box(lower: ArrayLike, upper: ArrayLike, swarms: int) -> tuple[Array, Array]:
    """The search box of each swarm, S x D, checked.

    Args:
        lower, upper: the search box, D or S x D.
        swarms: S.

    Returns:
        Lower and upper bounds, each S x D.

    Raises:
        ValueError: as `minimise` says.
    """
    if swarms < 1:
        raise ValueError("no generators: one swarm needs one generator")
    low, high = np.atleast_1d(np.asarray(lower, dtype=float)), np.atleast_1d(np.asarray(upper, dtype=float))
    try:
        low, high = np.broadcast_arrays(low, high)
        shape = (swarms, low.shape[-1])
        low, high = np.broadcast_to(low, shape), np.broadcast_to(high, shape)
    except ValueError as error:
        raise ValueError(
            f"search box of shapes {np.shape(lower)} and {np.shape(upper)}: must be D or {swarms} x D"
        ) from error
    if low.shape[1] == 0:
        raise ValueError("search box of no dimensions: at least one is needed")
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise ValueError("search box with NaN or infinite bounds: all must be finite")
    with np.errstate(over="ignore"):
        widths = high - low
    if not np.isfinite(widths).all():
        raise ValueError("search box wider than the largest number: upper - lower must be finite")
    if (low > high).any():
        swarm, dimension = np.argwhere(low > high)[0]
        raise ValueError(
            f"lower bound {low[swarm, dimension]!r} above upper bound {high[swarm, dimension]!r} "
            f"in dimension {dimension}: lower must not exceed upper"
        )
    return low, high


class _Chunk:
    """The state of a few swarms that are computed side by side; those that stop are taken out."""

    def __init__(
        self,
        objective: Objective,
        lower: Array,
        upper: Array,
        generators: Sequence[np.random.Generator],
        swarms: Indices,
        settings: SwarmSettings,
    ) -> None:
        count, dimensions = lower.shape
        shape = (count, settings.particles, dimensions)
        self.objective, self.settings = objective, settings
        self.swarms = swarms
        self.speed_limit = None
        if settings.velocity_clamp is not None:
            self.speed_limit = settings.velocity_clamp * (upper - lower)[:, None, :]
        start = np.stack([generator.random(shape[1:]) for generator in generators])
        self.positions = lower[:, None, :] + (upper - lower)[:, None, :] * start
        self.velocities = np.zeros(shape)
        self.stream = WeightStream(generators, shape[1:], settings.iterations)
        self.bests = self.positions.copy()
        self.best_fitness = np.full(shape[:2], np.inf)
        self.rows = np.arange(count)  # where in the result each swarm still at work stands
        self.result = SwarmResult(
            positions=np.full((count, dimensions), np.nan),
            fitness=np.full(count, np.inf),
            history=np.empty((count, settings.iterations + 1)),
            iterations=np.zeros(count, dtype=np.int64),
            reasons=np.full(count, None, dtype=object),
        )

    def run(self) -> SwarmResult:
        with np.errstate(over="ignore", invalid="ignore"):  # a swarm may diverge: that is a result, not a mishap
            self._judge(0)
            for iteration in range(1, self.settings.iterations + 1):
                if not len(self.rows):
                    break
                self._move(iteration)
                self._judge(iteration)
        for row in range(len(self.rows)):
            self._record(row, self.settings.iterations, final_reason(self.best_fitness[row].min()))
        return self.result

    def _move(self, iteration: int) -> None:
        r1, r2 = self.stream.draw()
        inertia, cognitive, social = self.settings.rule.coefficients(iteration - 1, self.settings.iterations)
        leaders = NEIGHBOURHOODS[self.settings.neighbourhood](self.best_fitness)
        neighbourhood_bests = self.bests[np.arange(len(leaders))[:, None], leaders]
        velocity_update(
            self.positions,
            self.velocities,
            self.bests,
            neighbourhood_bests,
            r1,
            r2,
            # r1 and r2 come as whole numbers: their unit, a power of two, goes into the coefficients without rounding
            Coefficients(inertia, cognitive * WEIGHT_UNIT, social * WEIGHT_UNIT),
            self.speed_limit,
            out=self.velocities,
        )
        self.positions += self.velocities

    def _judge(self, iteration: int) -> None:
        """Evaluate all particles, keep what is better, and let swarms stop that have a reason to."""
        fitness = np.asarray(self.objective(self.positions, self.swarms))
        if fitness.shape != self.best_fitness.shape:
            raise ValueError(f"the objective returned the shape {fitness.shape}: must be {self.best_fitness.shape}")
        better = (fitness < self.best_fitness) & np.isfinite(fitness)
        gone: NDArray[np.bool_] = np.zeros(len(self.rows), dtype=bool)
        improved = np.flatnonzero(better)  # few in most iterations, so that going to each beats a mask over all
        places = self.positions.reshape(-1, self.positions.shape[2])
        improvements = places.take(improved, axis=0)
        if not (np.isfinite(fitness).all() and np.isfinite(improvements).all()):  # somebody may have left the numbers
            finite = np.isfinite(self.positions).all(axis=2)
            gone = np.logical_not(np.any(finite, axis=1))
            better &= finite
            improved = np.flatnonzero(better)
            improvements = places.take(improved, axis=0)
        self.best_fitness.put(improved, fitness.take(improved))
        whole_rows = np.dtype((np.void, places.strides[0]))  # numpy copies these several times faster than values
        self.bests.reshape(places.shape).view(whole_rows).put(improved, improvements.view(whole_rows))
        swarm_best = self.best_fitness[np.arange(len(self.rows)), self.best_fitness.argmin(axis=1)]
        self.result.history[self.rows, iteration] = swarm_best
        threshold = -np.inf if self.settings.threshold is None else self.settings.threshold
        reached: NDArray[np.bool_] = np.less(swarm_best, threshold)
        if reached.any() or gone.any():
            self._retire(iteration, reached, gone)

    def _retire(self, iteration: int, reached: NDArray[np.bool_], gone: NDArray[np.bool_]) -> None:
        stopped = reached | gone
        for row in np.flatnonzero(stopped):
            self._record(int(row), iteration, StopReason.THRESHOLD if reached[row] else StopReason.DIVERGED)
        at_work = ~stopped
        self.stream.keep(at_work)
        for name in ("swarms", "positions", "velocities", "bests", "best_fitness", "rows"):
            setattr(self, name, getattr(self, name)[at_work])
        if self.speed_limit is not None:
            self.speed_limit = self.speed_limit[at_work]

    def _record(self, row: int, iteration: int, reason: StopReason) -> None:
        best = int(self.best_fitness[row].argmin())
        target = self.rows[row]
        if np.isfinite(self.best_fitness[row, best]):
            self.result.positions[target] = self.bests[row, best]
            self.result.fitness[target] = self.best_fitness[row, best]
        self.result.history[target, iteration:] = self.best_fitness[row, best]
        self.result.iterations[target] = iteration
        self.result.reasons[target] = reason
