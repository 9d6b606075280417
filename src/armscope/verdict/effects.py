"""What is said of one effect, and of the causes that effects make up: plain data.

Units stand in the names (mm, rad, nats).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from pydantic import computed_field
from pydantic.dataclasses import dataclass as told_in_files

from armscope.core.types import Array, Number
from armscope.verdict.constants import WORDS

Specific = Literal["effect", "region", "family"]
CauseLevel = Literal["effect", "place", "family"]
INDISTINGUISHABLE_NATS = 3.0  # Evidence of 20 to 1: two readings closer than this are not told apart
INTERVAL = 1.959964  # Half width of a 95 % interval in standard errors
NO_SIZE = ("phase", "direction", "per_turn", "time", "row")  # Parameters that say where or when, not how much
UNKNOWN = "unknown"  # The family of what no known physics explains


@told_in_files(frozen=True)
class Parameter:
    """A fitted number in its file unit.

    Attributes:
        name: of the parameter, as its effect calls it.
        unit: of the value; empty for a pure number.
        value: as fitted; of a departure, actual less stated.
        stderr: one standard error; NaN of a number that was found by trying values.
    """

    name: str
    unit: str
    value: Number
    stderr: Number

    @computed_field(alias="interval_95")  # type: ignore[prop-decorator]
    @property
    def interval(self) -> tuple[Number, Number]:
        """The 95 % interval, from its standard error."""
        return self.value - INTERVAL * self.stderr, self.value + INTERVAL * self.stderr


@dataclass(frozen=True)
class Alternative:
    """Another effect that explains the same.

    Attributes:
        effect: its name.
        location: where it would be.
        family: what kind of physics it is.
        evidence_gap_nats: the evidence that would be lost by naming it instead.
        driver: what it follows.
        discriminability_nats: by how much the data tell the two apart: a rival that fits alike and only pays for a
            number more has a gap, but is not told apart.
        excluded: whether rows that took no part speak against it at 95 % (model confidence set over blocks of rows);
            None where that was not asked.
        same_motion: whether it moves the tool alike in every pose that the arm can take: what corrects the effect
            corrects it, whichever of them it is.
    """

    effect: str
    location: str
    family: str
    evidence_gap_nats: Number
    driver: str
    discriminability_nats: Number
    excluded: bool | None = None
    same_motion: bool = False

    @property
    def nameless(self) -> bool:
        """Whether no known physics explains it: it is known by what it follows alone."""
        return self.family == UNKNOWN


@dataclass(frozen=True, eq=False)
class Curve:
    """What an effect does over its driver: (K,) driver values, the turn or shift there and its standard error."""

    driver: str
    driver_unit: str
    at: Array
    value: Array
    stderr: Array
    value_unit: str
    description: str = ""


@dataclass(frozen=True, eq=False)
class FoundEffect:
    """An effect that the evidence asks for.

    Attributes:
        effect: its name; "unknown" where no known physics explains it.
        location: where it is.
        family: what kind of physics it is.
        driver: what it follows.
        named_as: how specific the evidence lets the name be.
        title: the name at that level, in words.
        minor: worth little of the mismatch.
        parameters: its fitted numbers.
        rms_at_tool_mm: per axis, beyond what the free frames absorb.
        share: of the residual variance after the free frames that goes when it is cured as found, averaged over the
            orders in which all can be cured; below zero it hides part of what others do.
        evidence_nats: what is lost by leaving it out.
        alternatives: what could stand in its place, nearest first.
        inclusion: how often it, or one of its alternatives at the same place, is chosen when rows are resampled
            (0 ... 1); None where resampling was switched off.
        carries_over: what is known about it on other runs, payloads or regions; empty where that was not tested.
        description: the shape of its curve in words; empty where it has none.
        curve: its shape over the driver, where it has one. Lives in memory (and in curves.csv) only.
        undetermined: parameters that these rows leave open: held near zero, and not told.
        share_after_calibration: the same share of what is left once the geometry is calibrated; NaN of what that mends,
            and where it is not called for.
        physics, confirm, cure: one sentence each, the definition's; not in verdict.json.
    """

    effect: str
    location: str
    family: str
    driver: str
    named_as: Specific
    title: str
    minor: bool
    parameters: tuple[Parameter, ...]
    rms_at_tool_mm: float
    share: float
    evidence_nats: float
    alternatives: tuple[Alternative, ...]
    inclusion: float | None
    curve: Curve | None = None
    physics: str = ""
    confirm: str = ""
    cure: str = ""
    carries_over: str = ""
    description: str = ""
    undetermined: tuple[str, ...] = ()
    share_after_calibration: Number = math.nan

    def __post_init__(self) -> None:
        if self.curve is not None and not self.description:
            object.__setattr__(self, "description", self.curve.description)

    @property
    def size_open(self) -> bool:
        """Whether these rows do not tell any of its sizes from zero: each interval holds it."""
        sizes = [p for p in self.parameters if p.name not in NO_SIZE and p.stderr > 0]
        return bool(sizes) and all(low <= 0 <= high for low, high in (p.interval for p in sizes))

    @property
    def scatters(self) -> bool:
        """Whether it is a joint that stands elsewhere from row to row, which no model foretells."""
        return any(p.name == "scatter" for p in self.parameters)

    @property
    def same_cure(self) -> bool:
        """Whether all that rows do not tell from it is corrected by the same: its name is open, its cure is not."""
        near = [each for each in self.alternatives if each.discriminability_nats < INDISTINGUISHABLE_NATS]
        return bool(near) and all(each.same_motion for each in near)

    @property
    def rarely_chosen(self) -> bool:
        """Whether most tables of the same rows drawn anew do without it."""
        return self.inclusion is not None and self.inclusion < WORDS.reliable

    @property
    def never_chosen(self) -> bool:
        """Whether no table of the same rows drawn anew has it."""
        return self.inclusion == 0

    @property
    def as_member(self) -> str:
        """ "effect at location", as causes list their members."""
        return f"{self.effect} at {self.location}"

    @property
    def weight(self) -> float:
        """The larger of its shares, of the whole and of what calibration leaves."""
        return max(self.share, self.share_after_calibration if math.isfinite(self.share_after_calibration) else 0.0)

    @property
    def nameless(self) -> bool:
        """Whether no known physics explains it: it is known by what it follows alone."""
        return self.family == UNKNOWN


@dataclass(frozen=True)
class Cause:
    """What is wrong, at the level at which one acts: effects of one family, and its small errors everywhere.

    Attributes:
        family: of its members.
        level: how deep the evidence goes: a family in several places, a place, or one effect.
        place: where; "arm" for several places.
        members: "effect at location" of those that have a name, largest share first.
        everywhere: whether small errors of the family in the whole arm belong to it.
        minor: all members are.
        share: of the residual variance after the free frames, members and small errors together.
        held_out_gain_mm: by how much the RMS of held-out rows would grow without it; below zero it would shrink.
        text: what is wrong, in a clause.
        cure: what to do, in a sentence.
        share_after_calibration: the same share of what is left once the geometry is calibrated; NaN of the geometry,
            of what no member is sure of, and where that is not called for.
    """

    family: str
    level: CauseLevel
    place: str
    members: tuple[str, ...]
    everywhere: bool
    minor: bool
    share: Number
    held_out_gain_mm: Number
    text: str
    cure: str
    share_after_calibration: Number = math.nan
