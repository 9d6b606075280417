"""Poses that an arm can take and a tracker can see: links as capsules, a floor, a line of sight.

Assumed, as no file states the arm's body: each piece of the centre line (from the kinematics, `centre_lines`) is a
capsule of one radius, `RADIUS_SHARE` of the reach unless told. Neighbouring pieces touch by construction and are not
compared, nor are pairs that would touch in nearly every pose (short wrists).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from armscope.robot import Arm, Chain, chain
from armscope.robot.centre_line import centre_lines

Array = NDArray[np.float64]

RADIUS_SHARE = 0.04
"""Radius of a link as a share of the arm's reach: 100 mm for a reach of 2.5 m."""
ALWAYS_SHARE = 0.9
"""A pair of pieces that touches in a larger share of poses does so by the assumed radius, not by the pose."""
SHORTEST_SHARE = 0.5
"""Pieces of the centre line shorter than this share of the radius count as part of their neighbours."""
CLEAR_OF_TOOL = 2.0
"""The line of sight starts this many radii from the tool point: nearer by is the reflector's holder."""


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What limits the poses besides the joints.

    Attributes:
        radius: of the links, m; None: assumed (`RADIUS_SHARE`).
        floor: height of a plane in the base frame below which nothing may be, m; None: there is none.
        tracker: (3,) where the tracker stands in the base frame, m; None: it sees everything.
    """

    radius: float | None = None
    floor: float | None = None
    tracker: Array | None = None

    def radius_of(self, arm: Arm) -> float:
        """Of the links, m."""
        return RADIUS_SHARE * arm.reach if self.radius is None else self.radius


REASONS = ("hits itself", "hits the floor", "out of the tracker's sight")


def refusals(arm: Arm, motor_angles: Array, around: Surroundings) -> NDArray[np.str_]:
    """(N,) one of `REASONS`, or "" for poses (N, m) rad that are possible."""
    frames = chain(arm, motor_angles)
    pieces, radius = _pieces(arm, frames), around.radius_of(arm)
    reasons = np.full(len(motor_angles), "", dtype="<U30")
    if around.tracker is not None:
        reasons[_hidden(pieces, frames.tool, around.tracker, radius)] = REASONS[2]
    if around.floor is not None:
        reasons[_below(pieces, around.floor, radius)] = REASONS[1]
    reasons[_touches_itself(pieces, radius)] = REASONS[0]
    return reasons


@dataclass(frozen=True, eq=False)
class _Piece:
    """A straight piece of the arm: which link, its ends (N, 3), m."""

    link: int
    start: Array
    end: Array


def _pieces(arm: Arm, frames: Chain) -> list[_Piece]:
    pieces = []
    for link, (_, line) in enumerate(centre_lines(arm, frames)):
        for k, _ in pairwise(range(line.shape[1])):
            pieces.append(_Piece(link, line[:, k], line[:, k + 1]))
    return pieces


def _long(pieces: list[_Piece], radius: float) -> list[_Piece]:
    """Without pieces that have no length to speak of; lengths do not depend on the pose."""
    return [each for each in pieces if np.linalg.norm(each.end[0] - each.start[0]) > SHORTEST_SHARE * radius]


def _touches_itself(pieces: list[_Piece], radius: float) -> NDArray[np.bool_]:
    """(N,) poses in which two pieces that are no neighbours come closer than their radii."""
    solid = _long(pieces, radius)
    touches = np.zeros(len(pieces[0].start), dtype=bool)
    for first, second in combinations(range(len(solid)), 2):
        one, other = solid[first], solid[second]
        if second - first == 1 or other.link == one.link:
            continue
        close = segment_distance(one.start, one.end, other.start, other.end) < 2 * radius
        if close.mean() < ALWAYS_SHARE:
            touches |= close
    return touches


def _below(pieces: list[_Piece], floor: float, radius: float) -> NDArray[np.bool_]:
    """(N,) poses with a moving piece nearer to the floor than the radius; what never moves stands on it."""
    lowest = np.full(len(pieces[0].start), np.inf)
    for piece in _long(pieces, radius):
        for point in (piece.start, piece.end):
            if np.ptp(point[:, 2]) > 1e-9:
                lowest = np.minimum(lowest, point[:, 2])
    return np.asarray(lowest < floor + radius)


def _hidden(pieces: list[_Piece], tool: Array, tracker: Array, radius: float) -> NDArray[np.bool_]:
    """(N,) poses in which a piece of the arm stands between tracker and tool."""
    away = tracker - tool
    distance = np.linalg.norm(away, axis=1, keepdims=True)
    near = tool + away / distance * np.minimum(CLEAR_OF_TOOL * radius, distance)
    hidden = np.zeros(len(tool), dtype=bool)
    for piece in _long(pieces, radius):
        hidden |= segment_distance(near, np.broadcast_to(tracker, near.shape), piece.start, piece.end) < radius
    return hidden


def segment_distance(start: Array, end: Array, other_start: Array, other_end: Array) -> Array:
    """(N,) shortest distance of N segments from N others, all ends (N, 3); after Ericson (2005), section 5.1.9."""
    along, across = end - start, other_end - other_start
    between = start - other_start
    a, e = (np.maximum(np.sum(each**2, axis=1), 1e-18) for each in (along, across))
    b, c, f = (np.sum(x * y, axis=1) for x, y in ((along, across), (along, between), (across, between)))
    spread = a * e - b * b
    s = np.clip(np.where(spread > 1e-12 * a * e, (b * f - c * e) / np.maximum(spread, 1e-18), 0.0), 0, 1)
    t = (b * s + f) / e
    s = np.where(t < 0, np.clip(-c / a, 0, 1), np.where(t > 1, np.clip((b - c) / a, 0, 1), s))
    t = np.clip(t, 0, 1)
    gap = between + s[:, None] * along - t[:, None] * across
    distance: Array = np.linalg.norm(gap, axis=1)
    return distance
