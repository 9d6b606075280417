"""Factors of small symmetric matrices, what blocks of columns explain beside a model, and a noise that follows."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.linalg import orth
from scipy.linalg.blas import dtrmm
from scipy.linalg.lapack import dpotrf, dtrtri, dtrtrs

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS


def among(G: Array, columns: Indices) -> Array:
    """(c, c) the products of some columns with each other, of those of all (p, p)."""
    return crossed(G, columns, columns)


def crossed(G: Array, some: Indices, others: Indices) -> Array:
    """(c, d) the products of some columns with others.

    Args:
        G: (p, p) products of all columns.
        some: (c,) columns.
        others: (d,) columns.

    Returns:
        (c, d), in the unit of G.
    """
    down, right = _stretches(some), _stretches(others)
    if len(down) * len(right) > len(some):
        return np.asarray(G.take(np.add.outer(some * len(G), others)))
    # whole stretches take a fifth of what looking up numbers one by one does
    found = np.empty((len(some), len(others)))
    for to_rows, rows in down:
        for to_columns, columns in right:
            found[to_rows, to_columns] = G[rows, columns]
    return found


def _stretches(columns: Indices) -> list[tuple[slice, slice]]:
    """Where columns that follow each other stand among these, and among all."""
    if not len(columns):
        return []
    ends = [0, *(np.flatnonzero(np.diff(columns) != 1) + 1).tolist(), len(columns)]
    firsts = columns[ends[:-1]].tolist()
    return [(slice(a, b), slice(c, c + b - a)) for (a, b), c in zip(itertools.pairwise(ends), firsts, strict=True)]


def lower_cholesky(G: Array, ridge: Array) -> Array:
    """Cholesky factor (lower) of G + diag(ridge); a ridge below rounding is raised to it (few rows, fitted exactly).

    Raises:
        LinAlgError: the matrix is not positive definite.
    """
    A = G.copy()
    A.reshape(-1)[:: len(A) + 1] += np.maximum(ridge, NUMERICS.rounding * G.diagonal())
    # the transpose of a symmetric matrix: itself, in the order that LAPACK works in without another copy
    factor, failed = dpotrf(A.T, lower=1, clean=1, overwrite_a=1)
    if failed:
        raise np.linalg.LinAlgError(f"the normal equations are not positive definite at column {failed}")
    return np.asarray(factor)


def lower_inverse(factor: Array) -> Array:
    """The inverse of a lower triangular matrix, by halves: products of blocks are twice as fast as LAPACK's columns."""
    k = len(factor)
    if k <= NUMERICS.inverted_at_once:
        return np.asarray(dtrtri(factor, lower=1)[0])
    half = k // 2
    inverse = np.zeros((k, k), order="F")
    inverse[:half, :half] = above = lower_inverse(factor[:half, :half])
    inverse[half:, half:] = below = lower_inverse(factor[half:, half:])
    beside = dtrmm(1.0, above, factor[half:, :half], side=1, lower=1)
    inverse[half:, :half] = dtrmm(-1.0, below, beside, lower=1)
    return inverse


def solve_lower(factor: Array, right: Array) -> Array:
    """factor^-1 right."""
    return np.asarray(dtrtrs(factor, right, lower=1)[0])


def solve_upper(factor: Array, right: Array) -> Array:
    """factor'^-1 right, of a lower factor."""
    return np.asarray(dtrtrs(factor, right, lower=1, trans=1)[0])


def schur_complement(G: Array, free: Indices, columns: Indices) -> Array:
    """(c, c) products of some columns beyond what the free ones absorb; those may depend on each other.

    Args:
        G: (p, p) products of all columns.
        free: columns that absorb.
        columns: c others.

    Returns:
        (c, c), in the unit of G.
    """
    absorbed = np.linalg.lstsq(G[np.ix_(free, free)], G[np.ix_(free, columns)], rcond=1e-12)[0]
    return np.asarray(G[np.ix_(columns, columns)] - G[np.ix_(columns, free)] @ absorbed)


@dataclass(frozen=True, eq=False)
class ColumnBlocks:
    """m blocks of c columns beside k columns of a model."""

    own: Array  # (m, c, c) X'WX within each block
    cross: Array  # (m, k, c) model columns against the block's
    b: Array  # (m, c) X'Wy

    @property
    def diagonal(self) -> Array:
        """(m, c) sums of squares of the columns."""
        return np.asarray(np.einsum("mcc->mc", self.own))

    def conditioned(self, cholesky: Array, whitened_rhs: Array) -> tuple[Array, Array]:
        """(own, b) of the blocks once the model's posterior is conditioned on.

        Args:
            cholesky: (k, k) factor of the model's penalised normal equations, in the blocks' units.
            whitened_rhs: (k,) factor^-1 X'Wy of the model.
        """
        m, k, c = self.cross.shape
        V = solve_lower(cholesky, self.cross.transpose(1, 0, 2).reshape(k, m * c))
        V = V.reshape(k, m, c).transpose(1, 0, 2)
        return self.own - np.swapaxes(V, 1, 2) @ V, self.b - np.einsum("mkc,k->mc", V, whitened_rhs)


def spanned(columns: Array, rounding: float) -> Array:
    """What columns span, each in a unit of its own.

    Of a column that is nothing but rounding, or of what one has beyond the others that is nothing else, chance would
    make a direction like any other.

    Args:
        columns: (K, c), of sizes that can be compared.
        rounding: share of the largest column, and of a column in its own unit, up to which it is rounding.

    Returns:
        (K, r) orthonormal.
    """
    size = np.linalg.norm(columns, axis=0)
    there = size > rounding * size.max(initial=0.0)
    return np.asarray(orth(columns[:, there] / size[there], rcond=rounding))


def rss_reduction(own: Array, b: Array, before: Array) -> Array:
    """(m,) reduction of the sum of squares by each block; directions that the model absorbs already count nothing.

    Args:
        own: (m, c, c) products within each block once the model is conditioned on.
        b: (m, c) their products with what is left.
        before: (m, c) diagonal of the blocks' own matrices before conditioning: what "absorbed" is measured against.

    Returns:
        (m,), in the unit of the sums.
    """
    norm = np.sqrt(np.maximum(before, 1e-300))
    scaled = own / (norm[:, :, None] * norm[:, None, :])
    values, vectors = np.linalg.eigh(scaled)
    u = np.einsum("mij,mi->mj", vectors, b / norm)
    return np.asarray(
        np.sum(np.where(values > NUMERICS.absorbed, u**2 / np.maximum(values, NUMERICS.absorbed), 0.0), axis=1)
    )


def quadratic_and_logdet(D: Array, r: Array, widths: Array) -> tuple[Array, Array]:
    """(sizes, m) r' (D + 1 / w^2)^-1 r and log|1 + w D w| of m blocks (m, c, c) and (m, c), for several widths w each.

    Args:
        D: (m, c, c) positive semi-definite.
        r: (m, c).
        widths: (sizes, m, c) prior standard deviations, or (sizes, 1, 1) where all have the same.

    Returns:
        Two arrays (sizes, m).
    """
    pull = r * widths
    if r.shape[1] == 1:
        widened = 1 + np.maximum(D[:, :, 0], 0.0) * widths**2
        return (pull**2 / widened)[..., 0], np.log(widened)[..., 0]
    try:
        return _factorised(D, pull, widths)
    except np.linalg.LinAlgError:  # of a noise near nothing: rounding makes the smallest eigenvalues negative
        eigenvalues, vectors = np.linalg.eigh(D * widths[..., :, None] * widths[..., None, :])
        widened = 1 + np.maximum(eigenvalues, 0.0)
        u2 = np.einsum("smij,smi->smj", vectors, pull) ** 2
        return np.sum(u2 / widened, axis=2), np.sum(np.log(widened), axis=2)


def _factorised(D: Array, pull: Array, widths: Array) -> tuple[Array, Array]:
    """By a factorisation of each block (sizes, m, c, c); with the pull as one more row it holds factor^-1 pull, too."""
    c = pull.shape[2]
    bordered = np.empty((*pull.shape[:2], c + 1, c + 1))
    scaled = np.multiply(D, widths[..., :, None], out=bordered[:, :, :c, :c])
    scaled *= widths[..., None, :]
    bordered.reshape(*pull.shape[:2], -1)[:, :, : c * (c + 1) : c + 2] += 1
    bordered[:, :, c, :c] = pull  # of a symmetric matrix the lower half is read
    bordered[:, :, c, c] = 1 + 2 * (pull**2).sum(axis=2)  # any number that keeps it positive definite
    factor = np.linalg.cholesky(bordered)
    diagonal = factor.diagonal(axis1=2, axis2=3)[:, :, :c]
    return (factor[:, :, c, :c] ** 2).sum(axis=2), 2 * np.log(diagonal).sum(axis=2)


def profiled_gain(quadratic: Array, chi2: float, n: float, noise: float, least: float) -> Array:
    """Gain of log likelihood when chi2 falls by ``quadratic`` and the noise follows, not below its least value.

    Args:
        quadratic: by how much chi2 falls; any shape.
        chi2: of the hypothesis, in units of its noise.
        n: measured numbers.
        noise: of the hypothesis, mm.
        least: the noise is not taken to be below this, mm.

    Returns:
        Nats, shaped as ``quadratic``.
    """
    chi2 = max(chi2, NUMERICS.nothing_left * n)
    remaining = np.maximum(chi2 - quadratic, 1e-9 * chi2)
    ratio = np.maximum(np.sqrt(remaining / chi2), min(1.0, least / noise))
    return np.asarray(-n * np.log(ratio) + 0.5 * chi2 - 0.5 * remaining / ratio**2)


def profiled_loss(lost: float, n: float) -> float:
    """What is lost when the noise grows to take up some of what n residuals lose at a noise that stays, nats."""
    return n / 2 * float(np.log1p(2 * max(lost, 0.0) / n))
