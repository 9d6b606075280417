"""The test paths of the 2006 paper, a rectangle-like one and Archimedes spirals: tool points in the base frame, m."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from armscope.core.types import Array


@dataclass(frozen=True)
class Tracker:
    """A tracker at a place, with the errors that the paper states; bounds "-+" are taken as one sigma."""

    position: tuple[float, float, float]  # (3,) in the robot's base frame, m
    # m/m, an error of scale and of the two angles that stays the same for a whole session (10 ppm)
    accuracy: float = 10e-6
    repeatability: float = 5e-6  # m/m, scatter of each coordinate of each reading (5 ppm)
    resolution: float = 1.26e-6  # m, step of the measured distance (1.26 um)
    readings: int = 100  # of which the mean is taken (100)

    def measurement_errors(self, points: ArrayLike, rng: np.random.Generator) -> Array:
        """(N, 3) measured minus true position, m, for one session that measures ``points`` (N, 3), m."""
        lever = np.asarray(points, dtype=float) - np.array(self.position)
        distance = np.linalg.norm(lever, axis=1, keepdims=True)
        scale, *turn = self.accuracy * rng.standard_normal(4)
        # a turn about the line of sight moves nothing, so three turns are the tracker's two angles wherever it looks
        lasting = scale * lever + np.cross(np.array(turn), lever)
        scatter = self.repeatability * distance[:, None] * rng.standard_normal((len(lever), self.readings, 3))
        readings = (lever + lasting)[:, None] + scatter
        ranges = np.linalg.norm(readings, axis=2, keepdims=True)
        if self.resolution > 0:
            readings *= np.round(ranges / self.resolution) * self.resolution / ranges
        measured: Array = readings.mean(axis=1) - lever
        return measured


PLANES = {"xy": (0, 1, 2), "yz": (1, 2, 0)}  # The two axes of a spiral's plane and the third, which changes linearly


def rectangle(corners: ArrayLike, points_per_side: int) -> Array:
    """(4 n, 3) points of the closed path through four corners (4, 3): each side begins at its corner (section 7.1).

    The fourth corner need not lie in the plane of the other three: "a rectangle-like Cartesian path in the
    three-dimensional space".
    """
    corners = np.asarray(corners, dtype=float)
    along = np.arange(points_per_side)[:, None] / points_per_side
    sides = [begin + along * (end - begin) for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    return np.concatenate(sides)


def archimedes_spiral(
    start: ArrayLike, plane: str, enlargement: float, turns_pi: float, count: int, rise: float
) -> Array:
    """(N, 3) points of a spiral about ``start``: W phi (cos phi, sin phi) in its plane, Eqs. (21)-(22) with r = phi.

    Args:
        start: (3,) m; the spiral's centre and its first point.
        plane: "xy" (trajectory II) or "yz" (trajectory III).
        enlargement: W, m.
        turns_pi: phi goes from 0 up to this many times pi (5), in ``count`` steps.
        count: the number of points N (200); phi of the last is one step short of the end.
        rise: change of the third coordinate from the first point to one step beyond the last, linear, m.

    Returns:
        (N, 3) m.
    """
    first, second, third = PLANES[plane]
    share = np.arange(count) / count
    phi = share * turns_pi * np.pi
    points = np.tile(np.asarray(start, dtype=float), (count, 1))
    points[:, first] += enlargement * phi * np.cos(phi)
    points[:, second] += enlargement * phi * np.sin(phi)
    points[:, third] += rise * share
    return points
