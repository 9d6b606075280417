"""Whether runs share what they are said to share: one tool, one base frame."""

from __future__ import annotations

import numpy as np

from armscope.calibration.fit import placed, spread_of
from armscope.calibration.model import set_up
from armscope.recordings import Recordings
from armscope.robot import Arm

WORSE = 2.0
"""Runs do not share a frame if one for all leaves more than this many times what one per run leaves: a mere shift of
tenths of what the arm itself misses must not cost a frame its precision."""
LEAST_NUMBERS = 2
"""Measured numbers per number of a frame, for frames to tell anything."""
ROWS = 1000
"""Rows that are looked at, at most."""


def exchanged_tool(arm: Arm, recordings: Recordings, one_base: bool) -> str:
    """A sentence if one tool per target does not do for all runs; empty if it does.

    Args:
        arm: the nominal arm.
        recordings: measured points of several runs.
        one_base: one base frame for all runs.

    Returns:
        The sentence.
    """
    shared, own = (_usual_miss(arm, recordings, one_base, per_run) for per_run in (False, True))
    if shared <= WORSE * own:
        return ""
    return f"one tool for all runs leaves {shared * 1e3:.3g} mm, one per run {own * 1e3:.3g} mm: it was exchanged"


def moved_base(arm: Arm, recordings: Recordings, tool_per_run: bool) -> str:
    """A sentence if one base frame does not do for all runs; empty if it does.

    Args:
        arm: the nominal arm.
        recordings: measured points of several runs.
        tool_per_run: a tool of its own for every run.

    Returns:
        The sentence.
    """
    shared, own = (_usual_miss(arm, recordings, one_base, tool_per_run) for one_base in (True, False))
    if shared <= WORSE * own:
        return ""
    return f"one base frame for all runs leaves {shared * 1e3:.3g} mm, one per run {own * 1e3:.3g} mm: it was moved"


def _usual_miss(arm: Arm, recordings: Recordings, one_base: bool, tool_per_run: bool) -> float:
    """The spread (1-sigma per axis by the median, m) about base and tool, for the numbers that these cost.

    Infinite where frames for so few rows would follow anything.
    """
    some = np.unique(np.linspace(0, len(recordings) - 1, min(len(recordings), ROWS)).astype(np.intp))
    rows = set_up(arm, recordings.rows(some), one_base, tool_per_run)
    measured, spent = 3 * len(rows), 6 * len(rows.base_names) + 3 * len(rows.tool_names)
    if measured < LEAST_NUMBERS * spent:
        return float(np.inf)
    spread = spread_of(np.linalg.norm(rows.residuals(placed(rows)), axis=1))
    return spread * float(np.sqrt(measured / (measured - spent)))
