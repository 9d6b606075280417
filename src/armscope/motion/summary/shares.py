"""How much of what friction and rotors leave each cause is worth, and masses that are off without a name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.linear_algebra import schur_complement
from armscope.motion.constants import TELLING
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.library.catalogue import DELAY


@dataclass(frozen=True)
class Worth:
    """Of one cause, of the squared torque, in units of each joint's noise, that friction and rotors leave."""

    # how much of it goes when the cause is cured as it was found, averaged over the orders in which all can be cured
    # (Shapley 1953); below zero it hides part of what others do
    share: float
    minor: bool = False  # whether it is apart from the story


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
    late = [_friction_of(selected, effect.candidate) for effect in best.chosen]
    turned = np.concatenate([np.empty(0, dtype=np.intp), *(columns for columns, _ in late)])
    beyond = np.concatenate([named, masses, turned])
    base = np.setdiff1d(best.columns, beyond)
    G, b, yy = _beyond(selected, base, beyond)
    fitted = best.coefficients(len(problem.scale))[beyond]
    numbers = np.concatenate([fitted[: len(beyond) - len(turned)], *(by for _, by in late)])
    pull = b - G @ fitted
    whole = float(yy - fitted @ (b + pull) + numbers @ (G @ numbers + 2 * pull))
    if whole <= 0 or not len(beyond):
        return [Worth(0.0, True) for _ in members], 0.0
    parts = np.split(np.arange(len(named) + len(masses)), np.cumsum([len(columns) for columns in members]))
    extra = np.split(len(named) + len(masses) + np.arange(len(turned)), np.cumsum([len(by) for _, by in late]))[:-1]
    parts = [np.concatenate([own, more]) for own, more in zip(parts, [*extra, []], strict=True)]
    return _told([part.astype(np.intp) for part in parts], numbers, (G, pull), whole)


def _told(
    parts: Sequence[Indices], numbers: Array, sums: tuple[Array, Array], whole: float
) -> tuple[list[Worth], float]:
    """Of each part but the last its worth; and the last one's share."""
    G, pull = sums
    each = numbers * (G @ numbers + 2 * pull) / whole
    shares = [float(each[part].sum()) for part in parts]
    sizes = [float(numbers[part] @ G[np.ix_(part, part)] @ numbers[part]) / whole for part in parts]
    seen, there, left = np.full(len(parts), False), numbers.copy(), 1.0
    for n in np.argsort(shares)[::-1]:
        there[parts[n]] = 0.0
        before, left = left, 1 + float(there @ (G @ there + 2 * pull) - numbers @ (G @ numbers + 2 * pull)) / whole
        seen[n] = max(shares[n], sizes[n]) >= TELLING.minor_share or before - left >= TELLING.of_the_rest * before
    told = zip(shares[:-1], seen[:-1], strict=True)
    return [Worth(share, not is_seen) for share, is_seen in told], shares[-1]


def _friction_of(selected: SelectedCauses, number: int) -> tuple[Indices, Array]:
    """Columns by which dry friction turns later, and how much later a delay has it: who shifts a torque shifts all."""
    placed, layout = selected.rows.layout.placed[number], selected.rows.layout
    if placed.cause is not DELAY:
        return np.empty(0, dtype=np.intp), np.empty(0)
    joints = list(placed.joints)
    columns = layout.reversals[joints, -1]
    by = selected.dry[joints] * selected.coefficients[layout.columns[number][0]]
    return columns, by * selected.problem.scale[columns]


def _beyond(selected: SelectedCauses, base: Indices, columns: Indices) -> tuple[Array, Array, float]:
    """Products of some columns, with the torque, and its square, beyond what the base's columns take up."""
    best, sums = selected.best, selected.problem.equations
    whole = np.block([[sums.G, sums.b[:, None]], [sums.b[None], np.array([[sums.yy]])]])
    whole[base, base] += best.noise**2 / best.variance[best.at(base)]
    left = schur_complement(whole, base, np.append(columns, len(sums.G)))
    return left[:-1, :-1], left[:-1, -1], float(left[-1, -1])
