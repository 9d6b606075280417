"""What stands in a table beside the errors that a plain arm has: geometry, drives that give way or turn unevenly."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from armscope.calibration.geometry import Posed, State
from armscope.calibration.model import set_up
from armscope.check.plain_constants import PLAIN
from armscope.core.types import Array, Indices
from armscope.recordings import Recordings
from armscope.robot import Arm, position_jacobian


@dataclass(frozen=True, eq=False)
class FittedTurns:
    """Columns fitted beside a plain arm's errors."""

    values: Array  # (c,) of the columns
    stderrs: Array  # (c,) of the values
    left: float  # mean square of what is left, m^2
    before: float  # the same without the columns
    free: int  # how many numbers are free


class PlainErrors:
    """What base and tool leave of rows, and what a plain arm's errors do there.

    Args:
        arm: the nominal arm.
        recordings: N rows.
        state: base and tool as fitted to them.
    """

    def __init__(self, arm: Arm, recordings: Recordings, state: State) -> None:
        rows = set_up(arm, replace(recordings, orientation=None))
        posed = rows.posed(state)
        self._left, columns = posed.left.ravel(), rows.jacobian(state, posed, rows.free("compliance"))
        self._turned = position_jacobian(arm, posed.frames)
        beside = np.hstack([columns, drive_columns(arm, posed, recordings.motor_angles)])
        spanned, size, _ = np.linalg.svd(
            beside / np.maximum(np.linalg.norm(beside, axis=0), 1e-300), full_matrices=False
        )
        self._spanned = spanned[:, size > PLAIN.rank * size[0]]

    def with_turns(self, motors: Indices, angles: Array) -> FittedTurns | None:
        """Motors that turn by something else as well: by how much of it.

        Args:
            motors: (c,) from 0.
            angles: (N, c) rad per unit, of each.

        Returns:
            Values of the c; None where rows are too few, or don't tell them apart.
        """
        own = (self._turned[:, :, motors] * angles[:, None, :]).reshape(len(self._left), -1)
        free = len(self._left) - self._spanned.shape[1] - own.shape[1]
        if not own.shape[1] or free <= own.shape[1]:
            return None
        whole = np.linalg.norm(own, axis=0)
        left, own = (each - self._spanned @ (self._spanned.T @ each) for each in (self._left, own))
        squares = own.T @ own
        hidden = bool(np.any(PLAIN.apart * squares.diagonal() < whole**2))
        if hidden or np.linalg.cond(squares) > PLAIN.apart:
            return None
        found = np.linalg.solve(squares, own.T @ left)
        variance = float(np.sum((left - own @ found) ** 2)) / free
        stderrs = np.sqrt(variance * np.diag(np.linalg.inv(squares)))
        return FittedTurns(found, stderrs, variance, float(np.sum(left**2)) / (free + own.shape[1]), free)


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
