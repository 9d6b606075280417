"""A verdict with what only lives in memory (arrays that a report draws, the fitted model), and what may be promised.

Units stand in the names (mm, rad, nats); arrays are NumPy arrays.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.verdict.effects import FoundEffect
from armscope.verdict.schema import NO_BAD_SHOTS, Verdict

TOGETHER = "together"


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


@dataclass(frozen=True, eq=False)
class NextPoses:
    """Poses to measure next: (K, m) motor angles (rad), and how far apart (mm) two readings predict the tool there.

    payload_kg is NaN where no payload was recorded; checked says, in sentences, what the poses keep clear of.
    """

    motor_angles: Array
    payload_kg: Array
    separation_mm: Array
    first: str
    second: str
    repeats_needed: float
    checked: str = ""

    @property
    def settle(self) -> bool:
        """Whether measuring them, so often as anybody would, settles which reading is right."""
        return bool(np.isfinite(self.repeats_needed))

    def ask_about(self, effect: FoundEffect) -> bool:
        """Whether the first of the two readings, the one that stands in the verdict, is this effect."""
        return self.first.startswith(effect.as_member)


@dataclass(frozen=True, eq=False, kw_only=True)
class Diagnosis(Verdict):
    """A verdict with what only lives in memory."""

    arm: str  # the arm's name
    source: str  # the table's file
    # the table as it was used: without the rows that can't be measurements, and without orientations that are not the
    # arm's
    recordings: Recordings
    # atlas, residuals, next_poses: what a report draws (atlas.csv, predicted.csv and next_poses.csv hold most of it)
    atlas: Atlas | None
    residuals: Residuals
    next_poses: NextPoses | None
    model: FittedModel  # the fitted model (model.yaml)
    seconds: float = 0.0  # how long it took

    def after(self, seconds: float, settings: dict[str, Any]) -> Diagnosis:
        """The diagnosis with how long it took and what was asked for."""
        return replace(self, seconds=seconds, settings=dict(settings))


@dataclass(frozen=True)
class Promise:
    """RMS per axis on rows that took no part, mm; NaN where nothing was held out."""

    before: float  # with the frames only
    after: float
    # whether rows that fit nothing are among them: so many are seldom bad shots, and an arm that is told to miss as
    # little as all others do will miss by theirs, too
    of_all: bool

    @property
    def foretold(self) -> tuple[float, bool]:
        """`after`, and whether it is that of all rows."""
        return self.after, self.of_all


def promised(verdict: Verdict) -> Promise:
    """The held-out error of a verdict's well-fitting rows, or of all where those that don't are too many for bad shots.

    Bad shots are the instrument's: the arm does not miss by them.
    """
    held = verdict.held_out
    many = any(notice.kind == NO_BAD_SHOTS for notice in verdict.notices)
    if many and np.isfinite(held.before_all_rows) and np.isfinite(held.after_all_rows):
        return Promise(held.before_all_rows, held.after_all_rows, True)
    return Promise(held.before, held.after, False)


def rows_it_rests_on(verdict: Diagnosis) -> Recordings:
    """The rows that a verdict's model was learned from: all but the bad shots that it lists.

    A single shot far out would else widen the range in which commands are given, though it counted for nothing.
    """
    table = verdict.recordings
    if promised(verdict).of_all:
        return table
    bad = {(row.run, row.id) for row in verdict.suspects}
    kept = [(str(run), str(row)) not in bad for run, row in zip(table.run, table.id, strict=True)]
    return table.rows(np.flatnonzero(kept))
