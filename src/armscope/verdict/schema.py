"""What a diagnosis says: plain data.

A `Verdict` is what verdict.json holds, both ways (`armscope.verdict.contract` has the file's names); a `Diagnosis` is a
verdict with what only lives in memory: the arrays that a report draws, the fitted model. Units stand in the names (mm,
rad, nats); arrays are NumPy arrays.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, WithJsonSchema

from armscope.core.types import Array
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings

Specific = Literal["effect", "region", "family"]
TOGETHER = "together"
CauseLevel = Literal["effect", "place", "family"]
Answer = Literal["nothing missing", "explained", "partly explained", "cannot tell"]
Number = Annotated[
    float,
    BeforeValidator(lambda value: np.nan if value is None else value),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "null"}]}),
]
"""A number that may not be known: NaN, null in a file."""
INDISTINGUISHABLE_NATS = 3.0
"""Evidence of 20 to 1: two readings closer than this are not told apart."""
INTERVAL = 1.959964
"""Half width of a 95 % interval in standard errors."""


@dataclass(frozen=True)
class Parameter:
    """A fitted number in its file unit."""

    name: str
    unit: str
    value: float
    stderr: float

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval."""
        return self.value - INTERVAL * self.stderr, self.value + INTERVAL * self.stderr


@dataclass(frozen=True)
class Alternative:
    """Another effect that explains the same.

    Attributes:
        evidence_gap_nats: the evidence that would be lost by naming it instead.
        discriminability_nats: by how much the data tell the two apart: a rival that fits alike and only pays for a
            number more has a gap, but is not told apart.
        excluded: whether rows that took no part speak against it at 95 % (model confidence set over blocks of rows);
            None where that was not asked.
    """

    effect: str
    location: str
    family: str
    evidence_gap_nats: Number
    driver: str
    discriminability_nats: Number
    excluded: bool | None = None


@dataclass(frozen=True, eq=False)
class Curve:
    """What an effect does over its driver: (K,) driver values, the turn or shift there and its standard error.

    ``periods``: the strongest waves per turn as (per_turn, amplitude), strongest first, for angles.
    """

    driver: str
    driver_unit: str
    at: Array
    value: Array
    stderr: Array
    value_unit: str
    periods: tuple[tuple[float, float], ...] = ()
    description: str = ""


@dataclass(frozen=True, eq=False)
class FoundEffect:
    """An effect that the evidence asks for.

    Attributes:
        effect, location, family, driver: what and where, and what it follows.
        named_as: how specific the evidence lets the name be; ``title`` is the name at that level, in words.
        minor: worth little of the mismatch.
        parameters: with standard errors.
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

    def __post_init__(self) -> None:
        if self.curve is not None and not self.description:
            object.__setattr__(self, "description", self.curve.description)


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


@dataclass(frozen=True)
class Unexplained:
    """Structure beyond the noise for which no effect was found."""

    present: bool
    location: str | None = None
    driver: str | None = None
    rms_mm: Number = 0.0
    description: str = ""


@dataclass(frozen=True)
class Background:
    """Small errors of one family that were allowed for everywhere in the arm and are not named one by one.

    ``size``: share of the tolerance (1 mm, 1 mrad) for the geometric family, mm at the tool for the others. A verdict
    has one for all families together (family "all", size NaN) and one per family.
    """

    family: str
    present: bool
    size: Number
    rms_at_tool_mm: Number
    share: Number


@dataclass(frozen=True)
class WaterfallStep:
    """RMS per axis with one effect more than in the step before: on the fitted rows and on held-out rows, mm.

    ``spread_mm``: standard deviation of the held-out RMS from fold to fold; NaN with a single fold. ``minor``: the
    effect is apart from the story.
    """

    label: str
    fitted_mm: Number
    held_out_mm: Number
    spread_mm: Number = float("nan")
    minor: bool = False


@dataclass(frozen=True)
class HeldOut:
    """Cross-validation of the whole procedure; RMS per axis on rows that took no part, mm. NaN: it was not possible.

    ``before`` and ``after`` leave out the rows that look like bad shots; the same of all rows stands beside them.
    ``spread``: standard deviation of ``after`` from fold to fold. ``turn_before``, ``turn_after``: of orientations,
    mrad, where they were measured.
    """

    before: float
    after: float
    folds: int = 0
    grouped_by: str = ""
    before_all_rows: float = float("nan")
    after_all_rows: float = float("nan")
    spread: float = float("nan")
    turn_before: float = float("nan")
    turn_after: float = float("nan")


@dataclass(frozen=True)
class Orientations:
    """What the measured orientations say; RMS per axis, mrad.

    Attributes:
        rows: that hold one.
        noise_mrad: what the fitted model leaves of them.
        lever_mm: by which a turn counts beside a shift of the point: the ratio of their noises.
        before_mrad: after the free frames alone.
    """

    rows: int
    noise_mrad: float
    lever_mm: float
    before_mrad: float


@dataclass(frozen=True, eq=False)
class Atlas:
    """Share of the residual variance that each location x direction x driver explains.

    ``share`` is (locations, directions, drivers) on top of the free frames; ``left`` the same on top of the whole
    fitted model, as a share of the same initial variance. NaN where a driver does not exist. Base and joints have the
    six directions of a twist; links, linkage, payload and instrument `TOGETHER`: what their effect moves, as a whole.
    """

    locations: tuple[str, ...]
    directions: tuple[str, ...]
    drivers: tuple[str, ...]
    share: Array
    left: Array


@dataclass(frozen=True, eq=False)
class Residuals:
    """Per row, base axes, mm: (N, 3) tool points, and measured minus modelled, frames only and with the model."""

    points: Array
    before: Array
    after: Array
    weight: Array
    id: NDArray[np.str_]
    run: NDArray[np.str_]


@dataclass(frozen=True)
class SuspectRow:
    """A row that looks like a bad shot: it was weighted down, not dropped."""

    id: str
    run: str
    residual_mm: Number
    weight: Number


@dataclass(frozen=True, eq=False)
class NextPoses:
    """Poses to measure next: (K, m) motor angles (rad), and how far apart (mm) two readings predict the tool there."""

    motor_angles: Array
    payload_kg: Array
    separation_mm: Array
    first: str
    second: str
    repeats_needed: float


@dataclass(frozen=True)
class Notice:
    """A plain statement that limits the verdict."""

    kind: str
    text: str


@dataclass(frozen=True, eq=False)
class Verdict:
    """What verdict.json holds.

    Attributes:
        answer, headline: the answer in two words and in one sentence.
        mismatch: None where the recordings cannot tell.
        noise_mm: per axis, 1 sigma; ``noise_source`` says where it comes from.
        residual_before_mm, residual_after_mm: RMS per axis on the fitted rows, frames only and with the model.
        causes: what is wrong, in a few causes, largest share first.
        effects: in order of ``share``, the measure of importance; those with ``minor`` true are apart from the story.
        background, background_families: small errors everywhere, together and by family.
        notices: what the verdict must not hide.
        rows, runs: that were used, and which runs they are of.
        settings: what was asked for.
    """

    answer: Answer
    headline: str
    mismatch: bool | None
    noise_mm: float
    noise_source: str
    residual_before_mm: float
    residual_after_mm: float
    effects: tuple[FoundEffect, ...]
    background: Background
    background_families: tuple[Background, ...]
    unexplained: Unexplained
    held_out: HeldOut
    waterfall: tuple[WaterfallStep, ...]
    suspects: tuple[SuspectRow, ...]
    notices: tuple[Notice, ...]
    rows: int
    runs: tuple[str, ...]
    orientations: Orientations | None = None
    causes: tuple[Cause, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """The content of verdict.json: the contract's names, and further ones."""
        from armscope.verdict.contract import to_json

        return to_json(self)

    @staticmethod
    def from_json(content: Any, source: object = "verdict.json") -> Verdict:
        """A verdict from the content of verdict.json: all that `to_json` writes, no curves, no sentences of effects.

        Args:
            content: as JSON gives it.
            source: the file, for an error.

        Raises:
            InputError: it is none, or of another version.
        """
        from armscope.verdict.contract import from_json

        return from_json(content, source)


@dataclass(frozen=True, eq=False, kw_only=True)
class Diagnosis(Verdict):
    """A verdict with what only lives in memory.

    Attributes:
        arm: the arm's name.
        source: the table's file.
        recordings: the table as it was used: without the rows that can't be measurements, and without orientations
            that are not the arm's.
        atlas, residuals, next_poses: what a report draws (atlas.csv, predicted.csv and next_poses.csv hold most of it).
        model: the fitted model (model.yaml).
        seconds: how long it took.
    """

    arm: str
    source: str
    recordings: Recordings
    atlas: Atlas | None
    residuals: Residuals
    next_poses: NextPoses | None
    model: FittedModel
    seconds: float = 0.0

    def after(self, seconds: float, settings: dict[str, Any]) -> Diagnosis:
        """The diagnosis with how long it took and what was asked for."""
        return replace(self, seconds=seconds, settings=dict(settings))
