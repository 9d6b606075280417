"""How surely changes are ones, each alone beside what is fitted anyway."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from armscope.comparison.constants import SHARED
from armscope.comparison.dispersion import Scored, Statistic
from armscope.comparison.own_errors import OwnErrors
from armscope.comparison.penalised import HeldColumns, variance_left
from armscope.core.types import Array


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
