"""Whether a table is long enough for a diagnosis."""

from __future__ import annotations

from armscope.calibration.model import set_up
from armscope.check.constants import TABLE
from armscope.check.suspicion import TOO_SHORT, Suspicion
from armscope.recordings import Recordings
from armscope.recordings.motion import moving
from armscope.robot import Arm

MORE = "Record more poses: `armscope poses` proposes them."


def rows_needed(arm: Arm, recordings: Recordings) -> int:
    """How many rows a table of these runs and targets needs at least for a diagnosis to begin."""
    free = int(set_up(arm, recordings).free("nominal").sum())
    return max(TABLE.rows, 2 * free // 3 + 1)


def still(recordings: Recordings) -> list[Suspicion]:
    """That no joint moves; of a few rows it is that they are few."""
    if moving(recordings.motor_angles).any():
        return []
    if len(recordings) >= TABLE.rows:
        return [Suspicion("problem", "every joint stands still")]
    cure = f"A diagnosis needs {TABLE.rows} rows at least, in different poses."
    return [Suspicion("problem", f"{_rows(recordings)} in which every joint stands still", cure, TOO_SHORT)]


def too_few(recordings: Recordings, arm: Arm | None) -> list[Suspicion]:
    """A hint where a diagnosis would not begin. ``arm``: of as many motors as the table; None where it is not known."""
    needed = TABLE.rows if arm is None else rows_needed(arm, recordings)
    if len(recordings) >= needed:
        return []
    return [Suspicion("hint", f"{_rows(recordings)}, and a diagnosis needs {needed} at least", MORE)]


def _rows(recordings: Recordings) -> str:
    return f"{len(recordings)} row{'s' * (len(recordings) != 1)}"
