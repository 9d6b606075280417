"""What a swarm hands back, and the closed set of reasons why it stopped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import Enum

import numpy as np
from numpy.typing import NDArray


class StopReason(Enum):
    """Why a swarm stopped: one of these sentences, and no other."""

    THRESHOLD = "the best fitness dropped below the threshold"
    ITERATIONS = "all iterations were used"
    DIVERGED = "every particle left the range of finite numbers"
    NEVER_FINITE = "no particle ever had a finite fitness"


@dataclass(frozen=True)
class SwarmResult:
    """The outcome of S swarms in D dimensions after at most T iterations; rows are swarms."""

    positions: NDArray[np.float64]  # the best position found, S x D (NaN where no fitness was ever finite)
    fitness: NDArray[np.float64]  # its fitness, S (inf where none was ever finite)
    # the best fitness after placing the particles and after each iteration, S x (T + 1); the last value is repeated
    # after a swarm stopped
    history: NDArray[np.float64]
    iterations: NDArray[np.int64]  # how many iterations each swarm used, S
    reasons: NDArray[np.object_]  # why each stopped, S of `StopReason`

    @staticmethod
    def joined(parts: Sequence[SwarmResult]) -> SwarmResult:
        """The swarms of several results, one after the other."""
        return SwarmResult(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(SwarmResult)))


def final_reason(best_fitness: float) -> StopReason:
    """Why a swarm stopped that was not stopped before its last iteration."""
    return StopReason.ITERATIONS if np.isfinite(best_fitness) else StopReason.NEVER_FINITE
