"""Gains at which columns and fit meet: by how much more of each joint's torque is recorded than there is."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.motion.constants import PRIOR
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.sums import together
from armscope.motion.library.layout import TorqueLayout
from armscope.robot.dynamics import MovingArm


def torque_of(arm: MovingArm, stretch_effort: Array, kind: str) -> Array:
    """Motor torque from what was recorded.

    Args:
        arm: its gains.
        stretch_effort: (N, m) N m (N) or A.
        kind: "torque" or "current".

    Returns:
        (N, m) N m (N).
    """
    return stretch_effort * np.where(np.isnan(arm.gains), 1.0, arm.gains) if kind == "current" else stretch_effort


def gain_of(layout: TorqueLayout, coefficients: Array) -> Array:
    """(m,) times the true torque that is recorded of each joint."""
    gain = np.ones(layout.arm.n_motors)
    for joint, column in layout.scaling:
        gain[joint] += coefficients[column]
    return _that_a_drive_has(gain)


def meeting_gain(selected: SelectedCauses) -> Array:
    """(m,) at which the gain that columns are recorded by is the one that is fitted to them (Newton).

    Taking the fitted gain as it is swings ever farther where it falls by more than the columns' rises: where most of
    the true torque is no stated one, a load's or a delay's, a gain a little too large asks for one much too small.
    """
    rows = selected.rows
    fitted = gain_of(rows.layout, selected.coefficients)
    slopes = np.eye(len(fitted)) - _slopes(selected)
    return _that_a_drive_has(rows.gain + np.linalg.solve(slopes, fitted - rows.gain))


def _slopes(selected: SelectedCauses) -> Array:
    """(m, m) by how much each joint's fitted gain changes with the one that a joint's columns are recorded by.

    More of the true torque T of a joint in its columns is less of it left to fit: the fit moves by
    (X' X + prior)^-1 (T' residual - X' T c) per share.
    """
    rows, best, weights = selected.rows, selected.best, selected.weights
    layout, found = rows.layout, np.zeros((len(rows.gain),) * 2)
    scaling = [(joint, column) for joint, column in layout.scaling if column in best.columns]
    if not scaling:
        return found
    true = ~np.isin(best.columns, layout.of_readings)
    for joint in sorted({joint for joint, _ in scaling}):
        G, b = _sums_of(selected, joint)
        pull = true * (b - G @ best.mean) - G @ (true * best.mean)
        pull *= (PRIOR.unit / weights.sigma[joint]) ** 2 / weights.correlated[joint]
        moved = best.inverse.T @ (best.inverse @ pull) / rows.gain[joint] / selected.problem.scale[best.columns]
        for other, column in scaling:
            found[other, joint] += moved[best.at(np.array([column]))[0]]
    return found


def _sums_of(selected: SelectedCauses, joint: int) -> tuple[Array, Array]:
    """(C, C) and (C,) sums over one joint's rows of the columns that the best hypothesis uses, unit by unit."""
    rows, columns = selected.rows, selected.best.columns
    made, at = rows.layout.made_of_masses[0], rows.at[joint]
    combined = np.flatnonzero(np.isin(columns, made))
    order = [int(np.flatnonzero(made == column)[0]) for column in columns[combined]]
    plain = (at[:, None] == columns).astype(np.float64)
    G, b = np.zeros((len(columns),) * 2), np.zeros(len(columns))
    for part in together([part for block in selected.by_joint for part in block if part.joint == joint]):
        used = plain.copy()
        used[np.ix_(np.searchsorted(at, rows.layout.inertial), combined)] += rows.layout.shares_in(part.run)[:, order]
        used *= rows.gain_of_columns(joint)[:, None] / selected.problem.scale[columns]
        G += used.T @ part.sums.G @ used
        b += part.sums.b @ used
    return G, b


def _that_a_drive_has(gain: Array) -> Array:
    return np.clip(gain, 1 / PRIOR.largest_gain, PRIOR.largest_gain)
