"""Columns of the side of approach that are another joint's, or have the wrong sign.

By the first play would be told at the wrong joint, by the second it would put a joint ahead of its command.
"""

from __future__ import annotations

import numpy as np

from armscope.calibration.geometry import State
from armscope.check.plain_constants import LEADING
from armscope.check.plain_errors import PlainErrors
from armscope.check.suspicion import APPROACH, Suspicion
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.recordings.motion import sides_of_last_moves
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


def exchanged_sides(recordings: Recordings) -> list[Suspicion]:
    """Columns that hold the side from which another joint came, by the row before, and not their own joint's.

    Where the arm went by other ways than from row to row, sides agree with no joint's motions, and nothing is told.
    """
    if recordings.approach is None:
        return []
    moved, known = sides_of_last_moves(recordings), np.nan_to_num(recordings.approach)
    both = (known != 0).T.astype(float) @ (np.nan_to_num(moved) != 0)
    share = 0.5 * (1 + known.T @ np.nan_to_num(moved) / np.maximum(both, 1))
    share[both < LEADING.fewest_rows] = 0.0
    sure = share > LEADING.agrees
    others = {motor: int(np.argmax(share[motor])) for motor in np.flatnonzero(sure.any(axis=1) & ~sure.diagonal())}
    return [_exchanged(int(motor), other, share[motor]) for motor, other in others.items()]


def _exchanged(motor: int, other: int, share: Array) -> Suspicion:
    """Told of the column of a motor (from 0), of the other that it follows, and the shares of rows in which it does."""
    statement = (
        f"approach{motor + 1} holds the side from which joint {other + 1} came, by the row before, in "
        f"{100 * share[other]:.0f} % of the rows, and joint {motor + 1} in {100 * share[motor]:.0f} %"
    )
    cure = f"Are columns approach{motor + 1} and approach{other + 1} exchanged? Play would be told at the wrong joint."
    return Suspicion("hint", statement, cure, APPROACH)


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
