"""Where the links run: a line through each, taken from the kinematics alone."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.robot.arm import Arm
from armscope.robot.kinematics import Chain


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
