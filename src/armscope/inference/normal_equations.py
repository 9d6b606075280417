"""Sums over rows: all that selection, resampling and cross-validation need of them, whatever their number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.blas import daxpy

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """Sums over rows: G = X'WX (p, p), b = X'Wy (p,), yy = y'Wy, n = number of weighted residuals; mm."""

    G: Array
    b: Array
    yy: float
    n: float

    def __sub__(self, other: NormalEquations) -> NormalEquations:
        return NormalEquations(self.G - other.G, self.b - other.b, self.yy - other.yy, self.n - other.n)

    def scaled(self, scale: Array) -> NormalEquations:
        """With column k divided by scale[k]."""
        product = np.outer(scale, scale)
        return NormalEquations(np.divide(self.G, product, out=product), self.b / scale, self.yy, self.n)

    def among(self, columns: Indices, count: int) -> NormalEquations:
        """The same as sums of ``count`` columns, of which these are all that is known; the others' sums are zero."""
        G, b = np.zeros((count, count)), np.zeros(count)
        G[np.ix_(columns, columns)], b[columns] = self.G, self.b
        return NormalEquations(G, b, self.yy, self.n)

    def rss(self, coefficients: Array) -> float:
        """Residual sum of squares with these coefficients of all columns."""
        return float(self.rss_of_each(coefficients[None])[0])

    def rss_of_each(self, coefficients: Array) -> Array:
        """(K,) residual sums of squares with each of K sets (K, p) of coefficients."""
        return np.asarray(self.yy + np.sum((coefficients @ self.G - 2 * self.b) * coefficients, axis=1))

    def least_rss(self, columns: Indices) -> float:
        """Residual sum of squares of least squares on some columns, which may depend on each other."""
        if not len(columns):
            return self.yy
        G, b = self.G[np.ix_(columns, columns)], self.b[columns]
        return max(float(self.yy - b @ np.linalg.lstsq(G, b, rcond=1e-12)[0]), 0.0)


def total(blocks: Sequence[NormalEquations]) -> NormalEquations:
    """The sum of blocks."""
    return weighted_total(blocks, np.ones(len(blocks), dtype=np.intp))


def weighted_total(blocks: Sequence[NormalEquations], times: Indices) -> NormalEquations:
    """The sum of blocks, each counted so many times."""
    drawn = [(blocks[int(k)], int(times[k])) for k in np.flatnonzero(times)]
    G, b = np.zeros(blocks[0].G.shape), np.zeros_like(blocks[0].b)
    for block, often in drawn:
        daxpy(block.G.reshape(-1), G.reshape(-1), a=often)  # adds in place, without a product that is as large
        b += often * block.b
    yy, n = sum(often * block.yy for block, often in drawn), sum(often * block.n for block, often in drawn)
    return NormalEquations(G, b, float(yy), float(n))


def steadied(equations: NormalEquations, frames: Indices) -> NormalEquations:
    """The same with frames held where they stand along directions in which their columns all but cancel.

    A planar arm's rows tell the tool's height from the base's by nothing but its own small errors; without this, frames
    that move by metres against each other take up a millimetre of anything.

    Args:
        equations: sums over rows.
        frames: columns of the free frames.

    Returns:
        The sums; the given ones where no direction cancels.
    """
    G = equations.G[np.ix_(frames, frames)]
    size = np.sqrt(np.maximum(G.diagonal(), 1e-300))
    share, directions = np.linalg.eigh(G / np.outer(size, size))
    cancelling = directions[:, share < NUMERICS.cancelling**2]
    if not cancelling.shape[1]:
        return equations
    held = equations.G.copy()
    held[np.ix_(frames, frames)] += np.outer(size, size) * (cancelling @ cancelling.T)
    return NormalEquations(held, equations.b, equations.yy, equations.n)


def column_scales(equations: NormalEquations, frames: Indices) -> Array:
    """(p,) RMS per axis at the tool of each column beyond what the free frames absorb, mm per SI unit."""
    Gf = equations.G[np.ix_(frames, frames)]
    ridge = 1e-10 * np.diag(np.diag(Gf)) + 1e-300 * np.eye(len(frames))
    absorbed = np.sum(equations.G[frames] * np.linalg.solve(Gf + ridge, equations.G[frames]), axis=0)
    raw = np.diag(equations.G)
    seen = np.maximum(raw - absorbed, NUMERICS.least_seen**2 * raw)
    seen[frames] = raw[frames]
    return np.asarray(np.sqrt(np.maximum(seen / max(equations.n, 1.0), 1e-24)))


def as_response(G: Array, coefficients: Array, n: float) -> NormalEquations:
    """The normal equations of a combination of the columns as the response.

    Args:
        G: (p, p) products of the columns.
        coefficients: (p,) of the combination.
        n: measured numbers.

    Returns:
        Sums as if that combination had been measured.
    """
    b = G @ coefficients
    return NormalEquations(G, b, float(coefficients @ b), n)


def projected_rms(equations: NormalEquations, frames: Indices, coefficients: Array) -> float:
    """RMS per axis at the tool, beyond the free frames, of a combination of columns (p,), mm.

    Args:
        equations: sums over rows.
        frames: columns of the free frames.
        coefficients: (p,) of the combination.

    Returns:
        mm per axis.
    """
    left = as_response(equations.G, coefficients, equations.n).least_rss(frames)
    return float(np.sqrt(left / max(equations.n, 1.0)))
