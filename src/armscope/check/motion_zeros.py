"""Joints of a moving arm whose zeros are elsewhere by a quarter or half turn: what the masses' torque says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.check.motion_constants import MOTION
from armscope.check.motion_readings import Samples, beyond_friction
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.robot.dynamics import MovingArm
from armscope.verdict.wording import times


def moved_zeros(samples: Samples, arm: MovingArm) -> Iterator[tuple[int, float, Samples]]:
    """Every joint but the last, each turn by which its zero may be elsewhere, and the samples as they are then.

    Not the last joint: there, a load that is not stated looks like a zero.
    """
    for j in np.flatnonzero(~arm.sliding[:-1]).tolist():
        for turn in MOTION.turned:
            yield j, turn, replace(samples, q=samples.q + turn * (np.arange(arm.n_motors) == j))


def zeros_elsewhere(samples: Samples, arm: MovingArm) -> Iterator[Suspicion]:
    """Joints whose angles the masses' torque takes to be a quarter or half turn from where robot.yaml has them.

    As recorded, every torque may have either sign, or gravity point the other way: a zero elsewhere says more than
    these.

    Yields:
        The joint and the turn that say most, a problem where they say so much that nothing else would hold.
    """
    if len(samples.q) < MOTION.reading_samples or not np.any(arm.inertial):
        return
    few = samples.rows(spread_evenly(len(samples.q), MOTION.reading_rows))
    gravity = arm.gravity_torques(few.q, arm.model.gravity.linear)
    turned = [_left_by_masses(few, arm, -2 * gravity), _left_by_masses(few, arm, either_sign=True)]
    stated, tried = min(turned, key=lambda left: float(np.log(left).sum())), []
    for j, turn, moved in moved_zeros(few, arm):
        told = float(np.log(stated / _left_by_masses(moved, arm)).sum())
        tried.append((told, j, float(np.degrees(turn))))
    told, j, turn = max(tried, default=(0.0, 0, 0.0))
    if told > np.log(MOTION.other_zero):
        less = f"{times(float(np.exp(told)))} times less of all joints' torques"
        statement = f"with q{j + 1} {turn:+.0f} deg the stated masses leave {less}"
        cure = (
            f"Is the zero of joint {j + 1} that of robot.yaml (theta_offset_deg)? A load that is not stated, or an arm "
            "that stands otherwise, can look alike."
        )
        yield Suspicion("problem" if told > np.log(MOTION.no_other_zero) else "hint", statement, cure)


def _left_by_masses(samples: Samples, arm: MovingArm, more: Array | float = 0.0, either_sign: bool = False) -> Array:
    """(m,) share of each torque beyond friction that the stated masses leave.

    Args:
        more: (N, m) torque beside that of the masses.
        either_sign: whether a torque may have the sign opposite to theirs.
    """
    rigid = arm.torques(samples.q, samples.dq, samples.ddq, arm.inertial) + more
    left = []
    for recorded, asked in beyond_friction(samples, rigid):
        whole, along = max(float(recorded @ recorded), 1e-300), float(asked @ recorded)
        along = along if either_sign else max(along, 0.0)
        left.append(max(1 - along**2 / max(float(asked @ asked), 1e-300) / whole, MOTION.least_left))
    return np.array(left)
