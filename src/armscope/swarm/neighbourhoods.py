"""Who learns from whom: the best particle in each particle's neighbourhood."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Indices


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


NEIGHBOURHOODS: dict[str, Callable[[NDArray[np.float64]], Indices]] = {
    "gbest": global_best,
    "ring": ring_best,
}
