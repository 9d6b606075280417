"""What error may be promised on other poses: that of rows that fit nothing, too, where these are no bad shots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.recordings import Recordings
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.schema import NO_BAD_SHOTS, Verdict


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
