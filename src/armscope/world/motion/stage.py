"""What laws and limits see: an arm with its ordinary friction, its motion, and the torques of its links alone.

An arm says of the numbers of what is concealed in it, at a joint or link from 0, whether a body can be so: masses stay
positive, friction resists.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.motion.mechanism import Dynamics, MovingArm
from armscope.world.motion.session import Session

Numbers = Mapping[str, float]
STANDSTILL = 2e-3  # rad/s: below it the sign of a speed counts as a share only, as in `STIFF_FRICTION`
POSES_APART = 500  # Samples between the poses that are looked at
WRONG_MASS, WRONG_CENTRE = 0.6, 0.1
"""How wrong a drawing may be: share of a link's mass, and of the arm's longest link for its centre."""
SLOWEST_SWING_HZ = 2.0  # A link that swings on its own drive more slowly is not driven along paths of seconds
ROUNDS = 2
"""Each takes up one more power of (frequency of the motion / that of the link on its drive)^2, a twentieth or less."""


@dataclass(frozen=True, eq=False)
class PlainArm:
    """An arm with its ordinary friction, before anything is concealed."""

    description: RobotDescription  # what robot.yaml says (all of it)
    dynamics: Dynamics
    session: Session
    sigma: Array  # (n,) noise of the recorded torques, N m
    # whether robot.yaml states friction and rotor inertia; else they are found, and absorb what is like them
    stated: bool

    def holds_its_link(self, joint: int, numbers: Numbers) -> bool:
        """Whether a drive that gives way is stiff enough to be driven, in every pose of the motion."""
        angle = self.session.angle[::POSES_APART]
        still, turning = np.zeros_like(angle), np.zeros_like(angle)
        turning[:, joint] = 1.0
        links = MovingArm(Geometry(self.description), self.dynamics.without_friction())
        inertia = (links.torques(angle, still, turning) - links.torques(angle, still, still))[:, joint]
        return bool(numbers["compliance"] * inertia.max() * (2 * np.pi * SLOWEST_SWING_HZ) ** 2 < 1)

    def mass_may_be(self, link: int, numbers: Numbers) -> bool:
        """Whether a link keeps a mass, not far from the drawing's."""
        return bool(abs(numbers["mass"]) < WRONG_MASS * self.dynamics.mass[link])

    def centre_may_be(self, link: int, numbers: Numbers) -> bool:
        """Whether a link's centre of mass is not far from the drawing's."""
        moved = np.linalg.norm([numbers[name] for name in ("mx", "my", "mz")]) / self.dynamics.mass[link]
        return bool(moved < WRONG_CENTRE * Geometry(self.description).rows[:, [0, 2]].max())

    def resists_when_warm(self, joint: int, numbers: Numbers) -> bool:
        """Whether friction resists at the warmest."""
        warmest = self.session.temperature.max() - self.session.temperature.min()
        return bool(self.dynamics.viscous[joint] + numbers["per_kelvin"] * warmest > 0)

    def resists_either_way(self, joint: int, numbers: Numbers) -> bool:
        """Whether friction resists in both directions."""
        return bool(abs(numbers["viscous_difference"]) < self.dynamics.viscous[joint])


@dataclass(frozen=True, eq=False)
class Stage:
    """What laws of friction see: the motion, and what gives (T, n) torques of the links alone for a motion, N m."""

    session: Session
    links: Callable[[Session], Array]

    @functools.cached_property
    def load(self) -> Array:
        """(T, n) torques of the links alone, N m."""
        return self.links(self.session)

    def wound_up(self, joint: int, numbers: Numbers) -> tuple[Array, Array]:
        """Where links lie beside their motors, (T, n) rad, and what they then ask of these, (T, n) N m.

        One link hangs behind a belt, a gear, a shaft that give way under its torque by their ``compliance``, rad/(N m):
        where it is hangs on its torque, and that on where it is. The angle that is recorded is the motor's.
        """
        shift, load = np.zeros_like(self.session.angle), self.load
        for _ in range(ROUNDS):
            shift[:, joint] = -numbers["compliance"] * load[:, joint]
            load = self.links(self.session.moved(shift))
        return shift, load

    def behind_its_drive(self, joint: int, numbers: Numbers) -> Array:
        """(T, n) N m, what all joints feel where a drive gives way."""
        return self.wound_up(joint, numbers)[1] - self.load


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
