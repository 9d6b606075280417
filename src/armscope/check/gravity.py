"""Gravity that points the wrong way in robot.yaml: joints would then give way against their load."""

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
    """Whether joints give way against the gravity that robot.yaml states, base, tool, geometry and drives being free.

    Args:
        arm: with link masses, else nothing is tried.
        recordings: some rows.
        state: base and tool as fitted to these rows.

    Returns:
        One hint, or none: controllers that make up for too much give the same picture.
    """
    rows = set_up(arm, replace(recordings, torque=None, orientation=None))
    if rows.loads is None or not np.any(rows.loads):
        return []
    posed, free = rows.posed(state), rows.free("compliance")
    left, columns = posed.left.ravel(), rows.jacobian(state, posed, free)
    giving = columns[:, -arm.n_motors :]
    geometry = np.hstack([columns[:, : -arm.n_motors], drive_columns(arm, posed, recordings.motor_angles)])
    spanned, size, _ = np.linalg.svd(geometry, full_matrices=False)
    spanned = spanned[:, size > WRONG_GRAVITY.left_of_column**2 * size[0]]
    beyond = giving - spanned @ (spanned.T @ giving)
    beyond = beyond[:, np.linalg.norm(beyond, axis=0) > WRONG_GRAVITY.left_of_column * np.linalg.norm(giving, axis=0)]
    left = left - spanned @ (spanned.T @ left)
    whole, along, against = float(left @ left), _squares_left(beyond, left), _squares_left(-beyond, left)
    numbers = len(left) - spanned.shape[1]
    if numbers <= arm.n_motors or not against < (1 - WRONG_GRAVITY.clear_share) * whole:
        return []
    gains = [0.5 * numbers * np.log(whole / max(each, np.finfo(float).tiny)) for each in (along, against)]
    if gains[1] < WRONG_GRAVITY.clear_nats or gains[0] > WRONG_GRAVITY.little * gains[1]:
        return []
    statement = (
        "joints seem to give way against gravity: with gravity_m_s2 turned around, joints that give way explain "
        f"{100 * (1 - against / whole):.0f} % of the squared error that geometry and drives leave, "
        f"as it is {100 * (1 - along / whole):.0f} %"
    )
    cure = (
        "gravity_m_s2 points the way things fall, in the base frame: [0, 0, -9.81] for an arm that stands upright, "
        "[0, 0, 9.81] for one that hangs."
    )
    return [Suspicion("hint", statement, cure, GRAVITY)]


def _squares_left(columns: Array, left: Array) -> float:
    """What coefficients that are not negative leave of the squares; the most negative ones are left out by turns."""
    while columns.shape[1]:
        coefficients = np.linalg.lstsq(columns, left, rcond=None)[0]
        if coefficients.min() >= 0:
            return float(np.sum((left - columns @ coefficients) ** 2))
        columns = np.delete(columns, int(np.argmin(coefficients * np.linalg.norm(columns, axis=0))), axis=1)
    return float(left @ left)
