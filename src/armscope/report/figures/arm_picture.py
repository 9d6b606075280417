"""The arm itself, drawn in a recorded pose, each place coloured by its share of the mismatch."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize, to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.report.figures.arm_shape import ArmShape, View, arm_shape, typical_pose
from armscope.report.style import BLACK, GREY, styled
from armscope.robot import Arm

UNTOUCHED = "#E4E8EC"
"""A place without a share."""
OUTLINE = "#3A424A"
NAMED_SHARE = 0.005
"""Shares below half a percent get no number."""


def share_colours() -> Colormap:
    """Light to dark, even in lightness for every kind of colour vision: magma without its black end."""
    dark_to_light = plt.get_cmap("magma")(np.linspace(0.18, 1.0, 256))
    dark_to_light[-12:] = np.linspace(dark_to_light[-12], to_rgba("#FFFBF0"), 12)
    return LinearSegmentedColormap.from_list("share", dark_to_light[::-1])


def draw_arm(arm: Arm, motor_angles: Array, shares: Mapping[str, float]) -> Figure:
    """The arm in a typical recorded pose, coloured by share.

    Args:
        arm: the arm.
        motor_angles: (N, m) recorded poses to choose from, rad.
        shares: by location ("base", "joint 2", "link 3", "tool", "parallelogram", "payload", "instrument",
            "joint 6 from joint 5"), 0 to 1.

    Returns:
        The figure.
    """
    row, view = typical_pose(arm, motor_angles)
    shape = arm_shape(arm, motor_angles[row])
    by_place = shares_by_place(shares)
    top = round_up(max([0.0, *by_place.values()]))
    norm, colours = Normalize(0, top), share_colours()

    def colour(place: str) -> Any:
        share = by_place.get(place, 0.0)
        return colours(norm(share)) if share > 0 else UNTOUCHED

    with styled():
        flat = view.flat(shape.points)
        wide, high = np.ptp(flat, axis=0) + 0.34 * np.max(np.ptp(flat, axis=0))
        figure, axes = plt.subplots(figsize=(float(np.clip(5.4 * wide / high, 3.4, 7.0)) + 1.0, 5.4))
        picture = _Picture(axes, shape, view)
        picture.frame_it()
        picture.floor(colour("base"))
        for location, line in shape.parts:
            picture.link(line, colour(location), place=location)
            if by_place.get(location, 0) > 0:
                picture.collar(line, colour(location), place=location)
        if shape.rod is not None:
            picture.linkage(shape.rod, colour("parallelogram"))
        for joint, (centre, axis) in enumerate(zip(shape.centres, shape.axes, strict=True), start=1):
            picture.disc(centre, axis, colour(f"joint {joint}"), joint)
        picture.tool(colour("tool"), colour("payload") if by_place.get("payload", 0) > 0 else None)
        if by_place.get("instrument", 0) > 0:
            picture.instrument(colour("instrument"))
        picture.compass()
        picture.labels(by_place)
        if top > 0:
            bar = figure.colorbar(ScalarMappable(norm, colours), ax=axes, shrink=0.7, pad=0.01, aspect=28)
            bar.set_label("share of the mismatch (%)")
            bar.ax.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.0f}")
            bar.outline.set_linewidth(0)
    return figure


def shares_by_place(shares: Mapping[str, float]) -> dict[str, float]:
    """Shares added up by what can be drawn: "joint 6 from joint 5" counts with joint 6."""
    total: dict[str, float] = {}
    for location, share in shares.items():
        place = location.split(" from ")[0]
        total[place] = total.get(place, 0.0) + max(float(share), 0.0)
    return total


def round_up(share: float) -> float:
    """The end of the colour bar: the next of 5, 10, 20, 40, 60, 80, 100 %."""
    if share <= 0:
        return 0.0
    return next((step for step in (0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0) if share <= step), share)


class _Picture:
    """One arm on one axes; sizes are fractions of the picture's height."""

    def __init__(self, axes: Axes, shape: ArmShape, view: View) -> None:
        self.axes, self.shape, self.view = axes, shape, view
        flat = view.flat(shape.points)
        self.low, self.high = flat.min(axis=0), flat.max(axis=0)
        self.size = float(max(np.max(self.high - self.low), 1e-3))
        self.n_joints = len(shape.centres)
        self.obstacles: list[tuple[Array, float]] = []  # points with the radius that labels keep away from

    def frame_it(self) -> None:
        margin = 0.17 * self.size
        self.axes.set_aspect("equal")
        self.axes.set_xlim(self.low[0] - margin, self.high[0] + margin)
        self.axes.set_ylim(self.low[1] - margin, self.high[1] + margin)
        self.axes.set_axis_off()

    def radius(self, joint: float) -> float:
        """Half the thickness of the arm at a joint: slimmer towards the tool."""
        return self.size * float(np.interp(joint, [0, self.n_joints + 1], [0.042, 0.021]))

    def floor(self, colour: Any) -> None:
        """The plate that the arm stands on, coloured as the base."""
        ring = np.linspace(0, 2 * np.pi, 60)
        plate = 0.11 * self.size * np.column_stack([np.cos(ring), np.sin(ring), 0 * ring])
        body = np.vstack([self.view.flat(plate), self.view.flat(plate - [0, 0, 0.035 * self.size])])
        hull = body[ConvexHull(body).vertices]
        self.axes.add_patch(Polygon(hull, facecolor=_shaded(colour), edgecolor=OUTLINE, linewidth=1.0, zorder=1))
        top = Polygon(self.view.flat(plate), facecolor=colour, edgecolor=OUTLINE, linewidth=0.7, zorder=1.1)
        self.axes.add_patch(top)
        self.obstacles.extend((point, 0.012 * self.size) for point in body[::3])

    def link(self, line: Array, colour: Any, place: str) -> None:
        number = _number(place) if place != "tool" else self.n_joints + 1
        width = 0.62 * self.radius(number)
        order = 10 + self._order(line.mean(axis=0))
        for extra, face, above in ((0.0045 * self.size, OUTLINE, 0.0), (0.0, colour, 0.1)):
            for start, end in pairwise(line):
                outline = _capsule(self.view.flat(start), self.view.flat(end), width + extra)
                self.axes.add_patch(Polygon(outline, facecolor=face, edgecolor="none", zorder=order + above))
        for start, end in pairwise(line):
            for along in np.linspace(0, 1, 12):
                self.obstacles.append((self.view.flat(start + along * (end - start)), width))

    def collar(self, line: Array, colour: Any, place: str) -> None:
        """A link too short to be seen shows its colour as a ring around the joint that covers it."""
        if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() > 0.12 * self.size or not place.startswith("link"):
            return
        centre, radius = self.view.flat(_halfway(line)), 2.0 * self.radius(_number(place))
        ring = _capsule(centre, centre, radius)
        self.axes.add_patch(Polygon(ring, facecolor=colour, edgecolor=OUTLINE, linewidth=1.0, zorder=19))
        self.obstacles.append((centre, radius))

    def linkage(self, rod: Array, colour: Any) -> None:
        flat = self.view.flat(rod)
        order = 9 + self._order(rod.mean(axis=0))
        for width, face in ((5.0, OUTLINE), (3.4, colour)):
            self.axes.plot(*flat.T, color=face, linewidth=width, solid_capstyle="round", zorder=order)
        for start, end in pairwise(rod):
            for along in np.linspace(0, 1, 12):
                self.obstacles.append((self.view.flat(start + along * (end - start)), 0.01 * self.size))

    def disc(self, centre: Array, axis: Array, colour: Any, joint: int) -> None:
        """A short cylinder about the joint's axis, and the axis with an arrow in its positive direction."""
        radius = 1.15 * self.radius(joint)
        across = np.linalg.svd(axis[None])[2][1:]
        ring = np.linspace(0, 2 * np.pi, 48, endpoint=False)
        circle = radius * (np.cos(ring)[:, None] * across[0] + np.sin(ring)[:, None] * across[1])
        towards = axis if self.view.depth(axis) >= 0 else -axis
        front, back = (self.view.flat(centre + side * 0.72 * radius * towards + circle) for side in (1, -1))
        order = 20 + self._order(centre)  # over all links: the discs are what the eye looks for
        body = np.vstack([front, back])
        hull = body[ConvexHull(body, qhull_options="QJ").vertices]
        tip, tail = (self.view.flat(centre + side * 2.3 * radius * axis) for side in (1, -1))
        self.axes.annotate(
            "", tuple(tip), tuple(tail), zorder=order - 0.3,
            arrowprops={"arrowstyle": "-|>", "color": OUTLINE, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0,
                        "linestyle": (0, (5, 2, 1, 2))},
        )  # fmt: skip
        self.axes.add_patch(Polygon(hull, facecolor=_shaded(colour), edgecolor=OUTLINE, linewidth=1.0, zorder=order))
        self.axes.add_patch(Polygon(front, facecolor=colour, edgecolor=OUTLINE, linewidth=0.7, zorder=order + 0.05))
        self.obstacles.append((self.view.flat(centre), 1.1 * radius))
        self.obstacles.append((tip, 0.01 * self.size))

    def tool(self, colour: Any, payload: Any | None) -> None:
        point = self.view.flat(self.shape.tool)
        self.axes.plot(*point, marker="o", markersize=6, color=colour, markeredgecolor=BLACK, zorder=40)
        self.axes.plot(*point, marker="+", markersize=12, color=BLACK, markeredgewidth=1.0, zorder=41)
        self.obstacles.append((point, 0.02 * self.size))
        if payload is not None:
            side = 0.035 * self.size
            low = point - [side, 3.4 * side]
            box = low + 2 * side * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
            self.axes.plot([point[0]] * 2, [point[1], low[1] + 2 * side], color=OUTLINE, linewidth=1.0, zorder=38)
            self.axes.add_patch(Polygon(box, facecolor=payload, edgecolor=OUTLINE, zorder=39))
            self.obstacles.append((box.mean(axis=0), 1.3 * side))

    def instrument(self, colour: Any) -> None:
        """A tracker on its stand, in the corner that is farthest from the arm."""
        (left, right), (bottom, top) = self.axes.get_xlim(), self.axes.get_ylim()
        unit = 0.03 * self.size
        feet = np.array([[left + 3 * unit, bottom + 4 * unit], [right - 3 * unit, bottom + 4 * unit],
                         [right - 3 * unit, top - 6 * unit]])  # fmt: skip
        gaps = np.linalg.norm(feet[:, None] - self.view.flat(self.shape.points), axis=2).min(axis=1)
        x, foot = feet[np.argmax(gaps)]
        for end in (-1, 0, 1):
            self.axes.plot([x, x + end * unit], [foot + 3 * unit, foot], color=OUTLINE, linewidth=1.2, zorder=5)
        head = np.array([x, foot + 3.6 * unit]) + unit * np.array([[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]])
        self.axes.add_patch(Polygon(head, facecolor=colour, edgecolor=OUTLINE, zorder=6))
        self.instrument_at = head.mean(axis=0)
        self.obstacles.append((self.instrument_at, 1.5 * unit))

    def labels(self, shares: Mapping[str, float]) -> None:
        """Names beside their places; a place with a share says how much."""
        wanted: list[tuple[str, Array, str]] = [("base", self.view.flat(np.array([0, 0, -0.05 * self.size])), "base")]
        for joint, centre in enumerate(self.shape.centres, start=1):
            wanted.append((f"joint {joint}", self.view.flat(centre), f"J{joint}"))
        for location, line in self.shape.parts:
            number = int(_number(location))
            length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
            if location.startswith("link") and (length > 0.07 * self.size or shares.get(location, 0) >= NAMED_SHARE):
                wanted.append((location, self.view.flat(_halfway(line)), f"L{number}"))
        wanted.append(("tool", self.view.flat(self.shape.tool), "tool"))
        if self.shape.rod is not None:
            wanted.append(("parallelogram", self.view.flat(self.shape.rod[1:3].mean(axis=0)), "parallelogram"))
        if shares.get("payload", 0) > 0:
            wanted.append(("payload", self.view.flat(self.shape.tool) - [0, 0.09 * self.size], "payload"))
        if shares.get("instrument", 0) > 0:
            wanted.append(("instrument", self.instrument_at, "instrument"))
        # those with a share first: they get the best places
        for place, anchor, name in sorted(wanted, key=lambda label: -shares.get(label[0], 0.0)):
            self._label(anchor, name, shares.get(place, 0.0), place)

    def _label(self, anchor: Array, name: str, share: float, place: str) -> None:
        matters = share >= NAMED_SHARE
        text = f"{name}  {100 * share:.0f} %" if matters else name
        half = np.array([(0.0125 if matters else 0.0105) * len(text), 0.017 if matters else 0.014]) * self.size
        spot = self._free_spot(anchor, half)
        if np.linalg.norm(spot - anchor) > 0.075 * self.size or matters:
            self.axes.plot(*np.vstack([anchor, spot]).T, color=GREY, linewidth=0.6, zorder=45)
        quiet = place.startswith("link") or place in ("base", "tool", "parallelogram")
        self.axes.text(
            spot[0], spot[1], text, ha="center", va="center", zorder=50, fontsize=10.5 if matters else 8.5,
            fontweight="bold" if matters else "normal", color=BLACK if matters or not quiet else "#5C6670",
            bbox={"boxstyle": "round,pad=0.18", "facecolor": "white", "linewidth": 0.6 if matters else 0,
                  "edgecolor": OUTLINE if matters else "none", "alpha": 0.95 if matters else 0.75},
        )  # fmt: skip
        for x in np.linspace(-1, 1, 5):
            self.obstacles.append((spot + half * [x, 0], float(half[1]) * 1.1))

    def _free_spot(self, anchor: Array, half: Array) -> Array:
        """The nearest place around the anchor where a label of this size covers nothing."""
        points = np.array([point for point, _ in self.obstacles])
        radii = np.array([radius for _, radius in self.obstacles])
        inside = np.array([[*self.axes.get_xlim()], [*self.axes.get_ylim()]])
        best, least = anchor, np.inf
        for distance in (0.06, 0.085, 0.11, 0.14, 0.18, 0.23):
            for angle in np.linspace(0, 2 * np.pi, 24, endpoint=False):
                reach = distance * self.size + half[0] * abs(np.cos(angle))
                spot = anchor + reach * np.array([np.cos(angle), np.sin(angle)])
                clear = np.maximum(np.abs(points - spot) - half, 0)
                overlap = np.maximum(radii + 0.008 * self.size - np.linalg.norm(clear, axis=1), 0).sum()
                outside = np.maximum(inside[:, 0] - spot + half, 0) + np.maximum(spot + half - inside[:, 1], 0)
                cost = 30 * overlap + 100 * outside.sum() + reach
                if cost < least:
                    best, least = spot, cost
        return best

    def compass(self) -> None:
        """A scale bar and the way gravity pulls."""
        left, right = self.axes.get_xlim()
        bottom, _ = self.axes.get_ylim()
        nice = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0]
        length = max((step for step in nice if step < 0.3 * self.size), default=nice[0])
        base_is_left = self.view.flat(np.zeros(3))[0] < (left + right) / 2
        x = right - 0.02 * (right - left) - length if base_is_left else left + 0.02 * (right - left)
        y = bottom + 0.025 * self.size
        self.obstacles.extend((np.array([x + along * length, y]), 0.05 * self.size) for along in np.linspace(0, 1, 6))
        self.axes.plot([x, x + length], [y, y], color=OUTLINE, linewidth=2.0, solid_capstyle="butt", zorder=5)
        self.axes.text(x + length / 2, y + 0.012 * self.size, f"{1e3 * length:.0f} mm", ha="center", va="bottom",
                       fontsize=8, color=OUTLINE)  # fmt: skip
        top = self.axes.get_ylim()[1]
        start = np.array([left + 0.03 * (right - left), top - 0.02 * self.size])
        self.axes.annotate("", (start[0], start[1] - 0.1 * self.size), tuple(start),
                           arrowprops={"arrowstyle": "-|>", "color": OUTLINE, "linewidth": 1.2})  # fmt: skip
        self.axes.text(start[0] + 0.015 * self.size, start[1] - 0.05 * self.size, "gravity", fontsize=8, color=OUTLINE,
                       va="center")  # fmt: skip

    def _order(self, point: Array) -> float:
        """0 to 8: nearer parts are drawn over farther ones."""
        depths = self.view.depth(self.shape.points)
        return 8 * float((self.view.depth(point) - depths.min()) / (np.ptp(depths) + 1e-9))


def _capsule(start: Array, end: Array, radius: float) -> Array:
    """(K, 2) outline of a stroke with round ends."""
    along = end - start
    angle = np.arctan2(along[1], along[0])
    half = np.linspace(-np.pi / 2, np.pi / 2, 14)

    def cap(centre: Array, turn: float) -> Array:
        return centre + radius * np.column_stack([np.cos(turn + half), np.sin(turn + half)])

    return np.vstack([cap(end, angle), cap(start, angle + np.pi)])


def _halfway(line: Array) -> Array:
    """The point half-way along a bent line."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    places = np.concatenate([[0.0], np.cumsum(steps)])
    return np.array([np.interp(places[-1] / 2, places, line[:, axis]) for axis in range(3)])


def _number(location: str) -> float:
    return float(Location.of(location).number)


def _shaded(colour: Any) -> Array:
    """The side of a disc: darker than its face."""
    return 0.78 * np.array(to_rgb(colour))
