"""How rows scatter, and how surely changes are ones, each alone beside what is fitted anyway."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from armscope.comparison.constants import COMPARING, SHARED
from armscope.comparison.own_errors import OwnErrors
from armscope.comparison.penalised import HeldColumns, variance_left
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


def scored(changes: Sequence[Array], rows: Array, base: HeldColumns, dispersion: float, own: OwnErrors) -> list[Scored]:
    """The F statistic of each change, how likely chance makes it, and by how much it makes the rows the likelier.

    Args:
        changes: columns (n, q) of each, in units of their own size.
        rows: (n,) what is fitted.
        base: what each stands beside.
        dispersion: by which all are less sure than they seem.
        own: errors of each arm's own, which are what is drawn in the base.

    Returns:
        One for each; of one that cannot be seen beside the base, none of its numbers.
    """
    variance, free = variance_left(rows, base)
    # all at once: thin products one by one would read what they stand beside again and again
    together = np.hstack([np.empty((len(rows), 0)), *changes])
    beyond, across_fixed = base.beyond(together), base.fixed.half @ together
    towards, ends = beyond.T @ rows, np.cumsum([0, *(each.shape[1] for each in changes)])
    known_from = numbers_behind(base, beyond, free, own)
    found = []
    for each, at in zip(changes, map(slice, ends[:-1], ends[1:]), strict=True):
        # what arms have a little of does not hide a change, but makes it less sure
        values, vectors = np.linalg.eigh(each.T @ each - across_fixed[:, at].T @ across_fixed[:, at])
        along = vectors[:, values > SHARED.unseen]
        information = along.T @ (each.T @ beyond[:, at]) @ along
        known = float(np.min(known_from[at], initial=free))
        found.append(_of(along.T @ towards[at], information, (variance, free), known, dispersion))
    return found


def numbers_behind(base: HeldColumns, beyond: Array, free: float, own: OwnErrors) -> Array:
    """From how many numbers it is known how large changes may be by chance: by noise, and by what is drawn.

    Of a sum of variances, each known from numbers of its own (Satterthwaite 1946).

    Args:
        base: what the changes stand beside.
        beyond: (n, q) what of their columns lies beyond that.
        free: numbers from which the noise is known.
        own: errors of each arm's own, which are what is drawn in the base.

    Returns:
        (q,) at most ``free``.
    """
    if not base.drawn:
        return np.full(beyond.shape[1], free)
    by_each = (base.columns[:, : base.drawn].T @ beyond) ** 2
    of_family = np.zeros((len(own.numbers), beyond.shape[1]))
    np.add.at(of_family, own.family, by_each)
    noise = base.penalty[0] * np.sum(beyond**2, axis=0)
    total = np.maximum(noise + of_family.sum(axis=0), SHARED.least_variance)
    apart = noise**2 / free + np.sum(of_family**2 / np.minimum(own.numbers, free)[:, None], axis=0)
    return np.asarray(total**2 / np.maximum(apart, total**2 / free))


def _of(towards: Array, information: Array, left: tuple[float, float], known_from: float, dispersion: float) -> Scored:
    """Of q numbers, by what the rows say of them, and the variance with the free numbers that are left without them.

    How large it may be by chance is known from as many numbers as ``known_from``.
    """
    (variance, free), q = left, len(towards)
    if not q or min(free, known_from) - q < 1:
        return Scored(Statistic(0.0, 0, free), 1.0, 0.0)
    gain = float(towards @ np.linalg.solve(information, towards))
    total = variance * free
    # the variance without what the change explains: of the model in which it is free
    without = max(total - gain, SHARED.least_left * total)
    statistic = Statistic((gain / q) / (without / (free - q)), q, known_from)
    # the noise is as unknown as the change: profile likelihood, and what q numbers cost
    likelier = known_from / 2 * np.log1p(q * statistic.f / (known_from - q)) / dispersion
    return Scored(statistic, statistic.p(dispersion), float(likelier - statistic.price_nats))
