"""How much of what friction and rotors leave each cause is worth, and masses that are off without a name."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.linear_algebra import schur_complement
from armscope.motion.constants import TELLING
from armscope.motion.fitting.selected import SelectedCauses


@dataclass(frozen=True)
class Worth:
    """Of one cause, of the squared torque, in units of each joint's noise, that friction and rotors leave.

    Attributes:
        share: how much of it goes when the cause is cured as it was found, averaged over the orders in which all can
            be cured (Shapley 1953); below zero it hides part of what others do.
        size: its own torque, squared.
        minor: whether it is apart from the story.
    """

    share: float
    size: float
    minor: bool = False


def worth_of(selected: SelectedCauses) -> tuple[list[Worth], float]:
    """What each chosen cause is worth as it was found, and the share of masses that are off without a name.

    With each contribution known the average needs no orders: the torque before is their sum with what is left, and a
    share is the product of a contribution with both, over the square of the first. A share of what columns could
    explain is another thing: beside a large cause, what fits a little of it would have a share of that.

    Args:
        selected: a selection.

    Returns:
        Of each chosen cause, minor where it is little of all and of what larger ones leave; and the masses' share, 0
        where none are off.
    """
    best, problem = selected.best, selected.problem
    members = [selected.space.candidates[effect.candidate].columns for effect in best.chosen]
    named = np.concatenate([np.empty(0, dtype=np.intp), *members])
    masses = np.intersect1d(np.setdiff1d(selected.rows.layout.masses, named), best.columns)
    base = np.setdiff1d(best.columns, np.concatenate([masses, named]))
    beyond = np.concatenate([named, masses])
    G, b, yy = _beyond(selected, base, beyond)
    if yy <= 0 or not len(beyond):
        return [Worth(0.0, 0.0, True) for _ in members], 0.0
    numbers = best.coefficients(len(problem.scale))[beyond]
    parts = np.split(np.arange(len(beyond)), np.cumsum([len(columns) for columns in members], dtype=np.intp))
    each = numbers * (2 * b - G @ numbers) / yy
    shares = [float(each[part].sum()) for part in parts]
    sizes = [float(numbers[part] @ G[np.ix_(part, part)] @ numbers[part]) / yy for part in parts]
    seen, cured, left = np.full(len(parts), False), np.zeros_like(numbers), 1.0
    for n in np.argsort(shares)[::-1]:
        cured[parts[n]] = numbers[parts[n]]
        before, left = left, 1 - float(cured @ (2 * b - G @ cured)) / yy
        seen[n] = max(shares[n], sizes[n]) >= TELLING.minor_share or before - left >= TELLING.of_the_rest * before
    told = zip(shares[:-1], sizes[:-1], seen[:-1], strict=True)
    return [Worth(share, size, not is_seen) for share, size, is_seen in told], shares[-1]


def _beyond(selected: SelectedCauses, base: Indices, columns: Indices) -> tuple[Array, Array, float]:
    """Products of some columns, with the torque, and its square, beyond what the base's columns take up."""
    best, sums = selected.best, selected.problem.equations
    whole = np.block([[sums.G, sums.b[:, None]], [sums.b[None], np.array([[sums.yy]])]])
    whole[base, base] += best.noise**2 / best.variance[best.at(base)]
    left = schur_complement(whole, base, np.append(columns, len(sums.G)))
    return left[:-1, :-1], left[:-1, -1], float(left[-1, -1])
