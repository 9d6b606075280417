"""An arm on a stand that may turn about axes of its plate: what this holds, and what its turning asks of joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from armscope.core.types import Array
from armscope.robot.dynamics import MovingArm


@dataclass(frozen=True, eq=False)
class OnAStand:
    """At N samples, of m joints; about x and y of the base, which lie in its plate, through its origin."""

    moment: Array  # (N, 2) N m about both that the stand gives to hold and move the arm
    per_turning: Array  # (N, m, 2) N m of the motors per rad/s^2 of the base about both
    per_speed: Array  # (N, m, 2) N m of the motors per rad/s of the base about both
    per_turn: Array  # (N, m, 2) N m of the motors per rad by which the base leans about both


def on_a_stand(arm: MovingArm, motion: tuple[Array, Array, Array], inertial: Array) -> OnAStand:
    """What a stand feels of a motion, and what the joints would feel of the stand's.

    Args:
        arm: the arm.
        motion: (N, m) motor positions, velocities, accelerations.
        inertial: (10 n,) of each link, `PARAMETERS`; of a link whose mass is not positive the stated ones count.

    Returns:
        Both, N samples.
    """
    model, (q, dq, ddq) = _turning(arm.with_masses(inertial), arm.model.gravity.linear), motion
    still = np.zeros((len(q), 2))
    stored = np.column_stack([still, arm.configurations(q)])
    v, a = (np.column_stack([still, each @ arm.actuation.T]) for each in (dq, ddq))
    data, n = model.createData(), arm.n_links
    moment, felt = np.empty((len(q), 2)), np.empty((3, len(q), n, 2))
    for row in range(len(q)):
        pin.computeRNEADerivatives(model, data, stored[row], v[row], a[row])
        moment[row] = data.tau[:2]
        felt[0, row], felt[1, row], felt[2, row] = data.M[:2, 2:].T, data.dtau_dv[2:, :2], data.dtau_dq[2:, :2]
    return OnAStand(moment, *np.einsum("dnke,km->dnme", felt, arm.actuation))


def _turning(model: pin.Model, gravity: Array) -> pin.Model:
    """The model on two joints without mass that turn about the base's x and y."""
    base, at = pin.Model(), 0
    for number, axis in enumerate(np.eye(3)[:2]):
        at = base.addJoint(at, pin.JointModelRevoluteUnaligned(axis), pin.SE3.Identity(), f"stand {number}")
    base.addFrame(pin.Frame("stand", at, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    whole = pin.appendModel(base, model, base.getFrameId("stand"), pin.SE3.Identity())
    whole.gravity.linear = gravity
    return whole
