"""The library's columns on a chunk of rows, and sums of their products.

Most of a library's terms turn one and the same motor, each by a driver of its own (the waves of the free curves). Such
a column is a sensitivity (displacement and turn of the tool per radian) times a driver, row by row; the product of
two of them is a product of two drivers, weighted by the product of their sensitivities. So they are never written out:
sums over rows then cost one number a row where the columns themselves have three or six.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.constants import STEPS
from armscope.measurement.channel import POSITIONS
from armscope.measurement.whitening import WhitenedPosture
from armscope.physics.drivers import follows
from armscope.physics.effect import Direction, Driver, Term
from armscope.physics.scene import Posture, Scene


@dataclass(frozen=True, eq=False)
class SharedDirectionGroup:
    """Terms that move in one direction: their numbers, drivers and factors (k, 1)."""

    direction: Direction
    members: Indices
    drivers: tuple[Driver, ...]
    factors: Array

    @functools.cached_property
    def follows_load(self) -> bool:
        """Whether a driver does, so that values hold for one posture alone."""
        return any(follows("load", driver) for driver in self.drivers)

    def values(self, scene: Scene) -> Array:
        """(k, n) drivers times factors; kept where they are those of every posture, and all rows are one chunk.

        Of a long table they would take as much memory as all else.
        """

        def computed() -> Array:
            return np.array([scene.driver(driver) for driver in self.drivers]) * self.factors

        if self.follows_load or len(scene.recordings) >= STEPS.chunk_rows:
            return computed()
        kept: Array = scene.rigid.remember(self, computed)
        return kept


@dataclass(frozen=True, eq=False)
class ColumnOrder:
    """Terms sorted into groups and others."""

    others: tuple[Term, ...]  # the terms that are in no group
    groups: tuple[SharedDirectionGroup, ...]  # the groups
    order: Indices  # (p,) numbers of all terms: the others first, then group by group

    @property
    def back(self) -> Indices:
        """(p,) where each term stands in ``order``."""
        return np.argsort(self.order)

    @property
    def is_one_group(self) -> bool:
        """Whether all terms move in one direction, so that they stand in their own order."""
        return not self.others and len(self.groups) == 1

    @property
    def slices(self) -> list[slice]:
        """Where the others and each group stand in ``order``."""
        ends = np.cumsum([0, len(self.others), *(len(group.members) for group in self.groups)])
        return [slice(int(a), int(b)) for a, b in itertools.pairwise(ends)]

    def whole(self, products: Array) -> Array:
        """(p, p) products of all terms, from sums in ``order`` of which the blocks above the diagonal are filled."""
        for above, below in itertools.combinations(self.slices, 2):
            products[below, above] = products[above, below].T
        return products.take(self.back, axis=0).take(self.back, axis=1)


def grouped_columns(terms: Sequence[Term]) -> ColumnOrder:
    """Sort terms into groups and others."""
    by_direction: dict[Direction, list[int]] = {}
    for number, term in enumerate(terms):
        if len(term.products) == 1:
            by_direction.setdefault(term.products[0].direction, []).append(number)
    groups = [
        _group(terms, direction, members)
        for direction, members in by_direction.items()
        if len(members) >= STEPS.smallest_group
    ]
    inside = {int(number) for group in groups for number in group.members}
    others = [number for number in range(len(terms)) if number not in inside]
    order = np.concatenate([np.array(others, dtype=np.intp), *(group.members for group in groups)])
    return ColumnOrder(tuple(terms[number] for number in others), tuple(groups), order)


def _group(terms: Sequence[Term], direction: Direction, members: list[int]) -> SharedDirectionGroup:
    products = [terms[number].products[0] for number in members]
    factors = np.array([[product.factor] for product in products])
    return SharedDirectionGroup(
        direction, np.array(members, dtype=np.intp), tuple(product.driver for product in products), factors
    )


@dataclass(frozen=True, eq=False)
class StructuredDesign:
    """Columns in a given order on n rows of c numbers, mm per SI unit, as all channels see them."""

    column_order: ColumnOrder  # of the terms
    others: Array  # (o, c, n) columns of the terms that are in no group
    sensitivities: tuple[Array, ...]  # (c, n) of each group, mm
    drivers: tuple[Array, ...]  # (k, n) of each group's members

    def at(self, rows: slice | Indices) -> StructuredDesign:
        """The same columns on some of the rows."""
        sensitivities, drivers = (tuple(each[:, rows] for each in many) for many in (self.sensitivities, self.drivers))
        return StructuredDesign(self.column_order, self.others[:, :, rows], sensitivities, drivers)

    @property
    def flat(self) -> Array:
        """(o, c n) the others' columns, lying."""
        return self.others.reshape(len(self.others), math.prod(self.others.shape[1:]))

    def matvec(self, values: Array) -> Array:
        """(..., c, n) sums of the columns times ``values`` (..., p), which stand in the order of `column_order`."""
        first, *rest = self.column_order.slices
        total = (values[..., first] @ self.flat).reshape(*values.shape[:-1], *self.others.shape[1:])
        for at, sensitivity, drivers in zip(rest, self.sensitivities, self.drivers, strict=True):
            if np.any(values[..., at]):
                total += sensitivity * (values[..., at] @ drivers)[..., None, :]
        return np.asarray(total)

    def rmatvec(self, y: Array) -> Array:
        """(p,) products of the columns with a response (c, n), in the order of `column_order`."""
        others = self.flat @ y.reshape(-1)
        groups = [
            drivers @ _across(sensitivity, y)
            for sensitivity, drivers in zip(self.sensitivities, self.drivers, strict=True)
        ]
        return np.concatenate([others, *groups])

    def with_responses(self, Z: Array) -> Array:
        """(p, m) products of the columns with m responses (m, c, n), in the order of `column_order`."""
        others = self.flat @ Z.reshape(len(Z), -1).T
        groups = [
            drivers @ np.einsum("mcn,cn->mn", Z, sensitivity).T
            for sensitivity, drivers in zip(self.sensitivities, self.drivers, strict=True)
        ]
        return np.concatenate([others, *groups])

    def add_products(self, total: Array) -> None:
        """Add the products of all columns to (p, p) sums in the order of `column_order`; upper blocks only."""
        first, *rest = self.column_order.slices
        flat = self.flat
        total[first, first] += flat @ flat.T
        for a, at in enumerate(rest):
            total[first, at] += self._seen_by(a) @ self.drivers[a].T
            weighted = self.drivers[a] * np.sqrt(_across(self.sensitivities[a], self.sensitivities[a]))
            total[at, at] += weighted @ weighted.T
            for b in range(a + 1, len(rest)):
                product = self.drivers[a] * _across(self.sensitivities[a], self.sensitivities[b])
                total[at, rest[b]] += product @ self.drivers[b].T

    def within_blocks(self, m: int) -> Array:
        """(m, c, c) products within each of m blocks of columns that are one group."""
        weighted = self.drivers[0] * np.sqrt(_across(self.sensitivities[0], self.sensitivities[0]))
        blocks = weighted.reshape(m, -1, weighted.shape[1])
        return np.asarray(blocks @ blocks.transpose(0, 2, 1))

    def products(self, other: StructuredDesign) -> Array:
        """(p, q) products of the columns with those of another order on the same rows."""
        total = np.empty((len(self.column_order.order), len(other.column_order.order)))
        first, *rest = self.column_order.slices
        others_first, *others_rest = other.column_order.slices
        total[first, others_first] = self.flat @ (other.flat.T)
        for b, there in enumerate(others_rest):
            total[first, there] = np.einsum("ocn,cn->on", self.others, other.sensitivities[b]) @ other.drivers[b].T
        for a, at in enumerate(rest):
            total[at, others_first] = self.drivers[a] @ np.einsum("ocn,cn->on", other.others, self.sensitivities[a]).T
            for b, there in enumerate(others_rest):
                total[at, there] = (
                    self.drivers[a] * _across(self.sensitivities[a], other.sensitivities[b])
                ) @ other.drivers[b].T
        return total

    def _seen_by(self, group: int) -> Array:
        """(o, n) products of the others with a group's sensitivity."""
        return np.asarray(np.einsum("ocn,cn->on", self.others, self.sensitivities[group]))


def _across(sensitivity: Array, other: Array) -> Array:
    """(n,) products of two sensitivities (c, n), or of a sensitivity with a response, row by row."""
    return np.asarray(np.einsum("cn,cn->n", sensitivity, other))


def structured_design(posture: WhitenedPosture, column_order: ColumnOrder) -> StructuredDesign:
    """Columns in a given order at a posture's rows, as all channels see them."""
    sensitivities = tuple(1e3 * posture.sensitivity(group.direction).T for group in column_order.groups)
    drivers = tuple(group.values(posture.scene) for group in column_order.groups)
    return StructuredDesign(column_order, component_rows(posture, column_order.others), sensitivities, drivers)


def columns(posture: WhitenedPosture, terms: Sequence[Term]) -> Array:
    """(N c, p) columns in mm per SI unit of each term, side by side as all channels see them."""
    stacked = np.empty((len(terms), len(posture.scene), posture.width))
    for number, term in enumerate(terms):
        stacked[number] = posture.column(term)
    stacked *= 1e3
    return stacked.reshape(len(terms), -1).T


def point_columns(posture: Posture, terms: Sequence[Term]) -> Array:
    """(3N, p) columns in mm per SI unit of each term, as tool points show them."""
    return columns(WhitenedPosture.plain(posture, (POSITIONS,)), terms)


def component_rows(posture: WhitenedPosture, terms: Sequence[Term]) -> Array:
    """(p, c, N) the same columns, lying, a component of all rows side by side: fast to fill and to multiply."""
    stacked = np.empty((len(terms), posture.width, len(posture.scene)))
    for number, term in enumerate(terms):
        posture.fill(stacked[number], term)
    stacked *= 1e3
    return stacked
