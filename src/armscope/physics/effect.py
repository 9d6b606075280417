"""What an effect is: where it acts, in which directions, and what drives it.

Every effect is a small twist at one or more frames of the chain, driven by something known. It is written once, as
terms that are linear in their parameters, and serves twice: the exact model feeds the twists to the chain, the
diagnosis multiplies the same drivers with the frames' Jacobians (`armscope.physics.scene`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import TYPE_CHECKING, Literal

from armscope.core.location import Location

if TYPE_CHECKING:
    from armscope.core.types import Array
    from armscope.physics.clause import Clause, Told
    from armscope.physics.cure import Cure
    from armscope.physics.scene import Part, Scene
    from armscope.recordings import Recordings
    from armscope.robot import Arm

Family = Literal["frame", "geometric", "transmission", "elastic", "thermal", "drift", "instrument", "unknown"]

AXES = ("tx", "ty", "tz", "rx", "ry", "rz")
"""The six directions of a twist: translations (m), then rotations (rad), along and about the axes of a frame."""


@dataclass(frozen=True)
class Direction:
    """What moves per unit of a driver.

    Attributes:
        location: "base", "joint j", "link j", "tool": a frame of the chain (see `armscope.robot.Chain.frame`);
            "motor j": motor angle j, which turns chain joints through the arm's actuation; "instrument"; "payload".
        axis: one of `AXES` for a frame, "turn" for a motor, "scale" for the instrument, "mass" for the payload; any
            other moves no frame: only readings that know it see it (`armscope.measurement.channel`).
    """

    location: str
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
    """How a driver is evaluated, and all that anybody else asks about it.

    Attributes:
        values: (scene, *arguments of the driver) -> (N,) values, SI units (time in hours).
        needs: the field of the recordings without which it can't be evaluated ("temperature"; "" for none).
        follows: what it depends on: "load" (where the arm stands under gravity), "payload", "weight" (it is a load,
            proportional to what hangs there), "torque" (recorded where it was), "run" (it describes a recording, not
            the arm).
        unit: of its values where an effect is drawn as a curve over it; "" where it is not.
    """

    values: Callable[..., Array]
    needs: str = ""
    follows: frozenset[str] = frozenset()
    unit: str = ""


ONE = Driver("one")


@dataclass(frozen=True)
class Product:
    """One direction times one driver times a number."""

    direction: Direction
    driver: Driver
    factor: float = 1.0


@dataclass(frozen=True)
class Term:
    """One linear parameter: per unit of it, the sum of the products moves the arm.

    Attributes:
        name: the parameter's name in the files ("compliance", "a", "offset", ...).
        unit: its unit in the files.
        si: SI units per file unit (1e-3 for mm).
        products: what one SI unit of the parameter does.
        plausible: SI, the size that it has on real arms (one standard deviation; `armscope.physics.constants`). No part
            of what the term is: two tables may give a load's term different ones.
        learned: SI, the same of arms of this type, where a fleet has shown it (`armscope.physics.learned_sizes`).
    """

    name: str
    unit: str
    si: float
    products: tuple[Product, ...]
    plausible: float = field(default=math.inf, compare=False)
    learned: float | None = field(default=None, compare=False)

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


@dataclass(frozen=True)
class Placed:
    """An effect at one location of one arm, ready to be simulated, fitted and weighed.

    Attributes:
        effect: its definition.
        location: where, in the words of the verdict ("joint 2", "joint 6 from joint 5").
        terms: its linear parameters.
        prior_scale: relative size that each term is expected to have at the tool; one number per term.
        driver: what it follows, in words.
        scanned: numbers that were found by scanning (periods per turn, time of a jump), with their units.
        multiplicity: how many values of the scanned numbers compete: the evidence pays for them.
        variant: which of several forms of the effect at this location this is.
        parametrisation: how the terms' values are told: "plain", or "sine" for (sine, cosine) pairs as amplitude and
            phase, or "curve" for a free curve.
        refinement: a finer form of a curve: it does not compete, it may take the curve's place once that is chosen.
        partly_unseen: recordings may not tell some combination of its values, which then stays as wide as its prior.
    """

    effect: Effect
    location: str
    terms: tuple[Term, ...]
    prior_scale: tuple[float, ...]
    driver: str
    scanned: tuple[tuple[str, str, float], ...] = ()
    multiplicity: int = 1
    variant: str = ""
    parametrisation: Literal["plain", "sine", "curve"] = "plain"
    refinement: bool = False
    partly_unseen: bool = False

    @property
    def name(self) -> str:
        """The effect's name."""
        return self.effect.name

    @property
    def family(self) -> Family:
        """The effect's family."""
        return self.effect.family

    @property
    def nameless(self) -> bool:
        """Whether it is what follows something by no known physics."""
        return self.family == "unknown"

    @property
    def key(self) -> tuple[str, str]:
        """(effect, location), as a verdict names it."""
        return self.effect.name, self.location

    def __str__(self) -> str:
        extra = ", ".join(f"{name} {value:g}" for name, _, value in self.scanned)
        return f"{self.name} at {self.location}" + (f" ({extra})" if extra else "")


@dataclass(frozen=True)
class Effect:
    """The definition of an effect: a new one is one of these, listed in `armscope.physics.registry`.

    Attributes:
        name: as in the verdict.
        family: what kind of physics it is.
        place: the effect at every location of an arm where the recordings can show it.
        physics: one sentence: what happens.
        confirm: one sentence: how to confirm it on the real arm.
        cure: how to take it out, in words and as code (`armscope.physics.cure`).
        clauses: what a headline says of it (`armscope.physics.clause`); the first whose numbers are told is said.
        labels: its parameters' names on a card, where their own don't say it.
        atlas: the atlas' column in which it shows, or a function that gives it; "" for none. Elsewhere than at a joint
            or the base, and in a column of its own, it is weighed there as a whole.
        drivers: kinds of drivers that it brings along, by name (`armscope.physics.drivers`).
        needs: context columns without which it can't be seen.
        requires: family without which it does nothing: a payload's error shows through what gives way.
        departs: its values are departures from what is stated, which carry their sign.
        jumps: it holds from a moment on, before which it is not there.
        nonnegative: its one value is not negative: what gives way does so along its load.
        several: whether several of it (mesh lines, jumps, curves of different drivers) may stand at one place.
        contained_in: free curves, by driver, that hold it as a special case at the same location.
        exact: its motion where the terms are only the slope: (direction, amount (N,)) of a part at a scene's rows.
    """

    name: str
    family: Family
    place: Callable[[Arm, Recordings], Iterable[Placed]] = field(repr=False, compare=False)
    physics: str = field(compare=False)
    confirm: str = field(compare=False)
    cure: Cure = field(compare=False)
    clauses: tuple[Clause, ...] = field(default=(), repr=False, compare=False)
    labels: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    atlas: str | Callable[[Told], str] = field(default="", repr=False, compare=False)
    drivers: Mapping[str, DriverKind] = field(default_factory=dict, repr=False, compare=False)
    needs: tuple[str, ...] = ()
    requires: str = ""
    departs: bool = False
    jumps: bool = False
    nonnegative: bool = False
    several: bool = False
    contained_in: tuple[str, ...] = ()
    exact: Callable[[Scene, Part], Iterable[tuple[Direction, Array]]] | None = field(
        default=None, repr=False, compare=False
    )


def clash(one: Placed, other: Placed) -> bool:
    """Whether two effects at one location can't stand side by side: two forms of one, or a curve and what it contains.

    Several mesh lines or jumps can (their scanned numbers or runs differ), and curves of different drivers.
    """
    if one.name == other.name:
        return one.variant == other.variant if one.effect.several else True
    return _contains(one, other) or _contains(other, one)


def _contains(curve: Placed, special: Placed) -> bool:
    """Whether a free curve holds an effect as a special case; a variant named as a driver is in that one's curve."""
    within = special.effect.contained_in
    if curve.parametrisation != "curve" or curve.variant not in within:
        return False
    return special.variant not in within or special.variant == curve.variant


def region(placed: Placed) -> str:
    """Where an effect stands, coarsely: base, or the number of the joint whose neighbourhood moves."""
    return Location.of(placed.location).region
