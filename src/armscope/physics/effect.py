"""What an effect is: where it acts, in which directions, and what drives it.

Every effect is a small twist at one or more frames of the chain, driven by something known. It is written once, as
terms that are linear in their parameters, and serves twice: the exact model feeds the twists to the chain, the
diagnosis multiplies the same drivers with the frames' Jacobians (`armscope.physics.scene`).
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics.clause import Clause, Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.loaded_arm import LoadedArm, Misstated
from armscope.physics.terms import (
    AXES,
    ONE,
    Direction,
    DrivenTogether,
    Driver,
    DriverKind,
    Product,
    Term,
    driven_together,
    motor,
    term,
)
from armscope.recordings import Recordings
from armscope.robot import Arm

__all__ = [
    "AXES",
    "ONE",
    "Cure",
    "Direction",
    "Driver",
    "DriverKind",
    "Effect",
    "Family",
    "Part",
    "Placed",
    "Product",
    "Term",
    "clash",
    "motor",
    "region",
    "term",
]

FORMULA = "commanded = "
"""How a rule by which something is commanded away begins."""

Family = Literal["frame", "geometric", "transmission", "elastic", "thermal", "drift", "instrument", "unknown"]


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
        below_zero: in whose words it is told where its one value is below zero, which the physics does not allow.
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
    below_zero: Effect | None = field(default=None, repr=False, compare=False)
    exact: Callable[[LoadedArm, Part], Iterable[tuple[Direction, Array]]] | None = field(
        default=None, repr=False, compare=False
    )

    def told_as(self, value: float) -> Effect:
        """The definition in whose words it is told, by the first of its values."""
        return self.below_zero if self.below_zero is not None and value < 0 else self


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

    def without(self, terms: Collection[Term]) -> Placed | None:
        """The effect without some terms; None if it has no others."""
        kept = [n for n, term in enumerate(self.terms) if term not in terms]
        if not kept:
            return None
        return replace(
            self, terms=tuple(self.terms[n] for n in kept), prior_scale=tuple(self.prior_scale[n] for n in kept)
        )

    @functools.cached_property
    def driven(self) -> tuple[DrivenTogether, ...]:
        """What its terms move, direction by direction."""
        return driven_together(self.terms)

    def __str__(self) -> str:
        extra = ", ".join(f"{name} {value:g}" for name, _, value in self.scanned)
        return f"{self.name} at {self.location}" + (f" ({extra})" if extra else "")


@dataclass(frozen=True, eq=False)
class Part:
    """A placed effect with the values of its terms, SI units."""

    placed: Placed
    values: Array

    @property
    def implausible(self) -> list[tuple[Term, float]]:
        """The terms whose values are larger than real arms show, and the values; a curve is told as a whole."""
        if self.placed.parametrisation == "curve":
            return []
        told = zip(self.placed.terms, self.values, strict=True)
        return [(term, float(value)) for term, value in told if abs(value) > PLAUSIBLE.beyond * term.plausible]


@dataclass(frozen=True)
class Cure:
    """What to do about an effect.

    Attributes:
        mend: what to do, with the sign ("," or ";" or ".") after which `otherwise` goes on; what names a formula names
            it with its sign.
        otherwise: what else can be done, as the same sentence or the next one goes on: "or compensate for it in the
            command: ...".
        change: what is changed, in two words, for a work order.
        instruction: how, as a work order says it: a template over {location} and what is known of the effect
            (`armscope.verdict.work_order`).
        needs: what has to be done besides before the error is any less, in words.
        commanded: (scene at the wanted angles, fitted part) -> (N, m) angles to command, rad.
        statement: part -> by how much what was stated is wrong, which is then put right.
        readings: ((N, 3) readings in base axes, part) -> corrected readings.

    Where none of the three is given, the cure is the corrected model: command what its inverse kinematics asks for.
    """

    mend: str
    otherwise: str = field(default="", kw_only=True)
    change: str = field(default="", kw_only=True)
    instruction: str = field(default="", kw_only=True)
    needs: str = field(default="", kw_only=True)
    commanded: Callable[[LoadedArm, Part], Array] | None = None
    statement: Callable[[Part], Misstated] | None = None
    readings: Callable[[Array, Part], Array] | None = None

    @property
    def words(self) -> str:
        """The whole of it, for the card."""
        return f"{self.mend} {self.otherwise}".rstrip()

    @property
    def rule(self) -> str:
        """What a work order says beside its instruction, which is the first half at length: what else can be done."""
        said = self.otherwise if self.instruction else ""
        if "{correction}" in self.instruction and FORMULA in said:  # the instruction says so, with its range
            return FORMULA + said.partition(FORMULA)[2]
        return said[:1].upper() + said[1:] or self.words


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
