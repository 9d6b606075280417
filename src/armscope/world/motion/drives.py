"""Drives that give way: where the link is hangs on its torque, and that on where it is."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.world.motion.limits import Numbers
from armscope.world.motion.stage import Stage

ROUNDS = 2
"""Each takes up one more power of (frequency of the motion / that of the link on its drive)^2, a twentieth or less."""


def behind_its_drive(stage: Stage, joint: int, numbers: Numbers) -> Array:
    """What all joints feel where one link hangs behind a belt, a gear, a shaft that give way under its torque.

    The angle that is recorded is the motor's.

    Args:
        stage: the motion, and the torques of the links.
        joint: whose drive gives way, from 0.
        numbers: its ``compliance``, rad/(N m).

    Returns:
        (T, n) N m.
    """
    return wound_up(stage, joint, numbers)[1] - stage.load


def wound_up(stage: Stage, joint: int, numbers: Numbers) -> tuple[Array, Array]:
    """Where links lie beside their motors, and what they then ask of these.

    Args:
        stage, joint, numbers: as of `behind_its_drive`.

    Returns:
        (T, n) rad, (T, n) N m.
    """
    shift, load = np.zeros_like(stage.session.angle), stage.load
    for _ in range(ROUNDS):
        shift[:, joint] = -numbers["compliance"] * load[:, joint]
        load = stage.links(stage.session.moved(shift))
    return shift, load
