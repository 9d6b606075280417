"""The arm's body as capsules: from the collision shapes of its URDF, or around the lines between its joints.

A collision shape counts as the capsule along the longest side of its bounding box. Where a URDF has none (or meshes
that are not there), and for D-H arms, each piece of the centre line (`armscope.robot.centre_line`) is a capsule of one
assumed radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pinocchio as pin

from armscope.core.types import Array
from armscope.poses.constants import BODY
from armscope.robot import Arm, Chain, chain
from armscope.robot.centre_line import centre_lines
from armscope.robot.description import RobotDescription
from armscope.robot.urdf import cut, read_urdf


@dataclass(frozen=True, eq=False)
class Capsule:
    """A capsule at N poses: what it belongs to, its axis' ends (N, 3), m, and its radius, m.

    Pieces of one link, and pieces whose places differ by one, are neighbours.
    """

    link: int
    place: int
    start: Array
    end: Array
    radius: float


@dataclass(frozen=True, eq=False)
class Shape:
    """A capsule fixed to a joint's turned frame of the pinocchio model (0: the base): axis' ends and radius, m."""

    joint: int
    start: Array
    end: Array
    radius: float


def pieces(arm: Arm, frames: Chain, shapes: list[Shape], radius: float) -> list[Capsule]:
    """The body at some poses: the shapes and the tool, or the centre line where there are no shapes.

    Args:
        arm: the arm.
        frames: its frames at N poses.
        shapes: capsules fixed to its links; none: the centre line stands for the body.
        radius: of the centre line and of the tool, m.

    Returns:
        Capsules with ends (N, 3) in the base frame, m.
    """
    lines = centre_lines(arm, frames)
    if not shapes:
        return _along(lines, radius)
    turns = _axis_turns(arm)
    placed = []
    for shape in shapes:
        start, end = (_placed(point, shape.joint, frames, turns) for point in (shape.start, shape.end))
        placed.append(Capsule(shape.joint, shape.joint, start, end, shape.radius))
    tool = [Capsule(each.link, arm.n_joints + 1, each.start, each.end, radius) for each in _along(lines[-1:], radius)]
    return [*placed, *tool]


def _along(lines: list[tuple[str, Array]], radius: float) -> list[Capsule]:
    found: list[Capsule] = []
    for link, (_, line) in enumerate(lines):
        for k, after in pairwise(range(line.shape[1])):
            length = np.linalg.norm(line[0, after] - line[0, k])  # the same in all poses
            if length > BODY.shortest * radius:
                found.append(Capsule(link, len(found), line[:, k], line[:, after], radius))
    return found


def _placed(point: Array, joint: int, frames: Chain, turns: Array) -> Array:
    if joint == 0:
        return np.tile(point, (len(frames.tool), 1))
    placed: Array = frames.link_origin[:, joint - 1] + frames.link_rotation[:, joint - 1] @ (turns[joint - 1].T @ point)
    return placed


def _axis_turns(arm: Arm) -> Array:
    """(n, 3, 3) the arm's turned joint frames, whose z is the axis, seen from pinocchio's."""
    data = arm.model.createData()
    pin.forwardKinematics(arm.model, data, pin.neutral(arm.model))
    ours = chain(arm, np.zeros((1, arm.n_motors))).link_rotation[0]
    theirs = np.array([data.oMi[joint].rotation for joint in range(1, arm.model.njoints)])
    turns: Array = np.swapaxes(theirs, 1, 2) @ ours
    return turns


def collision_shapes(description: RobotDescription) -> list[Shape]:
    """The collision shapes of an arm's URDF; none for D-H arms, where there are none, or if meshes are missing."""
    if description.urdf is None:
        return []
    full = read_urdf(description.urdf)
    folders = [str(folder) for folder in Path(description.urdf).resolve().parents]
    try:
        geometry = pin.buildGeomFromUrdf(full, description.urdf, pin.GeometryType.COLLISION, package_dirs=folders)
    except (ValueError, RuntimeError):
        return []
    locked, configuration, _ = cut(description, full)
    _, reduced = pin.buildReducedModel(full, geometry, locked, configuration)
    return [_capsule(each) for each in reduced.geometryObjects]


def _capsule(geometry: pin.GeometryObject) -> Shape:
    """Along the longest side of the bounding box, as thick as the next longest."""
    geometry.geometry.computeLocalAABB()
    box = geometry.geometry.aabb_local
    low, high = np.array(box.min_), np.array(box.max_)
    half, middle = (high - low) / 2, (high + low) / 2
    order = np.argsort(half)
    radius = float(half[order[1]])
    along = np.eye(3)[order[2]] * (half[order[2]] - radius)
    to_joint = geometry.placement
    ends = [np.asarray(to_joint.rotation @ (middle + sign * along) + to_joint.translation) for sign in (-1, 1)]
    return Shape(int(geometry.parentJoint), ends[0], ends[1], radius)
