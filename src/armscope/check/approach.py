"""Columns of the side of approach with the wrong sign: by them play would put a joint ahead of its command."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.calibration.model import set_up
from armscope.calibration.state import Posed, State
from armscope.check.constants import LEADING
from armscope.check.suspicion import APPROACH, Suspicion
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import Arm, position_jacobian


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
    rows = set_up(arm, replace(recordings, orientation=None))
    posed = rows.posed(state)
    left, columns = posed.left.ravel(), rows.jacobian(state, posed, rows.free("compliance"))
    beside = np.hstack([columns, drive_columns(arm, posed, recordings.motor_angles)])
    gaps = (-0.5 * position_jacobian(arm, posed.frames)[:, :, tried] * sides[:, None, tried]).reshape(len(left), -1)
    spanned, size, _ = np.linalg.svd(beside / np.maximum(np.linalg.norm(beside, axis=0), 1e-300), full_matrices=False)
    spanned = spanned[:, size > LEADING.rank * size[0]]
    numbers = len(left) - spanned.shape[1] - len(tried)
    if not len(tried) or numbers <= len(tried):
        return []
    left, own = (each - spanned @ (spanned.T @ each) for each in (left, gaps))
    squares = own.T @ own
    if np.linalg.cond(squares) > LEADING.apart:
        return []
    found = np.linalg.solve(squares, own.T @ left)
    variance = float(np.sum((left - own @ found) ** 2)) / numbers
    clear = found < -LEADING.standard_errors * np.sqrt(variance * np.diag(np.linalg.inv(squares)))
    return [_told(int(motor) + 1, -float(gap)) for motor, gap in zip(tried[clear], found[clear], strict=True)]


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


def drive_columns(arm: Arm, posed: Posed, angles: Array) -> Array:
    """What drives that turn wrong by their own angle do: a ratio, and waves once and twice per turn.

    Gravity's load is such a wave of the angles of a joint and those behind it: a ratio in error or an encoder off its
    centre, for which nothing else is free, looks like a joint that gives way, and as often against its load as along.

    Args:
        arm: the nominal arm.
        posed: the arm at its rows.
        angles: (N, m) of its motors there, rad.

    Returns:
        (3 N, 5 m) m, in the axes of the arm's base.
    """
    turned = position_jacobian(arm, posed.frames)
    drivers = (angles, *(wave(n * angles) for n in (1, 2) for wave in (np.cos, np.sin)))
    return np.concatenate([turned * driver[:, None, :] for driver in drivers], axis=2).reshape(posed.left.size, -1)
