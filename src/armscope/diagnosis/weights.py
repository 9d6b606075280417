"""How much each row counts: a weight, and a whitening where rows scatter along known directions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class RowWeights:
    """Weights of N rows.

    Attributes:
        row: (N,) weights.
        turn: (N, 3, 3) whitening of each row's three residuals, or None.
    """

    row: Array
    turn: Array | None = None

    def lens(self, rows: Indices) -> Array:
        """(n, 3, 3) root of the weight, times the whitening: W^1/2 of ``rows``."""
        root = np.sqrt(self.row[rows])[:, None, None]
        return np.asarray(root * (np.eye(3) if self.turn is None else self.turn[rows]))

    def times(self, rows: Indices, values: Array) -> Array:
        """Residuals (n, 3) of ``rows``, whitened and times the root of the weights: W^1/2 y."""
        return np.asarray(np.einsum("nij,nj->ni", self.lens(rows), values))

    def take(self, rows: Indices, share: float = 1.0) -> RowWeights:
        """The weights of some rows, each standing for 1 / ``share`` rows."""
        return RowWeights(self.row[rows] / share, None if self.turn is None else self.turn[rows])

    def whitened(self, residuals: Array) -> Array:
        """Residuals (N, 3) without the known scatter."""
        if self.turn is None:
            return residuals
        white: Array = (self.turn @ residuals[:, :, None])[:, :, 0]
        return white
