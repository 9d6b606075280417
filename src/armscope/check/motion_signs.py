"""Sign and size of recorded torques beside what the stated masses and the joints' own motion ask for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from armscope.check.motion_channels import OF_MASSES, SIGN, Channels, turn
from armscope.check.motion_constants import MOTION
from armscope.check.motion_load import factors_of, is_of_another_size
from armscope.check.motion_readings import Samples
from armscope.check.suspicion import Suspicion
from armscope.core.sampling import spread_evenly
from armscope.robot.dynamics import MovingArm


def signs_and_sizes(samples: Samples, arm: MovingArm, of: Channels) -> Iterator[Suspicion]:
    """Sign and size of torques against what the stated masses ask for, with friction and a rotor fitted.

    Args:
        samples: differenced over a twentieth of a second.
        arm: as stated.
        of: the columns; of currents the sign alone is judged, as the size is their gain's.

    Yields:
        A problem for every sign that is turned, and what is far from the masses' torque.
    """
    few = samples.rows(spread_evenly(len(samples.q), MOTION.rows))
    rigid = arm.torques(few.q, few.dq, few.ddq, arm.inertial)
    factors = factors_of(few, rigid)
    most = float(np.median(np.abs(list(factors.values())))) if factors else 1.0
    for j, factor in factors.items():
        if factor < 0:
            yield Suspicion("problem", f"{of.names[j]} {SIGN} to {OF_MASSES}", _turned(arm, of))
        elif not of.currents and is_of_another_size(factor):
            yield _other_size(of.names[j], factor, most)


def _turned(arm: MovingArm, of: Channels) -> str:
    cure = turn(of.currents) if of.currents else f"Is it the load's torque? {turn(of.currents)}"
    if arm.model.gravity.linear[2] > 0:
        cure = f"gravity_m_s2 of robot.yaml points up: does the arm hang from a ceiling? If it does: {cure}"
    return cure


def _other_size(name: str, factor: float, most: float) -> Suspicion:
    # a load that nobody stated does that to a wrist, and is no mistake of the table
    far = not 1 / MOTION.no_load <= factor <= MOTION.no_load or not 1 / MOTION.no_load <= most <= MOTION.no_load
    weight: Literal["problem", "hint"] = (
        "problem" if far or not 1 / MOTION.other_size < most < MOTION.other_size else "hint"
    )
    cure = "Is it the torque before the gear, another unit, or another load than stated?"
    return Suspicion(weight, f"{name} is {factor:.3g} times what the stated masses ask for", cure)
