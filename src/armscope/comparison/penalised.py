"""Rows fitted by columns with a penalty on each, and what is left of them."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.inference.linear_algebra import lower_cholesky, lower_inverse


def held_values(rows: Array, columns: Array, penalty: Array) -> Array:
    """Of each column, by least squares.

    Args:
        rows: (n,) what is fitted.
        columns: (n, p) by these.
        penalty: (p,) on the square of each value.

    Returns:
        (p,) the values.
    """
    stacked = np.vstack([columns, np.diag(np.sqrt(penalty))])
    return np.asarray(np.linalg.lstsq(stacked, np.concatenate([rows, np.zeros(len(penalty))]))[0])


def variance_left(rows: Array, columns: Array, penalty: Array, gram: Array | None = None) -> tuple[float, float]:
    """How much is left of all rows together.

    Args:
        rows: (n,) what is fitted.
        columns: (n, p) by these.
        penalty: (p,) on the square of each value.
        gram: (p, p) of the columns, where it is known.

    Returns:
        Variance per number, and how many numbers are free.
    """
    gram = columns.T @ columns if gram is None else gram
    penalty = np.maximum(penalty, NUMERICS.rounding * gram.diagonal())  # few rows are fitted exactly
    half = lower_inverse(lower_cholesky(gram, penalty))
    values = half.T @ (half @ (columns.T @ rows))
    left = rows - columns @ values
    used = len(penalty) - float(np.sum(half**2 @ penalty))
    free = max(len(left) - used, 1.0)
    return float((left @ left + values**2 @ penalty) / free), free


def left_of_groups(rows: Array, columns: Array, penalty: Array, group: Indices) -> tuple[Array, Array]:
    """What is left of rows, and how many numbers of each group of them are free.

    Args:
        rows: (n,) what is fitted.
        columns: (n, p) by these.
        penalty: (p,) on the square of each value.
        group: (n,) the number of each row's group.

    Returns:
        (n,) what is left, and a number for each group, at least 1.
    """
    hat = np.linalg.solve(columns.T @ columns + np.diag(penalty), columns.T)
    free = np.bincount(group, 1 - np.einsum("ij,ji->i", columns, hat))
    return rows - columns @ (hat @ rows), np.maximum(free, 1.0)
