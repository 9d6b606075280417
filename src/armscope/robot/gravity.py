"""Gravity loads: the force and moment that everything beyond a joint puts on it, and the motors' torques.

Loads are linear in masses and mass moments. The closed sum over the distal links is vectorised over poses;
pinocchio's recursive Newton-Euler algorithm and its torque regressor are its oracles in the tests.
"""

from __future__ import annotations

import numpy as np

from armscope.core.rotations import cross, cross_matrices
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
    masses = arm.masses if masses is None else masses
    beyond = _beyond(masses, 0)[:, None]
    lever = _beyond(masses[:, None] * _centres_of_mass(arm, frames), 1) - beyond * frames.joint_origin
    force, moment = np.broadcast_to(beyond * arm.gravity, lever.shape), lever @ cross_matrices(arm.gravity)
    if payload is None:
        return force, moment
    of_payload = weight_at_tool(arm, frames, np.nan_to_num(payload))
    return force + of_payload[0], moment + of_payload[1]


def weight_of_link(arm: Arm, frames: Chain, link: int) -> tuple[Array, Array]:
    """What the weight of one link alone adds to `gravity_wrenches`.

    Args:
        arm: the arm.
        frames: its frames at N poses.
        link: from 1.

    Returns:
        Force (n, 3), N, the same in all poses, and moment (N, n, 3), N m, in base axes at each joint's origin.
    """
    weight = arm.masses[link - 1] * arm.gravity
    force, moment = np.zeros((arm.n_joints, 3)), np.zeros(frames.joint_origin.shape)
    force[:link] = weight
    at = slice(link - 1, link)
    moment[:, :link] = (_centres_of_mass(arm, frames, at) - frames.joint_origin[:, :link]) @ cross_matrices(weight)
    return force, moment


def weight_at_tool(arm: Arm, frames: Chain, payload: Array) -> tuple[Array, Array]:
    """What a point mass at the tool point alone adds to `gravity_wrenches`.

    Args:
        arm: the arm.
        frames: its frames at N poses.
        payload: (N,) kg.

    Returns:
        Force (N, 1, 3), N, the same on all joints, and moment (N, n, 3), N m, in base axes at each joint's origin.
    """
    load = payload[:, None, None]
    return load * arm.gravity, load * ((frames.tool[:, None] - frames.joint_origin) @ cross_matrices(arm.gravity))


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
        torque[:, : link + 1, link, 0] = np.sum(axes[:, : link + 1] * cross(lever, arm.gravity), axis=2)
        by_moment = cross(np.swapaxes(turned[:, link], 1, 2), arm.gravity)
        torque[:, : link + 1, link, 1:] = np.einsum("nji,nki->njk", axes[:, : link + 1], by_moment)
    return np.asarray(np.einsum("njkp,jm->nmkp", torque, arm.actuation).reshape(n_poses, arm.n_motors, 4 * n_joints))


def _centres_of_mass(arm: Arm, frames: Chain, links: slice = slice(None)) -> Array:
    """(N, n, 3) of some links in base axes, m."""
    behind = arm.behind[links]
    in_link = np.einsum("jba,jb->ja", behind[:, :3, :3], arm.centres[links] - behind[:, :3, 3])
    rotation = frames.link_rotation[:, links]
    # axis by axis: several times faster than as many small products
    along = (rotation[..., axis] * in_link[:, axis, None] for axis in range(3))
    return np.asarray(frames.link_origin[:, links] + sum(along))


def _beyond(per_link: Array, axis: int) -> Array:
    """Sum over the links, which stand along an axis, from each joint to the tip."""
    return np.flip(np.cumsum(np.flip(per_link, axis), axis=axis), axis)
