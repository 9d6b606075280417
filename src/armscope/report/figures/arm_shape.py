"""The arm as a drawing needs it: where its links and joints lie in a recorded pose, and from where it is seen best."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.robot import Arm, Chain, chain
from armscope.robot.kinematics import centre_lines

MOST_POSES = 30  # So many recorded poses, spread evenly over the rows, are looked at when the pose to draw is chosen
AZIMUTHS = np.radians(np.arange(0, 360, 15))
ELEVATION = np.radians(18)
STATIONS = 24  # Points along the centre line at which it is seen whether the arm lies over itself
APART = 0.12  # Pieces of the arm that are farther apart than this share of the picture don't hide each other


@dataclass(frozen=True, eq=False)
class ArmShape:
    """An arm in one pose; base axes turned so that z points against gravity, m."""

    # (location, (K, 3) points of its centre line) from the base to the tool: "base", "link 1", ..., "tool"
    parts: tuple[tuple[str, Array], ...]
    centres: Array  # (n, 3) where each joint's disc is drawn: on its axis, moved along it where two would coincide
    axes: Array  # (n, 3) directions of the joints' axes
    tool: Array  # (3,) tool point
    # crank and rod of a parallelogram, (4, 3): shoulder, crank pin, rocker pin, elbow; None for other arms
    rod: Array | None
    to_world: Array  # (3, 3) turns base axes into the drawing's

    @property
    def points(self) -> Array:
        """(K, 3) all points of the centre line and the discs."""
        loose = [] if self.rod is None else [self.rod]
        return np.vstack([line for _, line in self.parts] + [self.centres, self.tool[None], *loose])


@dataclass(frozen=True, eq=False)
class View:
    """A parallel projection: where the picture's right, its upper edge and the viewer are (each (3,), unit length)."""

    right: Array
    up: Array
    towards: Array

    def flat(self, points: Array) -> Array:
        """(.., 2) picture coordinates of (.., 3) points."""
        return np.stack([points @ self.right, points @ self.up], axis=-1)

    def depth(self, points: Array) -> Array:
        """(..) how near to the viewer."""
        return points @ self.towards


def view_from(azimuth: float, elevation: float = ELEVATION) -> View:
    """Seen from a direction, angles in rad; z points up in the picture."""
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    return View(np.array([-sa, ca, 0.0]), np.array([-se * ca, -se * sa, ce]), np.array([ce * ca, ce * sa, se]))


def arm_shape(arm: Arm, motor_angles: Array) -> ArmShape:
    """The arm's shape at one pose, motor angles (m,) rad."""
    frames = chain(arm, np.reshape(motor_angles, (1, -1)))
    turn = upright(arm.gravity)
    axes = frames.joint_rotation[0, :, :, 2]
    parts = [(location, line[0]) for location, line in centre_lines(arm, frames)]
    rod = _linkage(arm, frames)
    return ArmShape(
        parts=tuple((location, line @ turn.T) for location, line in parts),
        centres=_disc_centres(frames.joint_origin[0], axes, [line for _, line in parts]) @ turn.T,
        axes=axes @ turn.T,
        tool=turn @ frames.tool[0],
        rod=None if rod is None else rod @ turn.T,
        to_world=turn,
    )


def typical_pose(arm: Arm, motor_angles: Array) -> tuple[int, View]:
    """The recorded row and the view in which the arm's joints lie farthest apart, and nothing over itself.

    Args:
        motor_angles: (N, m) rad.

    Returns:
        row number from 0, and the view.
    """
    rows = spread_evenly(len(motor_angles), MOST_POSES)
    shapes = [arm_shape(arm, motor_angles[row]) for row in rows]
    nodes = np.array([np.vstack([np.zeros(3), shape.centres, shape.tool]) for shape in shapes])
    lines = np.array([_stations(np.vstack([line for _, line in shape.parts])) for shape in shapes])
    spread = np.std(motor_angles, axis=0) + 1e-9
    unusual = np.sqrt(np.mean(((motor_angles[rows] - np.median(motor_angles, axis=0)) / spread) ** 2, axis=1))
    best = (-np.inf, 0, view_from(0.0))
    for azimuth in AZIMUTHS:
        view = view_from(float(azimuth))
        scores = _legibility(view.flat(nodes)) + 2 * _unfolded(view.flat(lines)) - 0.02 * unusual
        winner = int(np.argmax(scores))
        if scores[winner] > best[0] + 1e-9:
            best = (float(scores[winner]), int(rows[winner]), view)
    return best[1], best[2]


def shares_by_place(shares: Mapping[str, float]) -> dict[str, float]:
    """Shares added up by what can be drawn: "joint 6 from joint 5" counts with joint 6."""
    total: dict[str, float] = {}
    for location, share in shares.items():
        place = location.split(" from ")[0]
        total[place] = total.get(place, 0.0) + max(float(share), 0.0)
    return total


def upright(gravity: Array) -> Array:
    """(3, 3) the smallest turn of the base frame that puts gravity downwards in the picture."""
    strength = np.linalg.norm(gravity)
    if strength == 0:
        return np.eye(3)
    up = -gravity / strength
    cosine = up[2]
    if cosine < -1 + 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    cross = np.array([[0, 0, -up[0]], [0, 0, -up[1]], [up[0], up[1], 0]])
    turn: Array = np.eye(3) + cross + cross @ cross / (1 + cosine)
    return turn


def _legibility(nodes: Array) -> Array:
    """(N,) how far apart the nodes (N, K, 2) lie, relative to the picture's size; far enough is good enough."""
    gaps = np.linalg.norm(nodes[:, :, None] - nodes[:, None], axis=-1)
    size = gaps.max(axis=(1, 2), keepdims=True)
    near = np.minimum(gaps / size, 0.22) / 0.22
    first, second = np.triu_indices(nodes.shape[1], 1)
    pairs = near[:, first, second]
    scores: Array = pairs.mean(axis=1) + pairs.min(axis=1)
    return scores


def _stations(line: Array) -> Array:
    """(`STATIONS`, 3) points spread evenly along a centre line (K, 3)."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0, along[-1], STATIONS)
    return np.column_stack([np.interp(at, along, line[:, axis]) for axis in range(3)])


def _unfolded(lines: Array) -> Array:
    """(N,) how far apart pieces (N, K, 2) that are no neighbours lie in the picture; 1 for far enough."""
    first, second = np.triu_indices(lines.shape[1], 1)
    between = lines[:, first] - lines[:, second]
    gaps = np.sqrt(np.einsum("nki,nki->nk", between, between))
    near = np.minimum(gaps / gaps.max(axis=1, keepdims=True), APART) / APART
    scores: Array = near[:, second - first >= lines.shape[1] // 5].mean(axis=1)
    return scores


def _disc_centres(origins: Array, axes: Array, lines: list[Array]) -> Array:
    """(n, 3) a place for each joint's disc: its origin, or half-way along a piece of the arm that lies on its axis."""
    corners = np.vstack(lines)
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    starts, ends = (np.vstack([line[some] for line in lines]) for some in (slice(None, -1), slice(1, None)))
    options = [_places_on_axis(origin, axis, starts, ends, size) for origin, axis in zip(origins, axes, strict=True)]
    centres = origins.copy()
    placed = [np.zeros(3)]
    for joint in sorted(range(len(origins)), key=lambda joint: (len(options[joint]), joint)):
        gaps = [min(min(float(np.linalg.norm(place - other)) for other in placed), 0.1 * size)
                for place in options[joint]]  # fmt: skip
        centres[joint] = options[joint][int(np.argmax(gaps))]
        placed.append(centres[joint])
    return centres


def _places_on_axis(origin: Array, axis: Array, starts: Array, ends: Array, size: float) -> list[Array]:
    along = ends - starts
    length, across = (np.linalg.norm(each, axis=1) for each in (along, along - np.outer(along @ axis, axis)))
    near = np.minimum(*(np.linalg.norm(each - origin, axis=1) for each in (starts, ends)))
    held = (length >= 0.02 * size) & (across <= 1e-6 * length) & (near < 1e-6 * size)
    return [origin, *((starts + ends)[held] / 2)]


def _linkage(arm: Arm, frames: Chain) -> Array | None:
    """Crank and rod beside the upper arm, to scale where robot.yaml states them, else as a sketch."""
    if not has_parallelogram(arm):
        return None
    shoulder, elbow = frames.joint_origin[0, 1], frames.joint_origin[0, 2]
    stated = arm.description.parallelogram
    forearm = frames.link_rotation[0, 2]
    if stated is None:
        pin = -0.25 * np.linalg.norm(elbow - shoulder) * forearm[:, 0]
    else:
        angle = np.radians(stated.crank_angle_deg)
        axis = frames.joint_rotation[0, 2, :, 2]
        along = forearm[:, 0] - axis * (axis @ forearm[:, 0])
        pin = stated.crank_mm * 1e-3 * (np.cos(angle) * along + np.sin(angle) * np.cross(axis, along))
    return np.vstack([shoulder, shoulder + pin, elbow + pin, elbow])


def has_parallelogram(arm: Arm) -> bool:
    """Whether a rod keeps the forearm's direction independent of the upper arm."""
    if arm.description.parallelogram is not None:
        return True
    return arm.n_joints >= 3 and arm.n_motors >= 3 and bool(arm.actuation[2, 1] == -1 and arm.actuation[2, 2] == 1)
