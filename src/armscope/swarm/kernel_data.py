"""What the compiled swarm works on: the problems, the state of a pack of swarms, and where the results go.

These types stand in the index of numba's cache by the name of this module: a cache that was written before they moved
could not be read.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array

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
