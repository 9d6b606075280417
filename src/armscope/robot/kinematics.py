"""Where the frames of an arm stand, for many poses at once, with or without a small twist at any of them.

The one forward model: ``tool = exp(base) * prod_j [before_j * exp(joint j) * Rz(theta_j) * ... exp(link j)] * tool``.
A twist is (translation m, rotation rad) in the axes of the frame it acts at; exp(v, w) = Trans(v) Rot(w).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from armscope.core.location import Location
from armscope.core.rotations import cross, turned_by
from armscope.core.types import Array
from armscope.robot.arm import Arm
from armscope.robot.constants import SEARCH

Twists = Mapping[str, Array]


@dataclass(frozen=True, eq=False)
class Chain:
    """Frames of an arm at N poses, all expressed in the base frame (rotations (.., 3, 3), origins m)."""

    joint_rotation: Array  # (N, n, 3, 3) frame of joint j before it turns; column z is its axis
    joint_origin: Array  # (N, n, 3) frame of joint j before it turns; column z is its axis
    link_rotation: Array  # (N, n, 3, 3) link frame j: D-H frame j, which moves with joint j
    link_origin: Array  # (N, n, 3) link frame j: D-H frame j, which moves with joint j
    tool_rotation: Array  # (N, 3, 3) orientation of the last frame
    tool: Array  # (N, 3) the tool point

    def frame(self, location: str) -> tuple[Array, Array]:
        """Rotation (N, 3, 3) and origin (N, 3) of the frame at "base", "joint j", "link j" or "tool"."""
        place = Location.of(location)
        if place.kind == "joint":
            return self.joint_rotation[:, place.index], self.joint_origin[:, place.index]
        if place.kind == "link":
            return self.link_rotation[:, place.index], self.link_origin[:, place.index]
        if place.kind == "tool":
            return self.tool_rotation, self.tool
        return np.broadcast_to(np.eye(3), self.tool_rotation.shape), np.zeros_like(self.tool)


def chain(arm: Arm, motor_angles: Array, twists: Twists | None = None) -> Chain:
    """Frames of the arm at ``motor_angles`` (N, m) rad.

    Args:
        arm: the arm.
        motor_angles: (N, m) rad.
        twists: small twists by location ("base", "joint j", "link j", "tool"), each (6,) or (N, 6).

    Returns:
        Rotations and origins of every joint's and link's frame, and the tool point, in the base frame, m.
    """
    twists = twists or {}
    angles = np.atleast_2d(motor_angles) @ arm.actuation.T
    n_poses, n_joints = angles.shape
    joint_rotation = np.empty((n_poses, n_joints, 3, 3))
    joint_origin = np.empty((n_poses, n_joints, 3))
    link_rotation, link_origin = np.empty_like(joint_rotation), np.empty_like(joint_origin)
    cosines, sines = np.cos(angles), np.sin(angles)
    rotation = np.tile(np.eye(3), (n_poses, 1, 1))
    origin = np.zeros((n_poses, 3))
    rotation, origin = _twisted(rotation, origin, twists.get("base"))
    for j in range(n_joints):
        rotation, origin = _moved(rotation, origin, arm.before[j])
        rotation, origin = _twisted(rotation, origin, twists.get(f"joint {j + 1}"))
        joint_rotation[:, j], joint_origin[:, j] = rotation, origin
        rotation = _turned(rotation, cosines[:, j], sines[:, j])
        link = twists.get(f"link {j + 1}")
        link_rotation[:, j], link_origin[:, j] = _moved(rotation, origin, arm.behind[j])
        if link is not None:
            link_rotation[:, j], link_origin[:, j] = _twisted(link_rotation[:, j], link_origin[:, j], link)
            rotation, origin = _moved(link_rotation[:, j], link_origin[:, j], _inverse(arm.behind[j]))
    rotation, origin = _moved(rotation, origin, arm.tip)
    tool = origin + rotation @ arm.tool
    rotation, tool = _twisted(rotation, tool, twists.get("tool"))
    return Chain(joint_rotation, joint_origin, link_rotation, link_origin, rotation, tool)


def tool_frames(arm: Arm, motor_angles: Array) -> tuple[Array, Array]:
    """Tool points and orientations alone, at any number of poses: all frames of some of them at a time.

    Args:
        motor_angles: (N, m) rad.

    Returns:
        (N, 3) m and (N, 3, 3), in the base frame.
    """
    points, rotations = np.empty((len(motor_angles), 3)), np.empty((len(motor_angles), 3, 3))
    for start in range(0, len(motor_angles), SEARCH.rows_at_a_time):
        at = slice(start, start + SEARCH.rows_at_a_time)
        frames = chain(arm, motor_angles[at])
        points[at], rotations[at] = frames.tool, frames.tool_rotation
    return points, rotations


def forward_kinematics(arm: Arm, motor_angles: Array, twists: Twists | None = None) -> Array:
    """Tool points (N, 3), m, in the base frame, at motor angles (N, m) rad.

    Args:
        arm: the arm.
        motor_angles: (N, m) rad.
        twists: small twists by location, m and rad, as for `chain`.

    Returns:
        (N, 3) tool points in the base frame, m.
    """
    return chain(arm, motor_angles, twists).tool


def twist_jacobian(frames: Chain, location: str) -> Array:
    """(N, 3, 6) displacement of the tool point, in base axes, by a unit twist in the axes of the frame at ``location``.

    The three translations move the tool by the frame's axes, the three rotations by axis x (tool - origin).
    """
    rotation, origin = frames.frame(location)
    jacobian = np.empty((len(origin), 3, 6))
    jacobian[..., :3] = rotation
    x, y, z = (frames.tool - origin).T[..., None]  # each (N, 1): axis x lever, written out, is several times faster
    jacobian[:, 0, 3:] = rotation[:, 1] * z - rotation[:, 2] * y
    jacobian[:, 1, 3:] = rotation[:, 2] * x - rotation[:, 0] * z
    jacobian[:, 2, 3:] = rotation[:, 0] * y - rotation[:, 1] * x
    return jacobian


def turn_jacobian(frames: Chain, location: str) -> Array:
    """(N, 3, 6) turn of the tool, in base axes, by a unit twist in the axes of the frame at ``location``."""
    jacobian = np.zeros((len(frames.tool), 3, 6))
    jacobian[..., 3:] = frames.frame(location)[0]
    return jacobian


def joint_axes(frames: Chain) -> Array:
    """(N, 3, n) axes of the chain's joints in base axes: the turn of the tool by unit turns of the joints."""
    return np.swapaxes(frames.joint_rotation[..., 2], 1, 2)


def joint_jacobian(frames: Chain) -> Array:
    """(N, 3, n) displacement of the tool point by unit turns of the chain's joints, m/rad, in base axes."""
    axes = frames.joint_rotation[..., 2]
    lever = frames.tool[:, None, :] - frames.joint_origin
    return np.swapaxes(cross(axes, lever), 1, 2)


def position_jacobian(arm: Arm, frames: Chain) -> Array:
    """(N, 3, m) displacement of the tool point by unit turns of the motors, m/rad, in base axes."""
    return joint_jacobian(frames) @ arm.actuation


_STAYS = np.eye(4)


def _moved(rotation: Array, origin: Array, fixed: Array) -> tuple[Array, Array]:
    """Frames (N) times one fixed homogeneous transform; flat products are several times faster than N small ones."""
    if np.array_equal(fixed, _STAYS):
        return rotation, origin
    flat = rotation.reshape(-1, 3)
    moved = (flat @ fixed[:3, :3]).reshape(rotation.shape)
    return moved, origin + (flat @ fixed[:3, 3]).reshape(-1, 3)


def _turned(rotation: Array, cosine: Array, sine: Array) -> Array:
    """Frames (N) turned about their own z."""
    turned = rotation.copy()
    c, s = cosine[:, None], sine[:, None]
    turned[..., 0] = c * rotation[..., 0] + s * rotation[..., 1]
    turned[..., 1] = c * rotation[..., 1] - s * rotation[..., 0]
    return turned


def _twisted(rotation: Array, origin: Array, twist: Array | None) -> tuple[Array, Array]:
    """Frames (N) times Trans(v) Rot(w)."""
    if twist is None:
        return rotation, origin
    twist = np.asarray(twist, dtype=float)
    shifted = origin + (rotation @ twist[..., :3, None])[..., 0]
    return rotation @ turned_by(twist[..., 3:]), shifted


def _inverse(fixed: Array) -> Array:
    inverse = np.eye(4)
    inverse[:3, :3] = fixed[:3, :3].T
    inverse[:3, 3] = -fixed[:3, :3].T @ fixed[:3, 3]
    return inverse


def centre_lines(arm: Arm, frames: Chain) -> list[tuple[str, Array]]:
    """(location, (N, K, 3) points, m, base axes) from the base to the tool: "base", "link 1", ..., "tool".

    Each link's line bends once, so that offsets along an axis and across it both show.
    """
    origins, axes = frames.joint_origin, frames.joint_rotation[..., 2]
    flange = frames.tool - frames.tool_rotation @ arm.tool
    zero, joints = np.zeros_like(flange), range(origins.shape[1])
    tool = np.stack([flange, frames.tool], axis=1)
    if arm.is_modified_dh:
        starts = np.concatenate([zero[:, None], origins[:, :-1]], axis=1)
        lines = [(f"link {j + 1}", _bent_before(starts[:, j], origins[:, j], axes[:, j])) for j in joints]
        return [*lines, ("tool", np.concatenate([origins[:, -1:], tool], axis=1))]
    ends = np.concatenate([origins[:, 1:], flange[:, None]], axis=1)
    lines = [(f"link {j + 1}", _bent_behind(origins[:, j], ends[:, j], axes[:, j])) for j in joints]
    return [("base", np.stack([zero, origins[:, 0]], axis=1)), *lines, ("tool", tool)]


def _bent_behind(start: Array, end: Array, axis: Array) -> Array:
    """First along the axis of the joint at the start."""
    return np.stack([start, start + axis * np.sum(axis * (end - start), axis=1, keepdims=True), end], axis=1)


def _bent_before(start: Array, end: Array, axis: Array) -> Array:
    """Last along the axis of the joint at the end."""
    return np.stack([start, end - axis * np.sum(axis * (end - start), axis=1, keepdims=True), end], axis=1)
