"""Whether runs share what they are said to share: one tool, one base frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.calibration.constants import CALIBRATING
from armscope.calibration.fit import placed
from armscope.calibration.model import set_up
from armscope.core.sampling import spread_evenly
from armscope.fitting.constants import EXCHANGE
from armscope.fitting.exchanged_tool import exchanged_tool
from armscope.fitting.registration import fit_frames
from armscope.measurement.robust import scale_of
from armscope.recordings import Recordings
from armscope.robot import Arm


def sharing(arm: Arm, recordings: Recordings, one_base: bool, tool_per_run: bool | None) -> tuple[list[str], list[str]]:
    """What speaks against the frames that runs are said to share.

    Args:
        arm: the nominal arm.
        recordings: measured points.
        one_base: whether all runs are said to share a base frame.
        tool_per_run: whether every run has a tool of its own; None: nobody said.

    Returns:
        (notes, doubts), sentences; a note if tools must be free per run and nobody said otherwise.
    """
    if len(np.unique(recordings.run)) < 2:
        return [], []
    notes, doubts = list[str](), list[str]()
    some = replace(recordings.rows(spread_evenly(len(recordings), CALIBRATING.rows_of_frames)), orientation=None)
    if not tool_per_run and (found := exchanged_tool(fit_frames(arm, some), some)):
        text = f"one tool for all runs leaves {found.shared_mm:.3g} mm, one per run {found.own_mm:.3g} mm"
        if tool_per_run is None:
            notes.append(f"{text}: it was exchanged, and is free in every run")
        else:
            doubts.append(f"{text}: it was exchanged")
    if one_base:
        free = bool(notes) or bool(tool_per_run)
        shared, own = (_usual_miss(arm, some, one, free) for one in (True, False))
        if shared > EXCHANGE.worse * own:
            text = f"one base frame for all runs leaves {shared * 1e3:.3g} mm, one per run {own * 1e3:.3g} mm"
            doubts.append(f"{text}: it was moved")
    return notes, doubts


def _usual_miss(arm: Arm, recordings: Recordings, one_base: bool, tool_per_run: bool) -> float:
    """The spread (1-sigma per axis by the median, m) about base and tool, for the numbers that these cost.

    Infinite where frames for so few rows would follow anything.
    """
    rows = set_up(arm, recordings, one_base, tool_per_run)
    measured, spent = 3 * len(rows), 6 * len(rows.base_names) + 3 * len(rows.tool_names)
    if measured < EXCHANGE.least_numbers * spent:
        return float(np.inf)
    spread = scale_of(rows.residuals(placed(rows)))
    return spread * float(np.sqrt(measured / (measured - spent)))
