"""Poses that an arm can take and a tracker can see: links as capsules, a floor, a line of sight.

The body is that of `armscope.poses.body`; without collision shapes each link is assumed to be `BODY.radius` of the
reach thick. Neighbouring pieces touch by construction and are not compared, nor are pairs that would touch in nearly
every pose (short wrists).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.poses.body import Capsule, Shape, collision_shapes, pieces
from armscope.poses.constants import BODY
from armscope.robot import Arm, chain


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What limits the poses besides the joints.

    Attributes:
        radius: of the links, m; None: the URDF's collision shapes, or assumed (`BODY.radius`).
        floor: height of a plane in the base frame below which nothing may be, m; None: there is none.
        tracker: (3,) where the tracker stands in the base frame, m; None: it sees everything.
    """

    radius: float | None = None
    floor: float | None = None
    tracker: Array | None = None

    def radius_of(self, arm: Arm) -> float:
        """Of the links, m."""
        return BODY.radius * arm.reach if self.radius is None else self.radius

    def shapes_of(self, arm: Arm) -> list[Shape]:
        """The collision shapes that count; none where the links are lines of one radius."""
        return collision_shapes(arm.description) if self.radius is None else []


def ranges(arm: Arm) -> tuple[Array, Array]:
    """(low, high) of each motor, rad."""
    low, high = arm.limits.T
    return np.where(np.isfinite(low), low, -BODY.unstated_rad), np.where(np.isfinite(high), high, BODY.unstated_rad)


REASONS = ("hits itself", "hits the floor", "out of the tracker's sight")


def refusals(arm: Arm, motor_angles: Array, around: Surroundings) -> NDArray[np.str_]:
    """(N,) one of `REASONS`, or "" for poses (N, m) rad that are possible.

    Args:
        arm: the arm.
        motor_angles: (N, m) rad.
        around: floor, tracker, body.

    Returns:
        (N,) texts.

    Raises:
        InputError: links so thick that no two parts of the arm are apart.
    """
    from scipy.stats import qmc  # takes long to import: only where poses are chosen

    low, high = ranges(arm)
    probes = low + qmc.Halton(arm.n_motors, scramble=False).random(BODY.probes) * (high - low)
    frames = chain(arm, np.concatenate([probes, motor_angles]))
    radius = around.radius_of(arm)
    body = pieces(arm, frames, around.shapes_of(arm), radius)
    if not body:
        found = f"{1e3 * radius:.6g} mm"
        raise InputError("--radius-mm", "", found, "links this thick would touch one another in every pose")
    reasons = np.full(BODY.probes + len(motor_angles), "", dtype="<U30")
    if around.tracker is not None:
        reasons[_hidden(body, frames.tool, around.tracker, radius)] = REASONS[2]
    if around.floor is not None:
        reasons[_below(body, around.floor)] = REASONS[1]
    reasons[_touches_itself(body)] = REASONS[0]
    return reasons[BODY.probes :]


def _touches_itself(body: list[Capsule]) -> NDArray[np.bool_]:
    """(N,) poses in which two pieces that are no neighbours come closer than their radii."""
    touches = np.zeros(len(body[0].start), dtype=bool)
    for one, other in combinations(body, 2):
        if abs(other.place - one.place) <= 1 or other.link == one.link:
            continue
        close = segment_distance(one.start, one.end, other.start, other.end) < one.radius + other.radius
        if close[: BODY.probes].mean() < BODY.always:
            touches |= close
    return touches


def _below(body: list[Capsule], floor: float) -> NDArray[np.bool_]:
    """(N,) poses with a moving piece nearer to the floor than its radius; what never moves stands on it."""
    lowest = np.full(len(body[0].start), np.inf)
    for piece in body:
        for point in (piece.start, piece.end):
            if np.ptp(point[: BODY.probes, 2]) > BODY.still_m:
                lowest = np.minimum(lowest, point[:, 2] - piece.radius)
    return np.asarray(lowest < floor)


def _hidden(body: list[Capsule], tool: Array, tracker: Array, radius: float) -> NDArray[np.bool_]:
    """(N,) poses in which a piece of the arm stands between tracker and tool."""
    away = tracker - tool
    distance = np.linalg.norm(away, axis=1, keepdims=True)
    near = tool + away / distance * np.minimum(BODY.clear_of_tool * radius, distance)
    hidden = np.zeros(len(tool), dtype=bool)
    for piece in body:
        seen_past = segment_distance(near, np.broadcast_to(tracker, near.shape), piece.start, piece.end)
        hidden |= seen_past < piece.radius
    return hidden


def segment_distance(start: Array, end: Array, other_start: Array, other_end: Array) -> Array:
    """(N,) shortest distance of N segments from N others, all ends (N, 3); after Ericson (2005), section 5.1.9.

    coal, which comes with pinocchio, measures one pair at a time; here each pair of links stands in thousands of poses.

    Args:
        start, end: (N, 3) ends of the segments.
        other_start, other_end: (N, 3) ends of the others.

    Returns:
        (N,) distances in the unit of the ends.
    """
    along, across = end - start, other_end - other_start
    between = start - other_start
    a, e = (np.maximum(np.sum(each**2, axis=1), BODY.no_length_m2) for each in (along, across))
    b, c, f = (np.sum(x * y, axis=1) for x, y in ((along, across), (along, between), (across, between)))
    spread = a * e - b * b
    s = np.clip(
        np.where(spread > BODY.parallel * a * e, (b * f - c * e) / np.maximum(spread, BODY.no_length_m2), 0.0), 0, 1
    )
    t = (b * s + f) / e
    s = np.where(t < 0, np.clip(-c / a, 0, 1), np.where(t > 1, np.clip((b - c) / a, 0, 1), s))
    t = np.clip(t, 0, 1)
    gap = between + s[:, None] * along - t[:, None] * across
    distance: Array = np.linalg.norm(gap, axis=1)
    return distance
