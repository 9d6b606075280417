"""Gravity that points another way than robot.yaml states: joints would then give way against their load, or beside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.calibration.model import set_up
from armscope.calibration.state import State
from armscope.check.constants import WRONG_GRAVITY
from armscope.check.plain_errors import drive_columns
from armscope.check.suspicion import GRAVITY, Suspicion
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import Arm


def gravity_mistake(arm: Arm, recordings: Recordings, state: State) -> list[Suspicion]:
    """Whether joints give way to another gravity than robot.yaml states, base, tool, geometry and drives being free.

    Args:
        arm: with link masses, else nothing is tried.
        recordings: some rows.
        state: base and tool as fitted to these rows.

    Returns:
        One hint, or none: controllers that make up for too much give the same picture as gravity turned around.
    """
    table = replace(recordings, torque=None, orientation=None)
    rows = set_up(arm, table)
    if rows.loads is None or not np.any(rows.loads):
        return []
    posed, free = rows.posed(state), rows.free("compliance")
    columns = rows.jacobian(state, posed, free)
    geometry = np.hstack([columns[:, : -arm.n_motors], drive_columns(arm, posed, recordings.motor_angles)])
    spanned, size, _ = np.linalg.svd(geometry, full_matrices=False)
    spanned = spanned[:, size > WRONG_GRAVITY.left_of_column**2 * size[0]]
    left = posed.left.ravel() - spanned @ (spanned.T @ posed.left.ravel())
    numbers = len(left) - spanned.shape[1]
    if numbers <= arm.n_motors:
        return []

    def explained(gravity: Array) -> float:
        """Share of the squares that joints explain which give way to a gravity."""
        giving = set_up(replace(arm, gravity=gravity), table).jacobian(state, posed, free)[:, -arm.n_motors :]
        beyond = giving - spanned @ (spanned.T @ giving)
        clear = np.linalg.norm(beyond, axis=0) > WRONG_GRAVITY.left_of_column * np.linalg.norm(giving, axis=0)
        return 1 - _squares_left(beyond[:, clear], left) / max(float(left @ left), np.finfo(float).tiny)

    ways = [arm.gravity, *_other_ways(arm.gravity)]
    shares = [explained(way) for way in ways]
    gains = [-0.5 * numbers * np.log(max(1 - share, np.finfo(float).tiny)) for share in shares]
    best = 1 + int(np.argmax(shares[1:]))
    least = WRONG_GRAVITY.clear_share if best == 1 else WRONG_GRAVITY.aside
    if shares[best] <= least or gains[best] < max(WRONG_GRAVITY.clear_nats, gains[0] / WRONG_GRAVITY.little):
        return []
    return [_told(ways[best], best == 1, shares[0], shares[best])]


def _other_ways(gravity: Array) -> list[Array]:
    """Gravity of the same size the other way, first, and along each axis of the base that it is not along as stated."""
    size = float(np.linalg.norm(gravity))
    along = [size * sign * axis for axis in np.eye(3) for sign in (1, -1)]
    others = [each for each in along if np.linalg.norm(each - gravity) > WRONG_GRAVITY.another * size]
    return [-gravity, *(each for each in others if np.linalg.norm(each + gravity) > WRONG_GRAVITY.another * size)]


def _told(best: Array, around: bool, stated: float, explained: float) -> Suspicion:
    """What joints give way to instead, and by how much that explains more."""
    wanted = ", ".join(f"{each + 0.0:.3g}" for each in best)
    seem = "against gravity" if around else "to gravity along another axis of the base"
    statement = (
        f"joints seem to give way {seem}: with gravity_m_s2 {'turned around' if around else f'[{wanted}]'}, joints "
        f"that give way explain {100 * explained:.0f} % of the squared error that geometry and drives leave, "
        f"as it is {100 * stated:.0f} %"
    )
    cure = (
        "gravity_m_s2 points the way things fall, in the base frame: [0, 0, -9.81] for an arm that stands upright, "
        "[0, 0, 9.81] for one that hangs."
    )
    wall = "" if around else " Is it mounted on a wall? `armscope diagnose --estimate-gravity` tells how it leans."
    return Suspicion("hint", statement, f"{cure}{wall}", GRAVITY)


def _squares_left(columns: Array, left: Array) -> float:
    """What coefficients that are not negative leave of the squares; the most negative ones are left out by turns."""
    while columns.shape[1]:
        coefficients = np.linalg.lstsq(columns, left, rcond=None)[0]
        if coefficients.min() >= 0:
            return float(np.sum((left - columns @ coefficients) ** 2))
        columns = np.delete(columns, int(np.argmin(coefficients * np.linalg.norm(columns, axis=0))), axis=1)
    return float(left @ left)
