"""How wrong an arm in motion can be without being absurd: masses stay positive, friction resists."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import MovingArm
from armscope.world.motion.stage import PlainArm

Numbers = Mapping[str, float]
POSES_APART = 500  # Samples between the poses that are looked at
WRONG_MASS, WRONG_CENTRE = 0.6, 0.1
"""How wrong a drawing may be: share of a link's mass, and of the arm's longest link for its centre."""


SLOWEST_SWING_HZ = 2.0  # A link that swings on its own drive more slowly is not driven along paths of seconds


def holds_its_link(arm: PlainArm, joint: int, numbers: Numbers) -> bool:
    """Whether a drive that gives way is stiff enough to be driven, in every pose of the motion.

    Args:
        arm: the arm.
        joint: from 0.
        numbers: of what is concealed there.

    Returns:
        Whether a drive can be so.
    """
    angle = arm.session.angle[::POSES_APART]
    still, turning = np.zeros_like(angle), np.zeros_like(angle)
    turning[:, joint] = 1.0
    links = MovingArm(Geometry(arm.description), arm.dynamics.without_friction())
    inertia = (links.torques(angle, still, turning) - links.torques(angle, still, still))[:, joint]
    return bool(numbers["compliance"] * inertia.max() * (2 * np.pi * SLOWEST_SWING_HZ) ** 2 < 1)


def mass_may_be(arm: PlainArm, link: int, numbers: Numbers) -> bool:
    """Whether a link keeps a mass, not far from the drawing's.

    Args:
        arm: the arm.
        link: from 0.
        numbers: of what is concealed there.

    Returns:
        Whether a body can be so.
    """
    return bool(abs(numbers["mass"]) < WRONG_MASS * arm.dynamics.mass[link])


def centre_may_be(arm: PlainArm, link: int, numbers: Numbers) -> bool:
    """Whether a link's centre of mass is not far from the drawing's.

    Args:
        arm: the arm.
        link: from 0.
        numbers: of what is concealed there.

    Returns:
        Whether a body can be so.
    """
    moved = np.linalg.norm([numbers[name] for name in ("mx", "my", "mz")]) / arm.dynamics.mass[link]
    return bool(moved < WRONG_CENTRE * Geometry(arm.description).rows[:, [0, 2]].max())


def resists_when_warm(arm: PlainArm, joint: int, numbers: Numbers) -> bool:
    """Whether friction resists at the warmest.

    Args:
        arm: the arm.
        joint: from 0.
        numbers: of what is concealed there.

    Returns:
        Whether a body can be so.
    """
    warmest = arm.session.temperature.max() - arm.session.temperature.min()
    return bool(arm.dynamics.viscous[joint] + numbers["per_kelvin"] * warmest > 0)


def resists_either_way(arm: PlainArm, joint: int, numbers: Numbers) -> bool:
    """Whether friction resists in both directions.

    Args:
        arm: the arm.
        joint: from 0.
        numbers: of what is concealed there.

    Returns:
        Whether a body can be so.
    """
    return bool(abs(numbers["viscous_difference"]) < arm.dynamics.viscous[joint])
