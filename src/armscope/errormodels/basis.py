"""The coordinates in which a swarm looks for coefficients, and the exact way back to the paper's own.

A model's columns can be taken as they come (raw), standardised (mean 0, standard deviation 1, except for the constant),
or made orthonormal by a QR decomposition (each column of mean square 1). All three span the same functions; raw
coefficients c follow from coordinates z by c = T z with an upper triangular T. In each, for N rows,

    fitness^2 = mean square residual = |U z - b|^2 + rest      with U upper triangular (the identity in the QR basis).

Columns that can't be told from earlier ones (collinear, or more columns than rows) are dropped and named; their raw
coefficients are 0. Dropping, not the minimum norm, because every other coefficient keeps its plain meaning.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy.linalg

from armscope.core.types import Array

COLLINEAR = 1e-9  # a column is dropped if less than this share of it lies outside the span of those before it


class BasisKind(StrEnum):
    """Which coordinates the swarm searches in."""

    RAW = "raw"
    STANDARDISED = "standardised"
    QR = "qr"


@dataclass(frozen=True)
class Basis:
    """The coordinates of one model on one set of rows; n terms of which m are kept."""

    kind: BasisKind
    dropped: tuple[str, ...]  # the names of the terms that can't be told from earlier ones
    to_raw: Array  # T, n x m (rows of dropped terms are 0)
    triangular: Array  # U, m x m
    orthonormal: Array  # the N x m columns of mean square 1 in which b is measured

    @property
    def dimensions(self) -> int:
        """m, the number of coordinates."""
        return int(self.triangular.shape[0])

    def targets(self, errors: Array) -> tuple[Array, Array]:
        """b (axes x m) and the unexplainable mean square (axes) for ``errors`` (N x axes)."""
        targets = errors.T @ self.orthonormal / len(errors)
        rests = np.mean(np.square(errors - self.orthonormal @ targets.T), axis=0)
        return targets, rests

    def half_widths(self, errors: Array) -> Array:
        """The search box |z_k| <= w_k, axes x m, for ``errors`` (N x axes): RMS(errors) / RMS(column k).

        No coefficient is larger than that if its term works alone (Cauchy-Schwarz). In the QR basis terms do work
        alone, so the box always holds the least-squares solution; elsewhere collinear terms may need coefficients
        outside of it. That is no hindrance, since the box says where particles start and does not confine them; the
        larger box that always holds the solution, RMS(errors) x |row k of U^-1|, leaves the swarm farther from it.
        """
        rms_errors = np.sqrt(np.mean(np.square(errors), axis=0))
        rms_columns = np.linalg.norm(self.triangular, axis=0)
        return np.asarray(rms_errors[:, None] / rms_columns)

    def residual_rms(self, errors: Array, coordinates: Array) -> Array:
        """(S x axes) RMS residual of ``errors`` (N x axes) at coordinates z (S x axes x m)."""
        targets, rests = self.targets(errors)
        gaps = coordinates @ self.triangular.T - targets
        return np.asarray(np.sqrt(np.sum(gaps**2, axis=2) + rests))

    def raw_coefficients(self, coordinates: Array) -> Array:
        """Raw coefficients (... x n) of coordinates z (... x m)."""
        return coordinates @ self.to_raw.T


def make_basis(kind: BasisKind | str, columns: Array, names: Sequence[str]) -> Basis:
    """The basis of a model's ``columns`` (N x n, the first constant) named ``names``.

    Args:
        kind: one of `BasisKind`.
        columns: N x n, the model's terms at the identification rows, the first constant.
        names: n, of the terms.

    Returns:
        The basis; terms that others imply are dropped and named in it.

    Raises:
        ValueError: a first column that is not constant, an unknown kind, or numbers that are not finite.
    """
    kind = BasisKind(kind)
    if not np.isfinite(columns).all():
        raise ValueError("columns that are not finite: the powers of some input exceed the largest number")
    if np.any(columns[:, 0] != 1):
        raise ValueError("first column is not 1 throughout: a model's first term must be the constant")
    means, scales = _standardisation(columns)
    standardised = (columns - means) / scales
    kept = _independent(standardised)
    columns_kept = standardised[:, kept]
    q, r = np.linalg.qr(columns_kept)
    signs = np.where(np.diag(r) < 0, -1.0, 1.0)
    orthonormal = q * signs * np.sqrt(len(columns))
    triangular = r * signs[:, None] / np.sqrt(len(columns))
    # raw columns = standardised columns @ shift, with the constant first: [[1, means], [0, diag(scales)]]
    shift = np.diag(scales[kept])
    shift[0, 1:] = means[kept][1:]
    if kind is BasisKind.RAW:
        to_kept, factor = np.eye(len(kept)), triangular @ shift
    elif kind is BasisKind.STANDARDISED:
        to_kept, factor = scipy.linalg.solve_triangular(shift, np.eye(len(kept))), triangular
    else:
        to_kept, factor = scipy.linalg.solve_triangular(triangular @ shift, np.eye(len(kept))), np.eye(len(kept))
    to_raw = np.zeros((columns.shape[1], len(kept)))
    to_raw[kept] = to_kept
    dropped = tuple(name for k, name in enumerate(names) if k not in kept)
    return Basis(kind, dropped, to_raw, np.triu(factor), orthonormal)


def _standardisation(columns: Array) -> tuple[Array, Array]:
    means, scales = columns.mean(axis=0), columns.std(axis=0)
    means[0], scales[0] = 0.0, 1.0
    scales[scales == 0] = 1.0
    return means, scales


def _independent(columns: Array) -> list[int]:
    """The columns that add something to those before them, by modified Gram-Schmidt, done twice for accuracy."""
    kept: list[int] = []
    directions = np.empty((columns.shape[0], 0))
    for k in range(columns.shape[1]):
        column = columns[:, k]
        beyond = column
        for _ in range(2):
            beyond = beyond - directions @ (directions.T @ beyond)
        size, left = np.linalg.norm(column), np.linalg.norm(beyond)
        if size > 0 and left > COLLINEAR * size and len(kept) < columns.shape[0]:
            kept.append(k)
            directions = np.column_stack([directions, beyond / left])
    return kept
