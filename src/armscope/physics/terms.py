"""What an effect is made of: directions in which something moves, drivers that it follows, and their products.

Everything is linear in one parameter per term, so that the exact model and the columns of the diagnosis are one text.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Real

import numpy as np

from armscope.core.types import Array, Indices

AXES = ("tx", "ty", "tz", "rx", "ry", "rz")
"""The six directions of a twist: translations (m), then rotations (rad), along and about the axes of a frame."""


@dataclass(frozen=True)
class Direction:
    """What moves per unit of a driver."""

    # "base", "joint j", "link j", "tool": a frame of the chain (see `armscope.robot.Chain.frame`); "motor j": motor
    # angle j, which turns chain joints through the arm's actuation; "instrument"; "payload"
    location: str
    # one of `AXES` for a frame, "turn" for a motor, "scale" and "height" for the instrument, "mass" for the payload;
    # any other moves no frame: only readings that know it see it (`armscope.measurement.channel`)
    axis: str


@dataclass(frozen=True)
class Driver:
    """What an effect follows: a kind that `armscope.physics.drivers` evaluates, and its arguments."""

    kind: str
    arguments: tuple[object, ...] = ()

    def number(self, place: int) -> float:
        """The argument at a place, which is a number."""
        value = self.arguments[place]
        assert isinstance(value, Real), self
        return float(value)


@dataclass(frozen=True)
class DriverKind:
    """How a driver is evaluated, and all that anybody else asks about it."""

    values: Callable[..., Array]  # (scene, *arguments of the driver) -> (N,) values, SI units (time in hours)
    needs: str = ""  # the field of the recordings without which it can't be evaluated ("temperature"; "" for none)
    # what it depends on: "load" (where the arm stands under gravity), "payload", "weight" (it is a load, proportional
    # to what hangs there), "torque" (recorded where it was), "run" (it describes a recording, not the arm)
    follows: frozenset[str] = frozenset()
    unit: str = ""  # of its values where an effect is drawn as a curve over it; "" where it is not


ONE = Driver("one")


@dataclass(frozen=True)
class Product:
    """One direction times one driver times a number."""

    direction: Direction
    driver: Driver
    factor: float = 1.0


@dataclass(frozen=True)
class Term:
    """One linear parameter: per unit of it, the sum of the products moves the arm."""

    name: str  # the parameter's name in the files ("compliance", "a", "offset", ...)
    unit: str  # its unit in the files
    si: float  # SI units per file unit (1e-3 for mm)
    products: tuple[Product, ...]  # what one SI unit of the parameter does
    # SI, the size that it has on real arms (one standard deviation; `armscope.physics.constants`). No part of what the
    # term is: two tables may give a load's term different ones
    plausible: float = field(default=math.inf, compare=False)
    # SI, the same of arms of this type, where a fleet has shown it (`armscope.physics.learned_sizes`)
    learned: float | None = field(default=None, compare=False)

    @functools.cached_property
    def by_direction(self) -> tuple[tuple[Direction, tuple[Product, ...]], ...]:
        """The products, direction by direction: an error of a mass has some dozens of them in a few."""
        found: dict[Direction, list[Product]] = {}
        for product in self.products:
            found.setdefault(product.direction, []).append(product)
        return tuple((direction, tuple(products)) for direction, products in found.items())

    @property
    def prior_size(self) -> float:
        """SI, one standard deviation of what is believed before the rows speak."""
        return self.plausible if self.learned is None else self.learned


def term(
    name: str,
    unit: str,
    *products: Product | tuple[Direction, Driver],
    si: float = 1.0,
    plausible: float = math.inf,
) -> Term:
    """A term from products or (direction, driver) pairs.

    Args:
        name: of the parameter.
        unit: of the parameter in files.
        products: products of directions and drivers.
        si: SI units per file unit.
        plausible: SI, the size that it has on real arms.

    Returns:
        The term.
    """
    made = tuple(p if isinstance(p, Product) else Product(*p) for p in products)
    return Term(name, unit, si, made, plausible)


def motor(j: int) -> Direction:
    """Motor angle j (1-based)."""
    return Direction(f"motor {j}", "turn")


@dataclass(frozen=True, eq=False)
class DrivenTogether:
    """The products of some terms that move in one direction: there, they come to one weighted sum of drivers."""

    direction: Direction  # of them all
    at: Indices  # (k,) number of each product's term
    factors: Array  # (k,) of the products
    drivers: tuple[Driver, ...]  # k of them


def driven_together(terms: Sequence[Term]) -> tuple[DrivenTogether, ...]:
    """The products of terms, direction by direction."""
    found: dict[Direction, list[tuple[int, float, Driver]]] = {}
    for number, each in enumerate(terms):
        for product in each.products:
            found.setdefault(product.direction, []).append((number, product.factor, product.driver))
    return _by_direction(found)


@functools.lru_cache(maxsize=200)
def all_driven(parts: tuple[tuple[tuple[DrivenTogether, ...], int], ...]) -> tuple[DrivenTogether, ...]:
    """What several lists of terms move, side by side.

    Args:
        parts: what each list moves, and how many terms it has.

    Returns:
        The products of all of them, direction by direction, by numbers of terms that run on from list to list.
    """
    found: dict[Direction, list[tuple[int, float, Driver]]] = {}
    first = 0
    for groups, terms in parts:
        for each in groups:
            numbers = (each.at + first).tolist()
            found.setdefault(each.direction, []).extend(zip(numbers, each.factors.tolist(), each.drivers, strict=True))
        first += terms
    return _by_direction(found)


def _by_direction(found: Mapping[Direction, Sequence[tuple[int, float, Driver]]]) -> tuple[DrivenTogether, ...]:
    groups = []
    for direction, some in found.items():
        at, factors, drivers = zip(*some, strict=True)
        groups.append(DrivenTogether(direction, np.array(at, dtype=np.intp), np.array(factors), drivers))
    return tuple(groups)
