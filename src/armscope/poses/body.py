"""The arm's body as capsules: from the collision shapes of its URDF, or around the lines between its joints.

A collision shape counts as the capsule along the longest side of its bounding box. Links that have none, and what lies
between the last shape, the tip and the tool point, are capsules of one assumed radius around the centre line. Where a
URDF has no shapes (or meshes that are not there), and for D-H arms, all of the centre line is
(`armscope.robot.kinematics`).
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
from armscope.robot.description import RobotDescription
from armscope.robot.kinematics import centre_lines
from armscope.robot.urdf import cut, read_urdf


@dataclass(frozen=True, eq=False)
class Capsule:
    """A capsule at N poses: what it belongs to, its axis' ends (N, 3), m, and its radius, m.

    Pieces of one link, and pieces whose places differ by one, are neighbours: they share a joint.
    """

    link: int
    place: int
    name: str
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
    """The body at some poses: the shapes and what they leave out, or the centre line where there are no shapes.

    Args:
        arm: the arm.
        frames: its frames at N poses.
        shapes: capsules fixed to its links; none: the centre line stands for the body.
        radius: of the centre line and of the tool, m.

    Returns:
        Capsules with ends (N, 3) in the base frame, m; the shapes come first.
    """
    lines = centre_lines(arm, frames)
    if not shapes:
        return _along(lines, radius)
    turns = _axis_turns(arm)
    placed = []
    for shape in shapes:
        start, end = (_placed(point, shape.joint, frames, turns) for point in (shape.start, shape.end))
        placed.append(Capsule(shape.joint, shape.joint, _name(shape.joint), start, end, shape.radius))
    return [*placed, *_beside_shapes(placed, frames, lines[-1][1][:, -2], radius)]


def _name(joint: int) -> str:
    return f"link {joint}" if joint else "base"


def _along(lines: list[tuple[str, Array]], radius: float) -> list[Capsule]:
    """Pieces without length are points of their neighbours, which thereby share a joint."""
    found: list[Capsule] = []
    for link, (name, line) in enumerate(lines):
        for k, after in pairwise(range(line.shape[1])):
            if _has_length(line[:, k], line[:, after]):
                found.append(Capsule(link, len(found), name, line[:, k], line[:, after], radius))
    return found


def _beside_shapes(shapes: list[Capsule], frames: Chain, tip: Array, radius: float) -> list[Capsule]:
    """Links without a shape, and the way from the last link's shapes to its tip (N, 3), m, and on to the tool point."""
    origins = np.moveaxis(frames.joint_origin, 1, 0)
    points = [np.zeros_like(tip), *origins, tip]
    last = len(origins)
    found = []
    for joint, (start, end) in enumerate(pairwise(points)):
        own = [each for each in shapes if each.link == joint]
        if not own:
            found.append(Capsule(joint, joint, _name(joint), start, end, radius))
        elif joint == last:
            ways = [(each, _nearest(each, end)) for each in own]
            shape, start = min(ways, key=lambda way: _farthest(way[1], end) - way[0].radius)
            if _farthest(start, end) > shape.radius + BODY.point_m:  # else the tip lies within the shape
                found.append(Capsule(last, last + 1, "tool", start, end, radius))
    found.append(Capsule(last, last + 1, "tool", tip, frames.tool, radius))
    return [each for each in found if _has_length(each.start, each.end)]


def _nearest(capsule: Capsule, point: Array) -> Array:
    """(N, 3) of its axis, nearest to a point (N, 3), m."""
    along = capsule.end - capsule.start
    length2 = np.maximum(np.sum(along**2, axis=1, keepdims=True), BODY.no_length_m2)
    share = np.clip(np.sum((point - capsule.start) * along, axis=1, keepdims=True) / length2, 0, 1)
    nearest: Array = capsule.start + share * along
    return nearest


def _farthest(one: Array, other: Array) -> float:
    """Of two points (N, 3), m, in any pose; where no joint slides it is the same in all."""
    return float(np.linalg.norm(one - other, axis=1).max())


def _has_length(start: Array, end: Array) -> bool:
    return _farthest(start, end) > BODY.point_m


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
