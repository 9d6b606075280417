"""Small errors that each of several arms has of its own, and how large those of their type are.

Arms of one type are not alike: zeros are set to a few hundredths of a degree, axes are drilled to tenths of a
millimetre, and no two gears run the same. Of one arm measured twice that is no matter; of several, every such error
would be a difference that is surer than chance. An arm is unlike the others where it differs by more than arms of the
type do, which the recordings themselves say: the variance of each error at each place is a number more of the model
(variance components; Harville 1977). Five arms tell it from four numbers. What other places have of the same kind says
more of it, by as much as these have alike: zeros are set alike at all joints, but how much drives differ in what their
loads do goes with the load (moderated variances; Smyth 2004).
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri, polygamma, psi

from armscope.comparison.constants import SHARED
from armscope.comparison.penalised import HeldColumns
from armscope.comparison.sets import columns_of_rows
from armscope.core.types import Array, Indices
from armscope.fitting.transfer import belongs_to_the_arm
from armscope.physics.backgrounds import backgrounds
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class OwnErrors:
    """Errors of which every arm has its own."""

    columns: Array  # (3N, c) what each does, mm in units of what is usual of it; zero in the rows of all other arms
    family: Indices  # (c,) number of the family that it is of: one error at one place
    arm: Indices  # (c,) number of the arm that has it
    kind: Indices  # (families,) number of the kind that each is of
    size: Array  # (families,) what arms of this type have of it, in units of what is usual
    numbers: Array  # (families,) from how many numbers that is known

    def weighed(self, weight: Array) -> OwnErrors:
        """The same as rows are weighed, by (3N,)."""
        return replace(self, columns=self.columns * weight[:, None])

    def other_than(self, columns: Array) -> NDArray[np.bool_]:
        """(c,) those that are not the same as what these columns (3N, q) do in the rows of their arm."""
        different = np.ones(len(self.arm), bool)
        for arm in np.unique(self.arm):
            these = self.arm == arm
            own = self.columns[:, these]
            rows = np.any(own != 0, axis=1)
            left = own[rows] - columns[rows] @ np.linalg.lstsq(columns[rows], own[rows])[0]
            different[these] = np.sum(left**2, axis=0) > SHARED.unseen * np.sum(own**2, axis=0)
        return different

    @property
    def sized(self) -> Array:
        """(3N, c) what each does where it is as large as arms of this type have it."""
        return self.columns * self.size[self.family]


def no_own_errors(rows: int) -> OwnErrors:
    """Of recordings of one arm, which has the same errors in all of ``rows`` numbers."""
    none = np.zeros(0, int)
    return OwnErrors(np.zeros((rows, 0)), none, none, none, np.zeros(0), np.zeros(0))


def own_errors(model: FittedModel, table: Recordings, arm_of_row: Indices) -> OwnErrors:
    """Errors that every arm of a type has a little of, for each of several arms.

    Args:
        model: the nominal arm with frames.
        table: N rows of all arms.
        arm_of_row: (N,) number of the arm that each is of.

    Returns:
        As large as is usual.
    """
    columns, family = [], []
    kinds: dict[tuple[Hashable, ...], int] = {}
    places: dict[tuple[Hashable, ...], int] = {}
    kind_of: list[int] = []
    for name, placed in backgrounds(model.arm, table).items():
        for each in filter(belongs_to_the_arm, placed):
            columns.append(columns_of_rows(model, table, each.terms) * np.array(each.prior_scale))
            # lengths and angles, zeros and twists, and a gear's waves, need not be to each other as is usual
            what = each.location.partition(" ")[0]
            for term in each.terms:
                kind = (name, each.name, what, term.unit, each.scanned)
                place = (*kind, each.location, "" if each.scanned else term.name)
                if place not in places:
                    places[place] = len(places)
                    kind_of.append(kinds.setdefault(kind, len(kinds)))
                family.append(places[place])
    of_one = np.hstack(columns)
    arms = range(int(arm_of_row.max()) + 1)
    group = np.repeat(arm_of_row, 3)
    each_alone = np.hstack([of_one * (group == arm)[:, None] for arm in arms])
    seen = np.any(each_alone != 0, axis=0)
    families, names = np.tile(family, len(arms))[seen], np.repeat(list(arms), len(family))[seen]
    of_kind = np.array(kind_of, int)
    return OwnErrors(each_alone[:, seen], families, names, of_kind, np.ones(len(places)), np.ones(len(places)))


def learned(own: OwnErrors, rows: Array, base: HeldColumns, of_most: bool = False) -> OwnErrors:
    """One step towards the sizes under which the rows are likeliest (MacKay 1992).

    Args:
        own: as large as they are believed to be.
        rows: (3N,) what is fitted.
        base: by this, in which those errors are what is drawn.
        of_most: as large as the half of them says, whatever stands out, and not as their mean square.

    Returns:
        The same with other sizes.
    """
    drawn, families = slice(base.drawn), len(own.size)
    values = (base.inverse.T @ (base.inverse @ (base.columns.T @ rows)))[drawn]
    determined = 1 - base.penalty[drawn] * np.sum(base.inverse[:, drawn] ** 2, axis=0)
    absolute = (own.size[own.family] * values) ** 2
    numbers = np.bincount(own.family, determined, minlength=families)
    square = np.bincount(own.family, absolute, minlength=families)
    variance, known = np.zeros(families), np.zeros(families)
    for kind in range(own.kind.max() + 1):
        these = own.kind == kind
        variance[these], known[these] = moderated(square[these], numbers[these])
    if of_most:
        told = determined > SHARED.unseen
        relative = np.where(told, absolute / np.where(told, determined, 1.0), np.nan)
        for kind in range(own.kind.max() + 1):
            half = relative[told & (own.kind[own.family] == kind)]
            most = np.median(half) / chdtri(1, 0.5) if len(half) else 0.0
            variance[own.kind == kind] = np.minimum(variance[own.kind == kind], most)
    return replace(own, size=np.maximum(np.sqrt(variance), SHARED.least_size * own.size), numbers=known)


def moderated(square: Array, numbers: Array) -> tuple[Array, Array]:
    """The variance of each of some errors of one kind, of which each tells its own and all tell what is usual of them.

    Args:
        square: (f,) sums of squares.
        numbers: (f,) from as many numbers.

    Returns:
        (f,) variances, and (f,) from how many numbers each is known. How far the variances differ by more than chance
        says how many numbers all together are worth for one (Smyth 2004, of log variances).
    """
    total = max(float(numbers.sum()), 1.0)
    usual, worth = float(square.sum()) / total, total
    told = numbers >= SHARED.least_told
    if told.sum() > 1:
        half = numbers[told] / 2
        logs = np.log(np.maximum(square[told] / numbers[told], SHARED.least_variance)) - psi(half) + np.log(half)
        beyond = float(np.var(logs, ddof=1) - np.mean(polygamma(1, half)))
        if beyond > 0:
            worth = min(total, 2 * _inverse_trigamma(beyond))
            usual = float(np.exp(np.mean(logs) + psi(worth / 2) - np.log(worth / 2)))
    worth = max(worth, SHARED.least_worth)
    return (worth * usual + square) / (worth + numbers), np.minimum(worth + numbers, max(total, worth))


def _inverse_trigamma(value: float) -> float:
    """Of which the trigamma function is ``value``, by bisection of its logarithm."""
    low, high = -10.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if polygamma(1, np.exp(middle)) > value else (low, middle)
    return float(np.exp(low))
