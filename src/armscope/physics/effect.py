"""What an effect is: where it acts, in which directions, and what drives it.

Every effect is a small twist at one or more frames of the chain, driven by something known. It is written once, as
terms that are linear in their parameters, and serves twice: the exact model feeds the twists to the chain, the
diagnosis multiplies the same drivers with the frames' Jacobians (`armscope.physics.scene`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from numbers import Real
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
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
            "motor j": motor angle j, which turns chain joints through the arm's actuation; "instrument".
        axis: one of `AXES` for a frame, "turn" for a motor, "scale" for the instrument.
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
    """

    name: str
    unit: str
    si: float
    products: tuple[Product, ...]


def term(name: str, unit: str, *products: Product | tuple[Direction, Driver], si: float = 1.0) -> Term:
    """A term from products or (direction, driver) pairs."""
    return Term(name, unit, si, tuple(p if isinstance(p, Product) else Product(*p) for p in products))


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
        shape: relative size that each term is expected to have at the tool; one number per term.
        driver: what it follows, in words.
        scanned: numbers that were found by scanning (periods per turn, time of a jump), with their units.
        tried: how many values of the scanned numbers compete: the evidence pays for them.
        variant: which of several forms of the effect at this location this is.
        reading: how the terms' values are told: "plain", or "sine" for (sine, cosine) pairs as amplitude and phase,
            or "curve" for a free curve.
        fine: a finer form of a curve: it does not compete, it may take the curve's place once that is chosen.
    """

    effect: Effect
    location: str
    terms: tuple[Term, ...]
    shape: tuple[float, ...]
    driver: str
    scanned: tuple[tuple[str, str, float], ...] = ()
    tried: int = 1
    variant: str = ""
    reading: Literal["plain", "sine", "curve"] = "plain"
    fine: bool = False

    @property
    def name(self) -> str:
        """The effect's name."""
        return self.effect.name

    @property
    def family(self) -> Family:
        """The effect's family."""
        return self.effect.family

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
        cure: one sentence: how to cure it.
        needs: context columns without which it can't be seen.
        rests_on: family without which it does nothing: a payload's error shows through what gives way.
        along: its one value is not negative: what gives way does so along its load.
    """

    name: str
    family: Family
    place: Callable[[Arm, Recordings], Iterable[Placed]] = field(repr=False, compare=False)
    physics: str = field(compare=False)
    confirm: str = field(compare=False)
    cure: str = field(compare=False)
    needs: tuple[str, ...] = ()
    rests_on: str = ""
    along: bool = False


CONTAINED = {
    "angle": {"joint_offset", "gear_ratio", "gear_eccentricity", "gear_mesh"},
    "load": {"joint_compliance", "joint_offset", "backlash"},
    "approach": {"backlash"},
    "time": {"base_drift", "joint_offset"},
    "temperature": {"joint_offset"},
}
"""What a free curve of a driver contains as special cases at the same location."""


def clash(one: Placed, other: Placed) -> bool:
    """Whether two effects at one location can't stand side by side: two forms of one, or a curve and what it contains.

    Several mesh lines or jumps can (their scanned numbers or runs differ), and curves of different drivers.
    """
    if one.name == other.name:
        if one.name == "base_drift":
            return True  # one base moves one way; with pauses or without is the same motion
        several = one.tried > 2 or one.reading == "curve" or one.family == "drift"
        return one.variant == other.variant if several else True
    for curve, special in ((one, other), (other, one)):
        if curve.reading == "curve" and special.name in CONTAINED.get(curve.variant, set()):
            return special.name != "backlash" or special.variant == curve.variant
    return False


def region(placed: Placed) -> str:
    """Where an effect stands, coarsely: base, or the number of the joint whose neighbourhood moves.

    Link j of a standard D-H row lies between joints j and j+1; "joint 6 from joint 5" counts as joint 6.
    """
    words = placed.location.split()
    return words[1] if words[0] in ("joint", "link") and len(words) > 1 else placed.location
