"""Where what an arm carries sits: nobody states it, and every compliance goes with its lever."""

from __future__ import annotations

import numpy as np

from armscope.calibration.geometry import State
from armscope.check.constants import TRIALS
from armscope.check.suspicion import Suspicion
from armscope.recordings import Recordings
from armscope.robot import Arm


def payload_at_the_flange(arm: Arm, recordings: Recordings, state: State) -> list[Suspicion]:
    """Payloads whose place nobody stated, where the points show a tool: its lever is in every compliance.

    Args:
        arm: the nominal arm.
        recordings: the table.
        state: base and tool that were fitted.

    Returns:
        A hint with the place, or nothing.
    """
    if recordings.payload is None or not np.nan_to_num(recordings.payload).max() > 0 or any(arm.description.tool_mm):
        return []
    at = 1e3 * state.tools.mean(axis=0)
    if np.linalg.norm(at) < TRIALS.lever_mm:
        return []
    told = ", ".join(f"{each:.0f}" for each in at)
    statement = "payload_kg is recorded, no tool_mm stated: each payload counts as sitting in the last frame's origin"
    cure = f"State `tool_mm` in the robot's file, if it sits where the points are measured: [{told}]."
    return [Suspicion("hint", statement, cure)]
