"""A load that is there in some cells of a run: sums of each cell, by which any set of cells is judged at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.linear_algebra import lower_cholesky, solve_lower
from armscope.motion.library.change_constants import CHANGE
from armscope.motion.library.for_a_while import OF_A_LOAD

LOAD = len(OF_A_LOAD)


@dataclass(frozen=True, eq=False)
class JointRows:
    """Of one joint in one run of K rows."""

    at: Indices  # (p,) which of the columns in use it has
    X: Array  # (K, p) these columns
    L: Array  # (K, 4) those of a load, N m per unit
    # y, row: (K,) torque beyond the nominal, and how much each row counts
    y: Array
    row: Array
    # A, b: (p, p) and (p,) sums of the columns with each other and with the torque
    A: Array
    b: Array


class Cells:
    """Cells of a run, as many rows in each, with the sums of their rows.

    Args:
        joints: the rows.
        columns: how many are in use.
    """

    def __init__(self, joints: Sequence[JointRows], columns: int) -> None:
        rows = len(joints[0].y)
        self.count = int(np.clip(rows // CHANGE.least_rows, 2, CHANGE.cells))
        self.bounds = np.linspace(0, rows, self.count + 1).astype(int)
        self.columns, self.at = columns, [own.at for own in joints]
        self.sums = [[self._sums(own, slice(*bounds)) for bounds in self._spans()] for own in joints]

    def _spans(self) -> list[tuple[int, int]]:
        return list(zip(self.bounds[:-1].tolist(), self.bounds[1:].tolist(), strict=True))

    @staticmethod
    def _sums(own: JointRows, some: slice) -> tuple[Array, Array, Array]:
        weighted = own.row[some, None] * own.L[some]
        return own.X[some].T @ weighted, own.L[some].T @ weighted, weighted.T @ own.y[some]

    def rows(self, there: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(K,) of cells (C,)."""
        return np.repeat(there, np.diff(self.bounds))

    def with_another_spell(
        self, there: NDArray[np.bool_], unit: Array, sums: tuple[Array, Array, Array], prior: Array
    ) -> tuple[NDArray[np.bool_], float]:
        """The cells in which a load explains most when it comes or goes in one row of cells more.

        Args:
            there: (C,) where it is so far.
            unit: (m,) what a square of torque is worth at each joint, nats doubled.
            sums: (P, P), (P,) and (P,) of the columns in use, with each other and with the torque, and their priors.
            prior: (4,) of the load.

        Returns:
            (C,) where it then is, and by how many nats more it explains.
        """
        A, b, ridge = sums
        factor = lower_cholesky(A, ridge)
        whole = solve_lower(factor, b)
        XL, LL, Ly = self._weighed(unit)
        Z = solve_lower(factor, XL.transpose(1, 0, 2).reshape(self.columns, -1))
        Z = Z.reshape(self.columns, self.count, LOAD).transpose(1, 0, 2)
        low, high = np.triu_indices(self.count + 1, 1)
        turned = np.where(there, -1.0, 1.0)
        z, S, v = (self._of_spells(each, there, turned, low, high) for each in (Z, LL, Ly))
        S = S - np.einsum("kpa,kpb->kab", z, z, optimize=True) + np.diag(prior)
        v = v - np.einsum("kpa,p->ka", z, whole, optimize=True)
        gained = np.einsum("ka,ka->k", v, np.linalg.solve(S, v[:, :, None])[:, :, 0]) / 2
        *gained, so_far = gained
        more = np.r_[0, np.cumsum(turned)]
        counts = there.sum() + more[high] - more[low]
        never = (counts == 0) | (counts == self.count)  # a load all the time does not change
        best = int(np.argmax(np.where(never, -np.inf, gained)))
        found = there.copy()
        found[low[best] : high[best]] ^= True
        return found, float(gained[best] - so_far)

    def _weighed(self, unit: Array) -> tuple[Array, Array, Array]:
        """(C, P, 4), (C, 4, 4), (C, 4) sums of all joints."""
        XL = np.zeros((self.count, self.columns, LOAD))
        LL, Ly = np.zeros((self.count, LOAD, LOAD)), np.zeros((self.count, LOAD))
        for worth, at, cells in zip(unit, self.at, self.sums, strict=True):
            for c, (xl, ll, ly) in enumerate(cells):
                XL[c, at] += worth * xl
                LL[c] += worth * ll
                Ly[c] += worth * ly
        return XL, LL, Ly

    @staticmethod
    def _of_spells(cells: Array, there: NDArray[np.bool_], turned: Array, low: Indices, high: Indices) -> Array:
        """(S + 1, ...) sums over where the load is when it comes or goes in each row of cells; the last as it is."""
        shape = (-1, *[1] * (cells.ndim - 1))
        so_far = cells[there].sum(axis=0)
        along = np.cumsum(np.concatenate([np.zeros_like(cells[:1]), turned.reshape(shape) * cells]), axis=0)
        return np.concatenate([so_far + along[high] - along[low], so_far[None]])
