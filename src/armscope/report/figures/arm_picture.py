"""The arm itself, drawn in a recorded pose, each place coloured by its share of the mismatch."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import pairwise

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.report.colours import INK, OUTLINE, PAPER, QUIET, UNTOUCHED, scale_end, share_colour
from armscope.report.figures.arm_labels import Labels
from armscope.report.figures.arm_shape import ArmShape, View, arm_shape, shares_by_place, typical_pose
from armscope.report.svg import Drawing
from armscope.robot import Arm

NAMED_SHARE = 0.005  # Shares below half a percent get no number
HEIGHT = 430.0  # Of the picture, px
MARGIN = 0.19  # Room for labels around the arm, in its sizes
SHADOW = "rgba(0, 0, 0, 0.22)"  # Over what faces away from the light
HATCHED = 6.0  # From one line of a hatch to the next, px
STEPS = np.array([0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0])  # Lengths of the scale bar, m


def draw_arm(arm: Arm, motor_angles: Array, shares: Mapping[str, float], nameless: Collection[str] = ()) -> Drawing:
    """The arm in a typical recorded pose, coloured by share.

    Args:
        arm: the arm.
        motor_angles: (N, m) recorded poses to choose from, rad.
        shares: by location ("base", "joint 2", "link 3", "tool", "parallelogram", "payload", "instrument",
            "joint 6 from joint 5"), 0 to 1.
        nameless: joints where some of that follows no known law: hatched.

    Returns:
        The figure.
    """
    row, view = typical_pose(arm, motor_angles)
    picture = _Picture(arm_shape(arm, motor_angles[row]), view, shares_by_place(shares), nameless)
    picture.whole_arm()
    return picture.drawing


class _Picture:
    """One arm on one drawing; `to` turns metres of the picture's plane into px."""

    def __init__(self, shape: ArmShape, view: View, shares: Mapping[str, float], nameless: Collection[str]) -> None:
        self.shape, self.view, self.shares, self.nameless = shape, view, shares, nameless
        flat = view.flat(shape.points)
        low, high = flat.min(axis=0), flat.max(axis=0)
        size = float(max(np.max(high - low), 1e-3))
        self.low, self.high = low - MARGIN * size, high + MARGIN * size
        self.scale = HEIGHT / float(self.high[1] - self.low[1])
        self.size = size * self.scale
        self.end = scale_end(max([0.0, *shares.values()]))
        self.wide = float(self.high[0] - self.low[0]) * self.scale
        alt = "The arm in a recorded pose, joints and links coloured by their share of the mismatch"
        self.drawing = Drawing(self.wide + (64 if self.end else 0), HEIGHT, alt)
        self.n_joints = len(shape.centres)
        self.labels = Labels(self.drawing, self.wide, HEIGHT)

    def to(self, points: Array) -> Array:
        """(.., 2) px of points (.., 3) m."""
        flat = (self.view.flat(points) - self.low) * self.scale
        flat[..., 1] = HEIGHT - flat[..., 1]
        return np.asarray(flat)

    def colour(self, place: str) -> str:
        share = self.shares.get(place, 0.0)
        return share_colour(share / self.end) if share > 0 else UNTOUCHED

    def blamed(self, place: str) -> bool:
        return self.shares.get(place, 0.0) > 0

    def radius(self, joint: float) -> float:
        """Half the thickness of the arm at a joint, px: slimmer towards the tool."""
        return self.size * float(np.interp(joint, [0, self.n_joints + 1], [0.042, 0.021]))

    def whole_arm(self) -> None:
        self.floor()
        for location, line in self.shape.parts:
            self.link(line, location)
            if self.blamed(location):
                self.collar(line, location)
        if self.shape.rod is not None:
            self.linkage(self.shape.rod)
        for joint, (centre, axis) in enumerate(zip(self.shape.centres, self.shape.axes, strict=True), start=1):
            self.disc(centre, axis, joint)
        self.tool()
        if self.blamed("instrument"):
            self.instrument()
        self.compass()
        self.write()
        if self.end:
            self.colour_bar()

    def floor(self) -> None:
        """The plate that the arm stands on, coloured as the base."""
        ring = np.linspace(0, 2 * np.pi, 60)
        radius = 0.11 * self.size / self.scale
        plate = radius * np.column_stack([np.cos(ring), np.sin(ring), 0 * ring])
        below = plate - [0, 0, 0.3 * radius]
        side = _hull(self.to(np.vstack([plate, below])))
        self.drawing.polygon(side, self.colour("base"), OUTLINE, 1.0, order=1)
        self.drawing.polygon(side, SHADOW, order=1.05)
        self.drawing.polygon(self.to(plate), self.colour("base"), OUTLINE, 0.8, order=1.1)
        self.labels.avoid(self.to(below[::4]), 5)

    def link(self, line: Array, place: str) -> None:
        number = _number(place) if place != "tool" else self.n_joints + 1
        width = 1.24 * self.radius(number)
        order, flat = 10 + self._order(line.mean(axis=0)), self.to(line)
        self.drawing.line(flat, OUTLINE, width + 2, order)
        self.drawing.line(flat, self.colour(place), width, order + 0.1)
        self.labels.avoid(_along(flat), width / 2)

    def collar(self, line: Array, place: str) -> None:
        """A link too short to be seen shows its colour as a ring around the joint that covers it."""
        if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() * self.scale > 0.12 * self.size:
            return
        if place.startswith("link"):
            at, radius = self.to(_halfway(line)), 2.0 * self.radius(_number(place))
            self.drawing.circle(at, radius, self.colour(place), OUTLINE, order=19)
            self.labels.avoid(at[None], radius)

    def linkage(self, rod: Array) -> None:
        flat, order = self.to(rod), 9 + self._order(rod.mean(axis=0))
        self.drawing.line(flat, OUTLINE, 6, order)
        self.drawing.line(flat, self.colour("parallelogram"), 4, order + 0.1)
        self.labels.avoid(_along(flat), 4)

    def disc(self, centre: Array, axis: Array, joint: int) -> None:
        """A short cylinder about the joint's axis, and the axis with an arrow in its positive direction."""
        radius = 1.15 * self.radius(joint) / self.scale
        across = np.linalg.svd(axis[None])[2][1:]
        ring = np.linspace(0, 2 * np.pi, 36, endpoint=False)
        circle = radius * (np.cos(ring)[:, None] * across[0] + np.sin(ring)[:, None] * across[1])
        towards = axis if self.view.depth(axis) >= 0 else -axis
        front, back = (self.to(centre + side * 0.72 * radius * towards + circle) for side in (1, -1))
        order = 20 + self._order(centre)  # over all links: the discs are what the eye looks for
        tail, tip = (self.to(centre + side * 2.3 * radius * axis) for side in (-1, 1))
        self.drawing.arrow(tail, tip, OUTLINE, order - 0.3)
        side = _hull(np.vstack([front, back]))
        self.drawing.polygon(side, self.colour(f"joint {joint}"), OUTLINE, 1.2, order)
        self.drawing.polygon(side, SHADOW, order=order + 0.02)
        self.drawing.polygon(front, self.colour(f"joint {joint}"), OUTLINE, 0.9, order + 0.05)
        if f"joint {joint}" in self.nameless:
            for ends in _hatches(side):
                self.hatch(ends, order + 0.06)
        self.labels.avoid(self.to(centre)[None], 1.1 * radius * self.scale)
        self.labels.avoid(tip[None], 4)

    def hatch(self, ends: Array, order: float) -> None:
        """A line that is seen on the lightest colour as on the darkest."""
        self.drawing.line(ends, PAPER, 2.6, order)
        self.drawing.line(ends, INK, 1.1, order)

    def tool(self) -> None:
        at = self.to(self.shape.tool)
        self.drawing.circle(at, 4, self.colour("tool"), INK, order=40)
        for arm in (np.array([8, 0]), np.array([0, 8])):
            self.drawing.line(np.array([at - arm, at + arm]), INK, 1.2, 41)
        self.labels.avoid(at[None], 9)
        if self.blamed("payload"):
            side = 0.035 * self.size
            corners = at + side * np.array([[-1, 1.4], [1, 1.4], [1, 3.4], [-1, 3.4]])
            self.drawing.line(np.array([at, at + np.array([0, 1.4 * side])]), OUTLINE, 1.2, 38)
            self.drawing.polygon(corners, self.colour("payload"), OUTLINE, order=39)
            self.labels.avoid(corners.mean(axis=0)[None], 1.3 * side)

    def instrument(self) -> None:
        """A tracker on its stand, in the corner that is farthest from the arm."""
        unit = 0.03 * self.size
        feet = np.array([[3 * unit, HEIGHT - 4 * unit], [self.wide - 3 * unit, HEIGHT - 4 * unit],
                         [self.wide - 3 * unit, 6 * unit]])  # fmt: skip
        flat = self.to(self.shape.points)
        foot = feet[np.argmax(np.linalg.norm(feet[:, None] - flat, axis=2).min(axis=1))]
        for end in (-1, 0, 1):
            self.drawing.line(foot + np.array([[0, -3 * unit], [end * unit, 0]]), OUTLINE, 1.4, 5)
        head = foot - [0, 3.6 * unit] + unit * np.array([[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]])
        self.drawing.polygon(head, self.colour("instrument"), OUTLINE, order=6)
        self.instrument_at = head.mean(axis=0)
        self.labels.avoid(self.instrument_at[None], 1.5 * unit)

    def compass(self) -> None:
        """A scale bar and the way gravity pulls."""
        metres = float(STEPS[0.3 * self.size / self.scale > STEPS].max(initial=STEPS[0]))
        length = metres * self.scale
        base_is_left = self.to(np.zeros(3))[0] < self.wide / 2
        x, y = (self.wide - 8 - length if base_is_left else 8.0), HEIGHT - 8
        self.drawing.line(np.array([[x, y], [x + length, y]]), OUTLINE, 2.2, 5)
        self.drawing.text((x + length / 2, y - 10), f"{1e3 * metres:.0f} mm", size=11, anchor="middle", fill=QUIET)
        self.labels.avoid(np.array([[x + part * length, y] for part in np.linspace(0, 1, 6)]), 18)
        self.drawing.arrow(np.array([10, 6]), np.array([10, 44]), OUTLINE, 5)
        self.drawing.text((17, 25), "gravity", size=11, fill=QUIET)
        self.labels.avoid(np.array([[10.0, 25.0], [40.0, 25.0]]), 18)

    def write(self) -> None:
        """Names beside their places; a place with a share says how much."""
        wanted = [("base", self.to(np.array([0, 0, -0.05 * self.size / self.scale])), "base")]
        for joint, centre in enumerate(self.shape.centres, start=1):
            wanted.append((f"joint {joint}", self.to(centre), f"J{joint}"))
        for location, line in self.shape.parts:
            length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) * self.scale
            seen = length > 0.07 * self.size or self.shares.get(location, 0) > NAMED_SHARE
            if location.startswith("link") and seen:
                wanted.append((location, self.to(_halfway(line)), f"L{int(_number(location))}"))
        wanted.append(("tool", self.to(self.shape.tool), "tool"))
        if self.shape.rod is not None:
            wanted.append(("parallelogram", self.to(self.shape.rod[1:3].mean(axis=0)), "parallelogram"))
        if self.blamed("payload"):
            wanted.append(("payload", self.to(self.shape.tool) + np.array([0, 0.09 * self.size]), "payload"))
        if self.blamed("instrument"):
            wanted.append(("instrument", self.instrument_at, "instrument"))
        # those with a share first: they get the best places
        for place, anchor, name in sorted(wanted, key=lambda label: -self.shares.get(label[0], 0.0)):
            share = self.shares.get(place, 0.0)
            matters = share >= NAMED_SHARE
            self.labels.write(anchor, f"{name}  {100 * share:.0f} %" if matters else name, matters, self.size)

    def colour_bar(self) -> None:
        """The scale of shares beside the arm."""
        x, top, high, steps = self.wide + 12, 0.14 * HEIGHT, 0.66 * HEIGHT, 40
        for step in range(steps):
            corner = (x, top + high * (1 - (step + 1) / steps))
            self.drawing.rectangle(corner, (11, high / steps + 0.6), share_colour((step + 0.5) / steps))
        for part in (0, 0.5, 1):
            self.drawing.text((x + 15, top + high * (1 - part)), f"{100 * part * self.end:g} %", size=11, fill=QUIET)

        if self.nameless:
            y = top + high + 34
            corners = np.array([x, y]) + 18.0 * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
            self.drawing.polygon(corners, UNTOUCHED, OUTLINE)
            for ends in _hatches(corners):
                self.hatch(ends, 1.0)
            for line, words in enumerate(("no known", "law")):
                self.drawing.text((x, y + 28 + 12 * line), words, size=11, fill=QUIET)

    def _order(self, point: Array) -> float:
        """0 to 8: nearer parts are drawn over farther ones."""
        depths = self.view.depth(self.shape.points)
        return 8 * float((self.view.depth(point) - depths.min()) / (np.ptp(depths) + 1e-9))


def _along(flat: Array) -> Array:
    """Points along a bent line (K, 2)."""
    parts = np.linspace(0, 1, 12)[:, None]
    return np.vstack([start + parts * (end - start) for start, end in pairwise(flat)])


def _hull(points: Array) -> Array:
    """The convex outline of points (K, 2), in order: Andrew's monotone chain (1979)."""
    ordered = points[np.lexsort(points.T[::-1])].tolist()

    def half(run: list[list[float]]) -> list[list[float]]:
        kept: list[list[float]] = []
        for x, y in run:
            while len(kept) > 1:
                (ax, ay), (bx, by) = kept[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                    break
                kept.pop()
            kept.append([x, y])
        return kept[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))


def _hatches(corners: Array) -> list[Array]:
    """(2, 2) the ends of each line of a hatch across a convex outline (K, 2)."""
    found, level = [], corners.sum(axis=1)
    for at in np.arange(level.min() + HATCHED / 2, level.max(), HATCHED * 2**0.5):
        pairs = [(one, other) for one, other in zip(range(-1, len(corners) - 1), range(len(corners)), strict=True)
                 if (level[one] < at) != (level[other] < at)]  # fmt: skip
        parts = [(at - level[one]) / (level[other] - level[one]) for one, other in pairs]
        crossings = zip(pairs, parts, strict=True)
        found.append(
            np.array([corners[one] + part * (corners[other] - corners[one]) for (one, other), part in crossings])
        )
    return found


def _halfway(line: Array) -> Array:
    """The point half-way along a bent line."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    places = np.concatenate([[0.0], np.cumsum(steps)])
    return np.array([np.interp(places[-1] / 2, places, line[:, axis]) for axis in range(3)])


def _number(location: str) -> float:
    return float(Location.of(location).number)
