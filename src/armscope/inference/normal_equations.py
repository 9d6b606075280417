"""Sums over rows: all that selection, resampling and cross-validation need of them, whatever their number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices

LEAST_SEEN = 0.02
"""A column of which frames absorb more than all but this share is scaled as if this share were left."""


@dataclass(frozen=True, eq=False)
class Gram:
    """Sums over rows: G = X'WX (p, p), b = X'Wy (p,), yy = y'Wy, n = number of weighted residuals; mm."""

    G: Array
    b: Array
    yy: float
    n: float

    def __add__(self, other: Gram) -> Gram:
        return Gram(self.G + other.G, self.b + other.b, self.yy + other.yy, self.n + other.n)

    def __sub__(self, other: Gram) -> Gram:
        return Gram(self.G - other.G, self.b - other.b, self.yy - other.yy, self.n - other.n)

    def scaled(self, scale: Array) -> Gram:
        """With column k divided by scale[k]."""
        return Gram(self.G / np.outer(scale, scale), self.b / scale, self.yy, self.n)

    def rss(self, coefficients: Array) -> float:
        """Residual sum of squares with these coefficients of all columns."""
        return float(self.yy - 2 * self.b @ coefficients + coefficients @ self.G @ coefficients)


def total(blocks: Sequence[Gram]) -> Gram:
    """The sum of blocks."""
    whole = blocks[0]
    for block in blocks[1:]:
        whole = whole + block
    return whole


def scales(gram: Gram, frames: Indices) -> Array:
    """(p,) RMS per axis at the tool of each column beyond what the free frames absorb, mm per SI unit."""
    Gf = gram.G[np.ix_(frames, frames)]
    ridge = 1e-10 * np.diag(np.diag(Gf)) + 1e-300 * np.eye(len(frames))
    absorbed = np.sum(gram.G[frames] * np.linalg.solve(Gf + ridge, gram.G[frames]), axis=0)
    raw = np.diag(gram.G)
    seen = np.maximum(raw - absorbed, LEAST_SEEN**2 * raw)
    seen[frames] = raw[frames]
    return np.sqrt(np.maximum(seen / max(gram.n, 1.0), 1e-24))


def contribution(gram: Gram, frames: Indices, coefficients: Array) -> float:
    """RMS per axis at the tool, beyond the free frames, of a combination of columns (p,), mm."""
    Gc = gram.G @ coefficients
    Gf = gram.G[np.ix_(frames, frames)]
    absorbed = Gc[frames] @ np.linalg.lstsq(Gf, Gc[frames], rcond=1e-12)[0]
    left = float(coefficients @ Gc - absorbed)
    return float(np.sqrt(max(left, 0.0) / max(gram.n, 1.0)))
