"""The library's columns on a chunk of rows, and sums of their products.

Most of a library's terms turn one and the same motor, each by a driver of its own (the waves of the free curves). Such
a column is a lever (displacement and turn of the tool per radian) times a driver, row by row; the product of two of
them is a product of two drivers, weighted by the product of their levers. So they are never written out: sums over rows
then cost one number a row where the columns themselves have three or six.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.physics.effect import Direction, Driver, Term
from armscope.physics.scene import Posture

MANY = 16
"""A direction with fewer terms than this is not worth a fan."""


@dataclass(frozen=True, eq=False)
class Fan:
    """Terms that move in one direction: their numbers, drivers and factors (k, 1)."""

    direction: Direction
    members: Indices
    drivers: tuple[Driver, ...]
    factors: Array


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Terms sorted into fans and others.

    Attributes:
        others: the terms that are in no fan.
        fans: the fans.
        order: (p,) numbers of all terms: the others first, then fan by fan.
    """

    others: tuple[Term, ...]
    fans: tuple[Fan, ...]
    order: Indices

    @property
    def back(self) -> Indices:
        """(p,) where each term stands in ``order``."""
        return np.argsort(self.order)

    @property
    def slices(self) -> list[slice]:
        """Where the others and each fan stand in ``order``."""
        ends = np.cumsum([0, len(self.others), *(len(fan.members) for fan in self.fans)])
        return [slice(int(a), int(b)) for a, b in itertools.pairwise(ends)]

    def whole(self, products: Array) -> Array:
        """(p, p) products of all terms, from sums in ``order`` of which the blocks above the diagonal are filled."""
        for above, below in itertools.combinations(self.slices, 2):
            products[below, above] = products[above, below].T
        return products.take(self.back, axis=0).take(self.back, axis=1)


def arranged(terms: Sequence[Term]) -> Arrangement:
    """Sort terms into fans and others."""
    by_direction: dict[Direction, list[int]] = {}
    for number, term in enumerate(terms):
        if len(term.products) == 1:
            by_direction.setdefault(term.products[0].direction, []).append(number)
    fans = [_fan(terms, direction, members) for direction, members in by_direction.items() if len(members) >= MANY]
    inside = {int(number) for fan in fans for number in fan.members}
    others = [number for number in range(len(terms)) if number not in inside]
    order = np.concatenate([np.array(others, dtype=np.intp), *(fan.members for fan in fans)])
    return Arrangement(tuple(terms[number] for number in others), tuple(fans), order)


def _fan(terms: Sequence[Term], direction: Direction, members: list[int]) -> Fan:
    products = [terms[number].products[0] for number in members]
    factors = np.array([[product.factor] for product in products])
    return Fan(direction, np.array(members, dtype=np.intp), tuple(product.driver for product in products), factors)


@dataclass(frozen=True, eq=False)
class Stack:
    """An arrangement's columns on n rows of c numbers, mm per SI unit, as a lens shows them.

    Attributes:
        arrangement: of the terms.
        others: (o, c, n) columns of the terms that are in no fan.
        levers: (c, n) of each fan, mm.
        drivers: (k, n) of each fan's members.
    """

    arrangement: Arrangement
    others: Array
    levers: tuple[Array, ...]
    drivers: tuple[Array, ...]

    def at(self, rows: slice | Indices) -> Stack:
        """The same columns on some of the rows."""
        levers, drivers = (tuple(each[:, rows] for each in many) for many in (self.levers, self.drivers))
        return Stack(self.arrangement, self.others[:, :, rows], levers, drivers)

    @property
    def flat(self) -> Array:
        """(o, c n) the others' columns, lying."""
        return self.others.reshape(len(self.others), math.prod(self.others.shape[1:]))

    def combined(self, values: Array) -> Array:
        """(..., c, n) sums of the columns times ``values`` (..., p), which stand in the arrangement's order."""
        first, *rest = self.arrangement.slices
        total = (values[..., first] @ self.flat).reshape(*values.shape[:-1], *self.others.shape[1:])
        for at, lever, drivers in zip(rest, self.levers, self.drivers, strict=True):
            if np.any(values[..., at]):
                total += lever * (values[..., at] @ drivers)[..., None, :]
        return np.asarray(total)

    def onto(self, y: Array) -> Array:
        """(p,) products of the columns with a response (c, n), in the arrangement's order."""
        others = self.flat @ y.reshape(-1)
        fans = [drivers @ _across(lever, y) for lever, drivers in zip(self.levers, self.drivers, strict=True)]
        return np.concatenate([others, *fans])

    def add_products(self, total: Array) -> None:
        """Add the products of all columns to (p, p) sums in the arrangement's order; only blocks above the diagonal."""
        first, *rest = self.arrangement.slices
        flat = self.flat
        total[first, first] += flat @ flat.T
        for a, at in enumerate(rest):
            total[first, at] += self._seen_by(a) @ self.drivers[a].T
            weighted = self.drivers[a] * np.sqrt(_across(self.levers[a], self.levers[a]))
            total[at, at] += weighted @ weighted.T
            for b in range(a + 1, len(rest)):
                product = self.drivers[a] * _across(self.levers[a], self.levers[b])
                total[at, rest[b]] += product @ self.drivers[b].T

    def products(self, other: Stack) -> Array:
        """(p, q) products of the columns with another arrangement's on the same rows."""
        total = np.empty((len(self.arrangement.order), len(other.arrangement.order)))
        first, *rest = self.arrangement.slices
        others_first, *others_rest = other.arrangement.slices
        total[first, others_first] = self.flat @ (other.flat.T)
        for b, there in enumerate(others_rest):
            total[first, there] = np.einsum("ocn,cn->on", self.others, other.levers[b]) @ other.drivers[b].T
        for a, at in enumerate(rest):
            total[at, others_first] = self.drivers[a] @ np.einsum("ocn,cn->on", other.others, self.levers[a]).T
            for b, there in enumerate(others_rest):
                total[at, there] = (self.drivers[a] * _across(self.levers[a], other.levers[b])) @ other.drivers[b].T
        return total

    def _seen_by(self, fan: int) -> Array:
        """(o, n) products of the others with a fan's lever."""
        return np.asarray(np.einsum("ocn,cn->on", self.others, self.levers[fan]))


def _across(lever: Array, other: Array) -> Array:
    """(n,) products of two levers (c, n), or of a lever with a response, row by row."""
    return np.asarray(np.einsum("cn,cn->n", lever, other))


def stacked(posture: Posture, arrangement: Arrangement) -> Stack:
    """An arrangement's columns at a posture's rows, as its lens shows them."""
    levers = tuple(1e3 * posture.lever(fan.direction).T for fan in arrangement.fans)
    drivers = tuple(
        np.array([posture.scene.driver(driver) for driver in fan.drivers]) * fan.factors for fan in arrangement.fans
    )
    return Stack(arrangement, component_rows(posture, arrangement.others), levers, drivers)


def columns(posture: Posture, terms: Sequence[Term]) -> Array:
    """(3N or 6N, p) columns in mm per SI unit of each term, as the posture's lens shows them."""
    stacked = np.empty((len(terms), len(posture.scene), posture.numbers))
    for number, term in enumerate(terms):
        stacked[number] = posture.column(term)
    stacked *= 1e3
    return stacked.reshape(len(terms), -1).T


def component_rows(posture: Posture, terms: Sequence[Term]) -> Array:
    """(p, 3 or 6, N) the same columns, lying, a component of all rows side by side: fast to fill and to multiply."""
    stacked = np.empty((len(terms), posture.numbers, len(posture.scene)))
    for number, term in enumerate(terms):
        stacked[number] = posture.column(term).T
    stacked *= 1e3
    return stacked
