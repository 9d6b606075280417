"""The laser tracker of the 2006 paper (Leica LT500, section 4): what it adds to a position."""

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
