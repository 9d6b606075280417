"""What laws and limits see: an arm with its ordinary friction, its motion, and the torques of its links alone."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import Dynamics, MovingArm
from armscope.world.motion.session import Session

STANDSTILL = 2e-3  # rad/s: below it the sign of a speed counts as a share only, as in `STIFF_FRICTION`


@dataclass(frozen=True, eq=False)
class PlainArm:
    """An arm with its ordinary friction, before anything is concealed."""

    description: RobotDescription  # what robot.yaml says (all of it)
    dynamics: Dynamics
    session: Session
    sigma: Array  # (n,) noise of the recorded torques, N m
    # whether robot.yaml states friction and rotor inertia; else they are found, and absorb what is like them
    stated: bool


@dataclass(frozen=True, eq=False)
class Stage:
    """What laws of friction see: the motion, and what gives (T, n) torques of the links alone for a motion, N m."""

    session: Session
    links: Callable[[Session], Array]

    @functools.cached_property
    def load(self) -> Array:
        """(T, n) torques of the links alone, N m."""
        return self.links(self.session)


def sign(session: Session, joint: int) -> Array:
    """(T,) of a joint's speed."""
    return np.tanh(session.speed[:, joint] / STANDSTILL)


def stage_of(geometry: Geometry, dynamics: Dynamics, session: Session) -> Stage:
    """What laws see of a motion.

    Args:
        geometry, dynamics: of the arm.
        session: the motion.

    Returns:
        The stage, with the torques of the links alone.
    """
    links = MovingArm(geometry, dynamics.without_friction())
    return Stage(session, lambda motion: links.torques(motion.angle, motion.speed, motion.acceleration))
