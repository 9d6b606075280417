"""Poses that an arm can take and a tracker can see: links as capsules, a floor, a line of sight.

The body is that of `armscope.poses.body`; without collision shapes each link is assumed to be `BODY.radius` of the
reach thick. Links that share a joint are not compared. Two others touch where they come closer than their radii or,
if that is less, `BODY.nearest` of the widest gap that any pose leaves between them (short wrists, an elbow's offset).
So centre lines that cross are always refused, and a thicker body never less often.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.poses.body import Capsule, Shape, collision_shapes, pieces
from armscope.poses.constants import BODY, UP
from armscope.robot import Arm, Chain, chain


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What limits the poses besides the joints."""

    radius: float | None = None  # of the links, m; None: the URDF's collision shapes, or assumed (`BODY.radius`)
    floor: float | None = None  # height of a plane in the base frame below which nothing may be, m; None: there is none
    tracker: Array | None = None  # (3,) where the tracker stands in the base frame, m; None: it sees everything
    # (3,) of length one in the base frame: the way in which heights count
    up: Array = field(default_factory=lambda: UP)

    def radius_of(self, arm: Arm) -> float:
        """Of the links, m."""
        if self.radius is not None and self.radius > arm.reach:
            allowed = f"links are not thicker than the arm reaches, {1e3 * arm.reach:.0f} mm"
            raise InputError("--radius-mm", "", f"{1e3 * self.radius:g}", allowed)
        return BODY.radius * arm.reach if self.radius is None else self.radius

    def shapes_of(self, arm: Arm) -> list[Shape]:
        """The collision shapes that count; none where the links are lines of one radius."""
        return _shapes(arm) if self.radius is None else []


@functools.lru_cache(maxsize=8)
def _shapes(arm: Arm) -> list[Shape]:
    """Read once: meshes take long, and a search asks many times."""
    return collision_shapes(arm.description)


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
    """
    body, frames = _probed(arm, around, motor_angles)
    reasons = np.full(len(frames.tool), "", dtype="<U30")
    if around.tracker is not None:
        reasons[_hidden(body, frames.tool, around.tracker, around.radius_of(arm))] = REASONS[2]
    if around.floor is not None:
        reasons[_lowest(body, frames.tool, around.up) < around.floor] = REASONS[1]
    for pair in _pairs(body):
        reasons[pair.distance < pair.near] = REASONS[0]
    return reasons[BODY.probes :]


def lowest(arm: Arm, motor_angles: Array, around: Surroundings) -> Array:
    """(N,) height, by `Surroundings.up`, of the lowest point of what moves at poses (N, m) rad, m.

    Args:
        arm: the arm.
        motor_angles: (N, m) rad.
        around: the body.

    Returns:
        (N,) heights, m.
    """
    body, frames = _probed(arm, around, motor_angles)
    return _lowest(body, frames.tool, around.up)[BODY.probes :]


def thinned(arm: Arm, around: Surroundings) -> tuple[str, ...]:
    """Pairs of links, in words, that count as touching closer than by their radii, which leave them little room."""
    body, _ = _probed(arm, around, np.empty((0, arm.n_motors)))
    found: dict[tuple[str, str], tuple[float, float]] = {}
    for pair in _pairs(body):
        stated = pair.one.radius + pair.other.radius
        if pair.near < stated and np.ptp(pair.distance) > BODY.still_m:  # else no pose brings them nearer
            names = pair.one.name, pair.other.name
            found[names] = min(found.get(names, (np.inf, 0.0)), (pair.near, stated))
    return tuple(
        f"{one} and {other} within {1e3 * near:.0f} mm of their lines, in place of {1e3 * stated:.0f} mm"
        for (one, other), (near, stated) in found.items()
    )


def _probed(arm: Arm, around: Surroundings, motor_angles: Array) -> tuple[list[Capsule], Chain]:
    """The body and the frames in `BODY.probes` poses over the whole ranges, followed by those asked for."""
    from scipy.stats import qmc  # takes long to import: only where poses are chosen

    low, high = ranges(arm)
    probes = low + qmc.Halton(arm.n_motors, scramble=False).random(BODY.probes) * (high - low)
    frames = chain(arm, np.concatenate([probes, motor_angles]))
    return pieces(arm, frames, around.shapes_of(arm), around.radius_of(arm)), frames


@dataclass(frozen=True, eq=False)
class PiecePair:
    """Two pieces that share no joint, the (N,) distance of their axes, m, and that from which on they touch, m."""

    one: Capsule
    other: Capsule
    distance: Array
    near: float


def _pairs(body: list[Capsule]) -> Iterator[PiecePair]:
    for one, other in combinations(body, 2):
        if abs(other.place - one.place) <= 1 or other.link == one.link:
            continue
        distance = segment_distance(one.start, one.end, other.start, other.end)
        widest = float(distance[: BODY.probes].max())
        if widest > BODY.still_m:  # else they share a point in all poses
            yield PiecePair(one, other, distance, min(one.radius + other.radius, BODY.nearest * widest))


def _lowest(body: list[Capsule], tool: Array, up: Array) -> Array:
    """(N,) m, of the tool point and of all pieces that move; what never moves stands on the floor."""
    found = tool @ up
    for piece in body:
        for point in (piece.start, piece.end):
            height = point @ up
            if np.ptp(height[: BODY.probes]) > BODY.still_m:
                found = np.minimum(found, height - piece.radius)
    return found


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


def body_in_words(arm: Arm, around: Surroundings) -> str:
    """What the arm's body is taken to be."""
    radius = f"{around.radius_of(arm) * 1e3:.0f} mm radius"
    shapes = around.shapes_of(arm)
    if shapes:
        return (
            f"{len(shapes)} collision shapes of the URDF as capsules; links without one, and what lies between the "
            f"last shape and the tool point, as capsules of {radius}"
        )
    return f"links as capsules of {radius} around the lines between their joints"


def body_notes(arm: Arm, around: Surroundings) -> list[str]:
    """What a command says beside poses or a motion: what the body is taken for, and what was not checked."""
    notes = [f"the arm's body: {body_in_words(arm, around)}; links that share a joint are not checked"]
    notes += [
        f"thicker than half the gap that there ever is between them, and checked less: {each}"
        for each in thinned(arm, around)
    ]
    return notes


def surroundings_notes(arm: Arm, around: Surroundings) -> list[str]:
    """The same, and what was not looked at for want of an option."""
    notes = body_notes(arm, around)
    notes += ["no --tracker: every pose counts as visible"] if around.tracker is None else []
    notes += ["no --floor-mm: the arm may reach below its base"] if around.floor is None else []
    return notes
