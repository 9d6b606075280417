"""Rows fitted by columns with a penalty on each, and what is left of them."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.constants import NUMERICS
from armscope.inference.linear_algebra import lower_cholesky, lower_inverse


@dataclass(frozen=True, eq=False)
class HeldColumns:
    """Columns by which rows are fitted, with a penalty on each."""

    columns: Array  # (n, p)
    penalty: Array  # (p,) on the square of each value
    # so many of the first ones have values that are drawn from many alike, of which the penalty knows the size: they
    # are noise of another shape, and take up none of the numbers that are free
    drawn: int = 0

    @functools.cached_property
    def gram(self) -> Array:
        """(p, p)."""
        return np.asarray(self.columns.T @ self.columns)

    @functools.cached_property
    def inverse(self) -> Array:
        """(p, p) whose transpose times it is the inverse of the normal equations."""
        penalty = np.maximum(self.penalty, NUMERICS.rounding * self.gram.diagonal())  # few rows are fitted exactly
        return lower_inverse(lower_cholesky(self.gram, penalty))

    @functools.cached_property
    def half(self) -> Array:
        """(p, n) what is fitted of rows is its transpose times it times them."""
        return self.inverse @ self.columns.T

    def held(self, penalty: Array) -> HeldColumns:
        """The same columns with other penalties (p,)."""
        other = HeldColumns(self.columns, penalty, self.drawn)
        other.__dict__["gram"] = self.gram  # the dearest part, and the same
        return other

    @property
    def fixed(self) -> HeldColumns:
        """Without what is drawn."""
        # itself kept in itself would outlive its use until garbage is looked for
        return self._not_drawn if self.drawn else self

    @functools.cached_property
    def _not_drawn(self) -> HeldColumns:
        return HeldColumns(self.columns[:, self.drawn :], self.penalty[self.drawn :])

    def beyond(self, columns: Array) -> Array:
        """(n, q) what of columns (n, q) these do not fit."""
        return np.asarray(columns - self.half.T @ (self.half @ columns))

    def information(self, columns: Array) -> Array:
        """(q, q) what rows tell of columns (n, q) that are free beside these, in units of one over their variance."""
        return np.asarray(columns.T @ self.beyond(columns))


def held_values(rows: Array, base: HeldColumns) -> Array:
    """(p,) the value of each column, by least squares on rows (n,)."""
    stacked = np.vstack([base.columns, np.diag(np.sqrt(base.penalty))])
    return np.asarray(np.linalg.lstsq(stacked, np.concatenate([rows, np.zeros(len(base.penalty))]))[0])


def variance_left(rows: Array, base: HeldColumns) -> tuple[float, float]:
    """How much is left of all rows (n,) together."""
    values = base.inverse.T @ (base.inverse @ (base.columns.T @ rows))
    left = rows - base.columns @ values
    taken_up = 1 - np.sum(base.inverse**2, axis=0) * base.penalty
    free = max(len(left) - float(np.sum(taken_up[base.drawn :])), 1.0)
    return float((left @ left + values**2 @ base.penalty) / free), free


def left_of_groups(rows: Array, base: HeldColumns, group: Indices) -> tuple[Array, Array]:
    """What is left of rows, and how many numbers of each group of them are free.

    Args:
        rows: (n,) what is fitted.
        base: by this.
        group: (n,) the number of each row's group.

    Returns:
        (n,) what is left, and a number for each group, at least 1.
    """
    hat = np.linalg.solve(base.gram + np.diag(base.penalty), base.columns.T)
    free = np.bincount(group, 1 - np.einsum("ij,ji->i", base.columns, hat))
    return rows - base.columns @ (hat @ rows), np.maximum(free, 1.0)
