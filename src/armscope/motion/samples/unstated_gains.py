"""Torque constants that nobody states: what the stated masses ask for, of the joints whose current they explain."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.core.words import enumerated
from armscope.motion.samples.gain_constants import GAINS
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm


def gains_asked_for(arm: MovingArm, motions: Motions) -> dict[int, float]:
    """Torque per ampere at which the stated masses meet the recorded currents best, beside friction and a rotor.

    Args:
        arm: as stated.
        motions: currents.

    Returns:
        N m/A (N/A of a joint that slides) by motor, from 0, where masses explain most of what friction and rotor leave.
    """
    pieces = list(_differenced(motions))
    if not pieces or not np.any(arm.inertial):
        return {}
    q, dq, ddq, current = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
    few = spread_evenly(len(q), GAINS.samples)
    q, dq, ddq, current = q[few], dq[few], ddq[few], current[few]
    masses = arm.torques(q, dq, ddq, arm.inertial)
    found = {}
    for j in range(arm.n_motors):
        own = np.column_stack([np.ones(len(q)), np.sign(dq[:, j]), dq[:, j], ddq[:, j]])
        per_torque, left = _beside(own, masses[:, j], current[:, j])
        if per_torque and left < 1 - GAINS.told:
            found[j] = 1 / per_torque
    return found


def gains_in_words(arm: MovingArm, motions: Motions) -> str:
    """ "The stated masses ask for 11.3 (motor 2) N m/A; of motors 1 and 3 they tell nothing."."""
    asked = gains_asked_for(arm, motions)
    if not asked:
        return ""
    others = [str(j + 1) for j in range(arm.n_motors) if j not in asked]
    told = enumerated([f"{gain:.3g} (motor {j + 1})" for j, gain in asked.items()])
    silent = f"; of motor{'s' * (len(others) > 1)} {enumerated(others)} they tell nothing" if others else ""
    return f"The stated masses ask for gains of {told}{silent}."


def _differenced(motions: Motions) -> Iterator[tuple[Array, Array, Array, Array]]:
    """Of each run, far enough apart that positions can be differenced twice."""
    for run in motions.runs:
        rows = np.flatnonzero(motions.run == run)
        rows = rows[np.diff(motions.time[rows], prepend=-np.inf) > 0]
        apart = rows[:: max(int(GAINS.step_s / float(np.median(np.diff(motions.time[rows])))), 1)]
        if len(apart) < GAINS.rows:
            continue
        q, time = motions.q[apart], motions.time[apart]
        dq = np.gradient(q, time, axis=0)
        ddq = np.gradient(dq, time, axis=0)
        inside = slice(2, -2)
        yield q[inside], dq[inside], ddq[inside], motions.effort[apart][inside]


def _beside(own: Array, column: Array, values: Array) -> tuple[float, float]:
    """How much of a column there is in values beside a joint's own, and what share of the rest it leaves."""
    basis = np.linalg.qr(own)[0]
    column, values = (each - basis @ (basis.T @ each) for each in (column, values))
    size = float(column @ column)
    before = float(values @ values)
    if not size or not before:
        return 0.0, 1.0
    slope = float(column @ values) / size
    return slope, 1 - slope**2 * size / before
