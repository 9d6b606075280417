"""Gravity loads: the force and moment that everything beyond a joint puts on it, and the motors' torques.

Loads are linear in masses and mass moments. The closed sum over the distal links is vectorised over poses;
pinocchio's recursive Newton-Euler algorithm and its torque regressor are its oracles in the tests.
"""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.robot.arm import Arm
from armscope.robot.kinematics import Chain


def gravity_wrenches(
    arm: Arm, frames: Chain, payload: Array | None = None, masses: Array | None = None
) -> tuple[Array, Array]:
    """Force (N, n, 3) N and moment (N, n, 3) N m of gravity at each joint's origin, in base axes.

    Args:
        arm: the arm; a tool load counts with the last link.
        frames: its frames at N poses.
        payload: (N,) kg, a point mass at the tool point; None or NaN counts as none.
        masses: (n,) kg, of the links; the arm's own where not given.

    Returns:
        Force, N, and moment, N m, both (N, n, 3), in base axes at each joint's origin.
    """
    n_poses, n_joints = frames.joint_origin.shape[:2]
    masses = arm.masses if masses is None else masses
    weights = np.broadcast_to(masses[:, None] * arm.gravity, (n_poses, n_joints, 3))
    moments_about_base = np.cross(_centres_of_mass(arm, frames), weights)
    if payload is not None:
        load = np.nan_to_num(payload)[:, None] * arm.gravity
        weights = weights.copy()
        weights[:, -1] += load
        moments_about_base[:, -1] += np.cross(frames.tool, load)
    force, moment = _beyond(weights), _beyond(moments_about_base)
    return force, moment - np.cross(frames.joint_origin, force)


def gravity_torques(arm: Arm, frames: Chain, payload: Array | None = None) -> Array:
    """(N, m) torque of gravity on each motor, N m, positive along its angle: virtual work through `actuation`.

    Args:
        arm: the arm; a tool load counts with the last link.
        frames: its frames at N poses.
        payload: (N,) kg, a point mass at the tool point; None or NaN counts as none.

    Returns:
        (N, m) torques, N m.
    """
    _, moment = gravity_wrenches(arm, frames, payload)
    return np.asarray(np.einsum("nji,nji->nj", frames.joint_rotation[..., 2], moment) @ arm.actuation)


def mass_moment_regressor(arm: Arm, frames: Chain) -> Array:
    """(N, m, 4 n) torque of gravity on each motor per unit (mass, mass moment x, y, z) of each link.

    Mass moments are about the joint's origin in the joint's turned axes, as in pinocchio's inertial parameters
    (kg, kg m): the static part of its joint torque regressor.
    """
    n_poses, n_joints = frames.joint_origin.shape[:2]
    turned = frames.link_rotation @ np.swapaxes(arm.behind[:, :3, :3], 1, 2)
    axes = frames.joint_rotation[..., 2]
    torque = np.zeros((n_poses, n_joints, n_joints, 4))
    for link in range(n_joints):
        # torque on joint j = axis_j . (sum over the link's mass of (r - origin_j) x g)
        lever = frames.joint_origin[:, link, None, :] - frames.joint_origin[:, : link + 1]
        torque[:, : link + 1, link, 0] = np.sum(axes[:, : link + 1] * np.cross(lever, arm.gravity), axis=2)
        by_moment = np.cross(np.swapaxes(turned[:, link], 1, 2), arm.gravity)
        torque[:, : link + 1, link, 1:] = np.einsum("nji,nki->njk", axes[:, : link + 1], by_moment)
    return np.asarray(np.einsum("njkp,jm->nmkp", torque, arm.actuation).reshape(n_poses, arm.n_motors, 4 * n_joints))


def _centres_of_mass(arm: Arm, frames: Chain) -> Array:
    """(N, n, 3) in base axes, m."""
    behind_inverse = np.swapaxes(arm.behind[:, :3, :3], 1, 2)
    in_link = np.einsum("jab,jb->ja", behind_inverse, arm.centres - arm.behind[:, :3, 3])
    return np.asarray(frames.link_origin + np.einsum("njab,jb->nja", frames.link_rotation, in_link))


def _beyond(per_link: Array) -> Array:
    """Sum over the links from each joint to the tip."""
    return np.cumsum(per_link[:, ::-1], axis=1)[:, ::-1]
