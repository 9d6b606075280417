"""How much each row counts: a weight, and a whitening where rows scatter along known directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.diagnosis import robust

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

COUNTS = 0.5
"""Rows with a smaller part of their clean weight do not count as measurements."""


@dataclass(frozen=True, eq=False)
class RowNoise:
    """What is known of N rows' noise beside its size.

    Attributes:
        uncertainty: (N,) relative to the usual row's.
        share: (N,) of an independent row that each stands for: a pose visited again is no new pose.
    """

    uncertainty: Array
    share: Array

    @property
    def clean(self) -> Array:
        """(N,) weights of rows that are no bad shots."""
        return np.asarray(self.share / self.uncertainty**2)

    def weighed(self, residuals: Array, least: float, turn: Array | None = None) -> RowWeights:
        """Weights against residuals (N, 3) of a fitted model, whitened by ``turn``."""
        white = RowWeights(self.clean, turn).whitened(residuals)
        return RowWeights(robust.weights(white, self.uncertainty, least) * self.share, turn, self.clean, self.share)

    def weighed_first(self, residuals: Array, least: float) -> RowWeights:
        """Weights while structure may still be in the residuals."""
        row = robust.first_weights(residuals, self.uncertainty, least) * self.share
        return RowWeights(row, None, self.clean, self.share)


@dataclass(frozen=True, eq=False)
class RowWeights:
    """Weights of N rows.

    Attributes:
        row: (N,) weights.
        turn: (N, 3, 3) whitening of each row's three residuals, or None.
        clean: (N,) the weights if no row were a bad shot; None: ones.
        share: (N,) of an independent row that each row stands for; None: ones.
    """

    row: Array
    turn: Array | None = None
    clean: Array | None = None
    share: Array | None = None

    @property
    def trust(self) -> Array:
        """(N,) 1 for rows that look like the others, less for bad shots."""
        return self.row if self.clean is None else np.asarray(self.row / self.clean)

    def count(self, rows: Indices) -> Array:
        """(n,) how many independent measurements each of ``rows`` is: none, if it looks like a bad shot."""
        clean = 1.0 if self.clean is None else self.clean[rows]
        share = np.ones(len(rows)) if self.share is None else self.share[rows]
        return np.where(self.row[rows] > COUNTS * clean, share, 0.0)

    def lens(self, rows: Indices) -> Array:
        """(n, 3, 3) root of the weight, times the whitening: W^1/2 of ``rows``."""
        root = np.sqrt(self.row[rows])[:, None, None]
        return np.asarray(root * (np.eye(3) if self.turn is None else self.turn[rows]))

    def times(self, rows: Indices, values: Array) -> Array:
        """Residuals (n, 3) of ``rows``, whitened and times the root of the weights: W^1/2 y."""
        return np.asarray(np.einsum("nij,nj->ni", self.lens(rows), values))

    def take(self, rows: Indices, share: float = 1.0) -> RowWeights:
        """The weights of some rows, each standing for 1 / ``share`` rows."""
        turn, clean, independent = (None if x is None else x[rows] for x in (self.turn, self.clean, self.share))
        return RowWeights(self.row[rows] / share, turn, None if clean is None else clean / share, independent)

    def whitened(self, residuals: Array) -> Array:
        """Residuals (N, 3) without the known scatter."""
        if self.turn is None:
            return residuals
        white: Array = (self.turn @ residuals[:, :, None])[:, :, 0]
        return white
