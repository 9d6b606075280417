"""In which directions a joint of a URDF may be off: there are no D-H rows that say all with four numbers."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.physics.effect import AXES
from armscope.robot import Arm
from armscope.robot.urdf_writing import axes_told

ROUNDING = 1e-9
"""Of a lever, m: below it two axes are one."""


def directions_of_a_joint(arm: Arm, j: int) -> dict[str, Array]:
    """Directions of joint j's frame (1-based) in which it may be off, by axis of the file (`axes_told`).

    All but the turn about its own axis, and but for what the zero of the joint before does, too: so zeros are told as
    zeros, as by D-H rows. With all of them, zeros of parallel joints were told as shifts, or as nothing in particular.

    Args:
        arm: the nominal arm, from a URDF.
        j: 1-based.

    Returns:
        By name, of `AXES`: (6,) the twist in the joint's frame, m and rad.
    """
    turn = axes_told(arm)[j - 1, :3, :3].T
    own = int(np.argmax(np.abs(turn[:, 2])))
    said = {AXES[3 + own], _said_by_the_zero_before(arm, j, turn, own)}
    units = zip(AXES, np.kron(np.eye(2), turn), strict=True)
    return {axis: unit for axis, unit in units if axis not in said}


def _said_by_the_zero_before(arm: Arm, j: int, told: Array, own: int) -> str:
    """The direction of joint j's frame in which the zero of the joint before moves it most; none of the first joint's.

    Across axes that is a tilt. Along parallel ones, or nearly, it is a shift: a link whose far end lies to one side is
    a link that is turned, and the joint at that end turned back. Measured in tolerances, of a millimetre and a
    milliradian.

    Args:
        arm: the nominal arm, from a URDF.
        j: 1-based.
        told: (3, 3) the directions that are told, in the joint's frame.
        own: which of them is its own axis.

    Returns:
        One of `AXES`, or nothing.
    """
    if j == 1:
        return ""
    axis, lever = arm.before[j - 1][2, :3], arm.before[j - 1][:3, :3].T @ arm.before[j - 1][:3, 3]
    moved = np.abs(np.array([told @ np.cross(axis, lever), told @ axis]))  # mm and mrad per mrad: their tolerances
    moved[:, own] = 0.0
    return AXES[int(np.argmax(moved))] if moved.max() > ROUNDING else ""
