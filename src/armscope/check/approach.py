"""Columns of the side of approach with the wrong sign: by them play would put a joint ahead of its command."""

from __future__ import annotations

import numpy as np

from armscope.calibration.geometry import State
from armscope.check.plain_constants import LEADING
from armscope.check.plain_errors import PlainErrors
from armscope.check.suspicion import APPROACH, Suspicion
from armscope.recordings import Recordings
from armscope.robot import Arm


def leading_joints(arm: Arm, recordings: Recordings, state: State) -> list[Suspicion]:
    """Joints that are ahead of their command by the recorded side of approach, where play can only leave them behind.

    Args:
        arm: the nominal arm.
        recordings: some rows.
        state: base and tool as fitted to these rows.

    Returns:
        A hint for each; controllers that make up for more play than there is give the same picture.
    """
    if recordings.approach is None:
        return []
    sides = np.nan_to_num(recordings.approach)
    tried = np.flatnonzero(np.ptp(sides, axis=0) > LEADING.both_sides)
    found = PlainErrors(arm, recordings, state).with_turns(tried, -0.5 * sides[:, tried])
    if found is None:
        return []
    clear = found.values < -LEADING.standard_errors * found.stderrs
    return [_told(int(motor) + 1, -float(gap)) for motor, gap in zip(tried[clear], found.values[clear], strict=True)]


def _told(motor: int, ahead: float) -> Suspicion:
    statement = (
        f"by the sign of approach{motor}, joint {motor} is {1e6 * ahead:.0f} microrad further on after a positive "
        "motion than after a negative one, where play leaves it behind"
    )
    cure = (
        f"Turn the sign of column approach{motor} (+1: the last motion was positive). If it is right, the controller "
        "makes up for more play than there is."
    )
    return Suspicion("hint", statement, cure, APPROACH)
