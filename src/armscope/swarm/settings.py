"""What a user may choose about a swarm, checked once, and whom its particles follow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Indices
from armscope.swarm.update import PRESETS, UpdateRule


def global_best(best_fitness: NDArray[np.float64]) -> Indices:
    """The one best particle of each swarm.

    Args:
        best_fitness: each particle's best fitness so far, swarms x particles (inf: none yet).

    Returns:
        Its index, swarms x 1; of equal ones the first.
    """
    return np.asarray(np.argmin(best_fitness, axis=1)[:, None])


def ring_best(best_fitness: NDArray[np.float64]) -> Indices:
    """The best of each particle, its left and its right neighbour on a ring.

    Args:
        best_fitness: each particle's best fitness so far, swarms x particles (inf: none yet).

    Returns:
        Its index for each particle, swarms x particles; of equal ones the particle itself, then the left.
    """
    count = best_fitness.shape[1]
    itself = np.arange(count)
    candidates = np.stack([itself, (itself - 1) % count, (itself + 1) % count])
    chosen = np.argmin(best_fitness[:, candidates], axis=1)
    return np.asarray(candidates[chosen, itself])


NEIGHBOURHOODS: dict[str, Callable[[NDArray[np.float64]], Indices]] = {"gbest": global_best, "ring": ring_best}


@dataclass(frozen=True)
class SwarmSettings:
    """The settings of a particle swarm; the defaults are the paper's, except for the update rule.

    Args:
        particles: the population, 2 or more.
        iterations: how often all particles move, at most; 0 only places them.
        update: a name in `PRESETS` ("original", "constriction", "inertia") or an `UpdateRule`.
        neighbourhood: "gbest" (all particles) or "ring" (itself and two).
        velocity_clamp: the largest speed in each dimension, as a share of the search box's width; None: no limit.
        threshold: a swarm stops when its best fitness drops below this value; None: it never does.

    Raises:
        ValueError: a value outside its range; the message names value and rule.
    """

    particles: int = 100
    iterations: int = 200
    update: str | UpdateRule = "constriction"
    neighbourhood: str = "gbest"
    velocity_clamp: float | None = None
    threshold: float | None = None

    def __post_init__(self) -> None:
        _check_whole("particles", self.particles, least=2)
        _check_whole("iterations", self.iterations, least=0)
        if not isinstance(self.update, UpdateRule) and self.update not in PRESETS:
            raise ValueError(f"update = {self.update!r}: must be one of {', '.join(PRESETS)}, or an UpdateRule")
        if self.neighbourhood not in NEIGHBOURHOODS:
            raise ValueError(f"neighbourhood = {self.neighbourhood!r}: must be one of {', '.join(NEIGHBOURHOODS)}")
        if self.velocity_clamp is not None and not (_is_finite(self.velocity_clamp) and self.velocity_clamp > 0):
            raise ValueError(f"velocity_clamp = {self.velocity_clamp!r}: must be a finite number above 0, or None")
        if self.threshold is not None and not _is_finite(self.threshold):
            raise ValueError(f"threshold = {self.threshold!r}: must be a finite number, or None")

    @property
    def rule(self) -> UpdateRule:
        """The update rule itself."""
        return self.update if isinstance(self.update, UpdateRule) else PRESETS[self.update]


def _check_whole(name: str, value: object, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise ValueError(f"{name} = {value!r}: must be a whole number, {least} or more")


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
