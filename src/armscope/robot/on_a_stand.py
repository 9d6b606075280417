"""An arm on a stand that may turn about level axes: the moment that this holds, and what its turning asks of joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from armscope.core.types import Array
from armscope.robot.dynamics import MovingArm, leaning_gravity


@dataclass(frozen=True, eq=False)
class OnAStand:
    """At N samples, of m joints; a and b are the two axes across gravity through the base's origin.

    Attributes:
        moment: (N, 2) N m about both that the stand gives to hold and move the arm.
        per_turning: (N, m, 2) N m of the motors per rad/s^2 of the base about both.
        per_turn: (N, m, 2) N m of the motors per rad by which the base leans about both.
    """

    moment: Array
    per_turning: Array
    per_turn: Array


def level_axes(gravity: Array) -> Array:
    """(2, 3) axes across gravity (3,), m/s^2: x and y where that points along z, or is none."""
    if not np.any(gravity):
        return np.eye(3)[:2]
    size = float(np.linalg.norm(gravity))
    return np.asarray(np.cross(-gravity / size, leaning_gravity(gravity) / size))


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
    moment, turning, lean = np.empty((len(q), 2)), np.empty((len(q), n, 2)), np.empty((len(q), n, 2))
    for row in range(len(q)):
        moment[row] = pin.rnea(model, data, stored[row], v[row], a[row])[:2]
        turning[row] = pin.crba(model, data, stored[row])[:2, 2:].T
        lean[row] = pin.computeGeneralizedGravityDerivatives(model, data, stored[row])[2:, :2]
    return OnAStand(moment, *(np.einsum("nke,km->nme", each, arm.actuation) for each in (turning, lean)))


def _turning(model: pin.Model, gravity: Array) -> pin.Model:
    """The model on two joints without mass that turn about the level axes."""
    base, at = pin.Model(), 0
    for number, axis in enumerate(level_axes(gravity)):
        at = base.addJoint(at, pin.JointModelRevoluteUnaligned(axis), pin.SE3.Identity(), f"stand {number}")
    base.addFrame(pin.Frame("stand", at, 0, pin.SE3.Identity(), pin.FrameType.OP_FRAME))
    whole = pin.appendModel(base, model, base.getFrameId("stand"), pin.SE3.Identity())
    whole.gravity.linear = gravity
    return whole
