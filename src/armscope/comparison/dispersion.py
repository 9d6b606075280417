"""How much surer changes seem than they are, by halves of one recording, between which nothing changed.

What no effect says follows the pose or the time: it is no noise from row to row, and between halves it shows as a
change, too. Statistics are divided by what makes those of halves no surprise (variance inflation; McCullagh and Nelder
1989, 4.5), so that a change between recordings must be surer than anything that differs inside one.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from armscope.comparison.constants import COMPARING
from armscope.core.types import Array
from armscope.physics.effect import Placed

STEPS = np.geomspace(1.0, COMPARING.most_dispersion, COMPARING.dispersions)  # Factors that are tried


@dataclass(frozen=True)
class Statistic:
    """An F statistic with its degrees of freedom; ``q`` 0 where a change cannot be seen."""

    f: float
    q: int
    free: float

    @property
    def price_nats(self) -> float:
        """What its numbers cost (Schwarz 1978)."""
        return float(self.q / 2 * np.log(max(self.free, 2.0)))

    def p(self, dispersion: float) -> float:
        """How often chance alone gives one as large."""
        return float(fdtrc(self.q, self.free - self.q, self.f / dispersion)) if self.q else 1.0


@dataclass(frozen=True, eq=False)
class Possible:
    """A change that may be: an effect, its number and its parameters' usual sizes (q,), in which of (3N,), and where.

    In the rows of some recordings, ``sets``, held ``against`` others.
    """

    placed: Placed
    number: int
    plausible: Array
    there: NDArray[np.bool_]
    sets: tuple[int, ...]
    against: tuple[int, ...]


@dataclass(frozen=True)
class Scored:
    """How surely a change is one: its F statistic, how likely chance makes it, and by how much it is the likelier."""

    statistic: Statistic
    p: float
    nats: float

    @property
    def better_fit_nats(self) -> float:
        """By how much the rows are the likelier, whatever its numbers cost."""
        return self.nats + self.statistic.price_nats


def halves(angles: Array) -> Iterator[NDArray[np.bool_]]:
    """A recording in two: early and late, and along the directions in which its poses (N, m), rad, differ most."""
    count = len(angles)
    yield np.arange(count) >= count // 2
    centred = angles - angles.mean(axis=0)
    axes = min(COMPARING.halving_axes, np.linalg.matrix_rank(centred))
    for along in np.linalg.svd(centred, full_matrices=False)[0].T[:axes]:
        yield along > np.median(along)


def overdispersion(between_halves: Iterable[Statistic]) -> float:
    """The factor, at least 1, that makes what differs between halves no surprise."""
    seen = [each for each in between_halves if each.q]
    if not seen:
        return 1.0
    f, q, free = np.array([(each.f, each.q, each.free) for each in seen]).T
    # a larger factor makes all of them less of a surprise
    least = bisect_left(
        STEPS, COMPARING.no_surprise, key=lambda factor: len(seen) * fdtrc(q, free - q, f / factor).min()
    )
    return float(STEPS[min(least, len(STEPS) - 1)])
