"""Targets that are no reflectors: each gets a tool offset of its own, so that nothing is left to fit."""

from __future__ import annotations

from armscope.check.suspicion import Suspicion
from armscope.recordings import Recordings, numbered_points


def named_row_by_row(recordings: Recordings) -> list[Suspicion]:
    """Whether column target has nearly as many names as the table has rows: then it numbers points."""
    names = recordings.target.tolist()
    if not numbered_points.number_the_rows(names):
        return []
    return [Suspicion("problem", f"column target: {numbered_points.told_of_names(names)}", numbered_points.CURE)]
