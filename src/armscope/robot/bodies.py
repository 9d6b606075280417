"""Links with what they carry, on any motion: their torques, and how these change with the motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.robot.dynamics import MovingArm
from armscope.robot.on_a_stand import OnAStand, on_a_stand


@dataclass(frozen=True, eq=False)
class Bodies:
    """An arm's links with what they carry at each of N samples."""

    arm: MovingArm
    inertial: Array  # (10 n,) inertial parameters of the links
    payload: Array | None  # (N,) kg at the tool point, or None

    def among(self, some: slice) -> Bodies:
        """With what they carry at some of the samples."""
        return self if self.payload is None else replace(self, payload=self.payload[some])

    def torques(self, q: Array, dq: Array, ddq: Array) -> Array:
        """What they ask of the motors.

        Args:
            q: (N, m) motor positions.
            dq: (N, m) their velocities.
            ddq: (N, m) their accelerations.

        Returns:
            (N, m) N m.
        """
        found = np.empty(q.shape)
        for rows, inertial in self._loads(len(q)):
            found[rows] = self.arm.torques(q[rows], dq[rows], ddq[rows], inertial)
        return found

    def held(self, q: Array, gravity: Array) -> Array:
        """(N, m) N m that hold them at rest at motor positions (N, m), under a gravity (3,), m/s^2."""
        found = np.empty(q.shape)
        for rows, inertial in self._loads(len(q)):
            found[rows] = self.arm.gravity_torques(q[rows], gravity, inertial)
        return found

    def slopes(self, q: Array, dq: Array, ddq: Array) -> tuple[Array, Array, Array]:
        """How that changes with the motion.

        Args:
            q: (N, m) motor positions.
            dq: (N, m) their velocities.
            ddq: (N, m) their accelerations.

        Returns:
            As `slopes`.
        """
        if self.payload is None:
            return slopes(self.arm, (q, dq, ddq), self.inertial)
        m = q.shape[1]
        found = np.empty((len(q), m, m)), np.empty((len(q), m, m)), np.empty((len(q), m, m))
        for rows, inertial in self._loads(len(q)):
            for whole, part in zip(found, slopes(self.arm, (q[rows], dq[rows], ddq[rows]), inertial), strict=True):
                whole[rows] = part
        return found

    def on_a_stand(self, q: Array, dq: Array, ddq: Array) -> OnAStand:
        """What a stand feels of the motion, and what the joints would feel of the stand's.

        Args:
            q: (N, m) motor positions.
            dq: (N, m) their velocities.
            ddq: (N, m) their accelerations.

        Returns:
            Both.
        """
        found = OnAStand(np.empty((len(q), 2)), *(np.empty((*q.shape, 2)) for _ in range(3)))
        for rows, inertial in self._loads(len(q)):
            some = on_a_stand(self.arm, (q[rows], dq[rows], ddq[rows]), inertial)
            for whole, part in zip(vars(found).values(), vars(some).values(), strict=True):
                whole[rows] = part
        return found

    def _loads(self, count: int) -> Iterator[tuple[NDArray[np.bool_], Array]]:
        """Which samples carry the same, and the inertial parameters with that."""
        payload = np.zeros(count) if self.payload is None else self.payload
        for load in np.unique(payload):
            yield payload == load, self.inertial + load * self.arm.point_load() if load else self.inertial


def slopes(arm: MovingArm, motion: tuple[Array, Array, Array], inertial: Array) -> tuple[Array, Array, Array]:
    """How torques change with the motion (Carpentier & Mansard 2018).

    Args:
        arm: the arm.
        motion: (N, m) motor positions, velocities, accelerations.
        inertial: (10 n,) of each link, `PARAMETERS`; of a link whose mass is not positive the stated ones count.

    Returns:
        (N, m, m) N m of each motor per unit of each one's position, velocity and acceleration.
    """
    model, (q, dq, ddq) = arm.with_masses(inertial), motion
    data, v, a = model.createData(), dq @ arm.actuation.T, ddq @ arm.actuation.T
    found = np.empty((3, len(q), arm.n_links, arm.n_links))
    for row, moved in enumerate(zip(arm.configurations(q), v, a, strict=True)):
        pin.computeRNEADerivatives(model, data, *moved)
        found[0, row], found[1, row], found[2, row] = data.dtau_dq, data.dtau_dv, data.M
    upper = np.triu(found[2])  # of a mass matrix pinocchio fills one half
    found[2] = upper + np.swapaxes(np.triu(upper, 1), 1, 2)
    by_q, by_v, by_a = np.einsum("knij,ip,jr->knpr", found, arm.actuation, arm.actuation, optimize=True)
    return by_q, by_v, by_a


def last_axis(arm: MovingArm) -> Array:
    """(3,) about which the last joint turns, in its own frame; zeros where it slides."""
    joint = arm.model.joints[arm.model.njoints - 1]
    data = joint.createData()
    joint.calc(data, pin.neutral(arm.model)[-joint.nq :])
    return np.asarray(data.S).ravel()[3:]
