"""Labels around an arm, each where it covers nothing."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.report.colours import INK, QUIET
from armscope.report.svg import LETTER, Drawing

DISTANCES = np.array([0.06, 0.085, 0.11, 0.14, 0.18, 0.23])  # From what is named, in sizes of the arm
ANGLES = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SIZE, BOLD = 12.0, 14.0


class Labels:
    """Words on a drawing of so many px, and what they keep away from."""

    def __init__(self, drawing: Drawing, wide: float, high: float) -> None:
        self.drawing, self.box = drawing, np.array([wide, high])
        self.points, self.radii = np.empty((0, 2)), np.empty(0)

    def avoid(self, points: Array, radius: float) -> None:
        """Keep clear of points (K, 2) by a radius, px."""
        self.points = np.vstack([self.points, points])
        self.radii = np.concatenate([self.radii, np.full(len(points), radius)])

    def write(self, anchor: Array, words: str, bold: bool, size: float) -> None:
        """Words near a point, with a line to it where they are far from it.

        Args:
            anchor: (2,) what is named, px.
            words: its name.
            bold: whether it matters.
            size: of the arm, px.
        """
        letters = BOLD if bold else SIZE
        half = np.array([0.5 * LETTER * letters * len(words), 0.62 * letters])
        spot = self._free_spot(anchor, half, size)
        if bold or np.linalg.norm(spot - anchor) > 0.075 * size:
            self.drawing.line(np.array([anchor, spot]), QUIET, 0.7, 45)
        weight, fill = ("bold", INK) if bold else ("normal", QUIET)
        self.drawing.text(spot, words, size=letters, anchor="middle", weight=weight, fill=fill, order=50)
        self.avoid(spot + half * np.array([[-0.7, 0], [0, 0], [0.7, 0]]), float(half[1]))

    def _free_spot(self, anchor: Array, half: Array, size: float) -> Array:
        """The nearest place around the anchor where a label of this size covers nothing."""
        reach = DISTANCES[:, None] * size + half[0] * np.abs(np.cos(ANGLES))
        spots = anchor + (reach[..., None] * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=-1)).reshape(-1, 2)
        clear = np.maximum(np.abs(self.points - spots[:, None]) - half, 0)
        overlap = np.maximum(self.radii + 3 - np.linalg.norm(clear, axis=2), 0).sum(axis=1)
        outside = (np.maximum(half - spots, 0) + np.maximum(spots + half - self.box, 0)).sum(axis=1)
        return np.asarray(spots[np.argmin(30 * overlap + 100 * outside + reach.reshape(-1))])
