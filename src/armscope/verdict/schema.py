"""What a diagnosis says: plain data, everything that a report draws, and verdict.json's contract.

A report needs nothing but a `Verdict`. Units stand in the names (mm, rad, nats); arrays are NumPy arrays. Effects stand
in order of `rms_at_tool_mm`; those with ``minor`` true are apart from the story. ``mismatch`` is None where the
recordings cannot tell. What the verdict must not hide stands in ``notices``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.physics.model import FittedModel

Specific = Literal["effect", "region", "family"]
TOGETHER = "together"
Answer = Literal["nothing missing", "explained", "partly explained", "cannot tell"]
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
    """Another effect that explains the same: the evidence that would be lost by naming it instead."""

    effect: str
    location: str
    family: str
    evidence_gap_nats: float
    driver: str


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
        share: of the residual variance after the free frames, averaged over the orders in which effects come in.
        evidence_nats: what is lost by leaving it out.
        alternatives: what could stand in its place, nearest first.
        inclusion: how often it, or one of its alternatives at the same place, is chosen when rows are resampled
            (0 ... 1); None where resampling was switched off.
        curve: its shape over the driver, where it has one.
        physics, confirm, cure: one sentence each.
        carries_over: what is known about it on other runs, payloads or regions; empty where that was not tested.
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
    curve: Curve | None
    physics: str
    confirm: str
    cure: str
    carries_over: str = ""


@dataclass(frozen=True)
class Unexplained:
    """Structure beyond the noise for which no effect was found."""

    present: bool
    location: str | None = None
    driver: str | None = None
    rms_mm: float = 0.0
    description: str = ""


@dataclass(frozen=True)
class Background:
    """Small errors of one family that were allowed for everywhere in the arm and are not named one by one.

    ``size``: share of the tolerance (1 mm, 1 mrad) for the geometric family, mm at the tool for the others. A verdict
    has one for all families together (family "all", size NaN) and one per family.
    """

    family: str
    present: bool
    size: float
    rms_at_tool_mm: float
    share: float


@dataclass(frozen=True)
class WaterfallStep:
    """RMS per axis with one effect more than in the step before: on the fitted rows and on held-out rows, mm.

    ``spread_mm``: standard deviation of the held-out RMS from fold to fold; NaN with a single fold. ``minor``: the
    effect is apart from the story.
    """

    label: str
    fitted_mm: float
    held_out_mm: float
    spread_mm: float = float("nan")
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
    residual_mm: float
    weight: float


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
    """The whole answer; see the module's docstring."""

    arm: str
    source: str
    rows: int
    runs: tuple[str, ...]
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
    atlas: Atlas | None
    residuals: Residuals
    suspects: tuple[SuspectRow, ...]
    next_poses: NextPoses | None
    notices: tuple[Notice, ...]
    model: FittedModel
    orientations: Orientations | None = None
    seconds: float = 0.0
    settings: dict[str, Any] = field(default_factory=dict)

    def after(self, seconds: float, settings: dict[str, Any]) -> Verdict:
        """The verdict with how long it took and what was asked for."""
        return replace(self, seconds=seconds, settings=dict(settings))

    def to_json(self) -> dict[str, Any]:
        """The content of verdict.json: the contract's names, and further ones."""
        return {
            "mismatch": self.mismatch,
            "answer": self.answer,
            "headline": self.headline,
            "noise_mm": self.noise_mm,
            "noise_source": self.noise_source,
            "effects": [_effect(effect) for effect in self.effects],
            "unexplained": {
                "present": self.unexplained.present,
                "location": self.unexplained.location,
                "driver": self.unexplained.driver,
                "rms_mm": self.unexplained.rms_mm,
                "description": self.unexplained.description,
            },
            "background": vars(self.background),
            "background_families": [vars(family) for family in self.background_families],
            "held_out_rms_mm": {
                "before": self.held_out.before,
                "after": self.held_out.after,
                "before_all_rows": self.held_out.before_all_rows,
                "after_all_rows": self.held_out.after_all_rows,
                "spread": self.held_out.spread,
                "folds": self.held_out.folds,
                "grouped_by": self.held_out.grouped_by,
            },
            "orientation": None if self.orientations is None else self._told_of_turns(self.orientations),
            "fitted_rms_mm": {"before": self.residual_before_mm, "after": self.residual_after_mm},
            "waterfall": [vars(step) for step in self.waterfall],
            "suspects": [vars(row) for row in self.suspects],
            "notices": [vars(notice) for notice in self.notices],
            "rows": self.rows,
            "runs": list(self.runs),
            "settings": self.settings,
        }

    def _told_of_turns(self, seen: Orientations) -> dict[str, Any]:
        held_out = {"before": self.held_out.turn_before, "after": self.held_out.turn_after}
        return {**vars(seen), "held_out_rms_mrad": held_out}


def _effect(found: FoundEffect) -> dict[str, Any]:
    return {
        "effect": found.effect,
        "location": found.location,
        "family": found.family,
        "driver": found.driver,
        "named_as": found.named_as,
        "title": found.title,
        "minor": found.minor,
        "parameters": [
            {"name": p.name, "unit": p.unit, "value": p.value, "stderr": p.stderr, "interval_95": list(p.interval)}
            for p in found.parameters
        ],
        "rms_at_tool_mm": found.rms_at_tool_mm,
        "share": found.share,
        "evidence_nats": found.evidence_nats,
        "alternatives": [vars(alternative) for alternative in found.alternatives],
        "inclusion": found.inclusion,
        "description": found.curve.description if found.curve else "",
        "carries_over": found.carries_over,
    }
