"""Sums over rows, joint by joint: all that evidence needs of them, and only what changed since the last ones.

From round to round few rows count otherwise and few columns are other functions: sums follow by these.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.inference.normal_equations import NormalEquations, total
from armscope.motion.constants import NOISE
from armscope.motion.fitting.rows import MotionRows


@dataclass(frozen=True, eq=False)
class JointSums:
    """Sums over the rows of one joint's torque in one run and block, each row by its weight; N m."""

    joint: int  # from 0
    run: str  # its name
    at: Indices  # (p_j,) which columns
    sums: NormalEquations  # of these columns


@dataclass(frozen=True, eq=False)
class Earlier:
    """Sums of the same rows in the same blocks, when some counted otherwise or some columns were other functions."""

    # rows, row: the rows and (K, m) how much each counted
    rows: MotionRows
    row: Array
    blocks: Sequence[Sequence[JointSums]]  # the sums


def sums_by_joint(
    rows: MotionRows, row: Array, block: Indices, earlier: Earlier | None = None
) -> list[list[JointSums]]:
    """Sums over the rows of each block, by joint; the response is the measured torque less the nominal one.

    Args:
        rows: K rows.
        row: (K, m) how much each counts.
        block: (K,) number of each row's block, from 0.
        earlier: sums to start from.

    Returns:
        Of each block those of its joints, and of its runs where causes differ by run.
    """
    runs = np.unique(rows.run) if rows.layout.differs_by_run else rows.run[:1]
    members = []
    for number in range(int(block.max()) + 1):
        inside = block == number
        there = [(str(run), inside & (rows.run == run) if len(runs) > 1 else inside) for run in runs]
        members.append([(run, which) for run, which in there if which.any()])
    known: dict[tuple[int, str, int], NormalEquations] = {}
    if earlier is not None:
        known = {(n, part.run, part.joint): part.sums for n, parts in enumerate(earlier.blocks) for part in parts}
    found: dict[tuple[int, str, int], JointSums] = {}
    for j in range(row.shape[1]):
        joint = _Joint(rows, row, j, earlier)
        for number, parts in enumerate(members):
            for run, which in parts:
                sums = joint.over(which, known.get((number, run, j)))
                found[number, run, j] = JointSums(j, run, rows.at[j], sums)
    pairs = [[(n, run, j) for run, _ in parts for j in range(row.shape[1])] for n, parts in enumerate(members)]
    return [[found[each] for each in own] for own in pairs]


def together(parts: Sequence[JointSums]) -> list[JointSums]:
    """The parts of several blocks as those of one."""
    alike: dict[tuple[str, int], list[JointSums]] = {}
    for part in parts:
        alike.setdefault((part.run, part.joint), []).append(part)
    return [replace(same[0], sums=total([part.sums for part in same])) for same in alike.values()]


class _Joint:
    """One joint's columns and response, with what of them changed."""

    def __init__(self, rows: MotionRows, row: Array, joint: int, earlier: Earlier | None) -> None:
        without = rows.pauses[joint].without
        self.columns, self.weight = without(rows.columns[joint]), row[:, joint]
        self.response = without(rows.torque[:, joint] - rows.nominal[:, joint])
        self.change, self.fresh = self.weight, np.arange(self.columns.shape[1])
        self.moved = False
        if earlier is not None:
            self.moved = not np.array_equal(earlier.rows.nominal[:, joint], rows.nominal[:, joint])
            self.change = self.weight - earlier.row[:, joint]
            old = earlier.rows.columns[joint]
            same = old is rows.columns[joint]
            self.fresh = np.flatnonzero([] if same else (old != rows.columns[joint]).any(axis=0))

    def over(self, among: NDArray[np.bool_], before: NormalEquations | None) -> NormalEquations:
        """Sums over some rows, from those that there were."""
        which, moved = np.flatnonzero(among & (self.weight > 0)), np.flatnonzero(among & (self.change != 0))
        n = float(self.weight[which].sum())
        if before is None or 2 * (len(moved) / max(len(which), 1) + len(self.fresh) / self.columns.shape[1]) > 1:
            return self._added(np.zeros((self.columns.shape[1],) * 2), which, self.weight, n)
        found = self._added(before.G.copy(), moved, self.change, n, before)
        if len(self.fresh):
            self._renew(found, which)
        return self._with_response(found, which) if self.moved else found

    def _added(
        self, G: Array, which: Indices, weight: Array, n: float, before: NormalEquations | None = None
    ) -> NormalEquations:
        """With rows by a weight, which may be below zero, added to G (p, p) and the rest of sums."""
        b, yy = (np.zeros(len(G)), 0.0) if before is None else (before.b.copy(), before.yy)
        for sign in (1, -1):
            counted = which[sign * weight[which] > 0]
            for some in np.array_split(counted, max(-(-len(counted) // NOISE.rows_at_once), 1)):
                root = np.sqrt(sign * weight[some])
                X, y = self.columns[some].astype(np.float64) * root[:, None], self.response[some] * root
                G += sign * (X.T @ X)
                b += sign * (X.T @ y)
                yy += sign * float(y @ y)
        return NormalEquations(G, b, yy, n)

    def _with_response(self, sums: NormalEquations, which: Indices) -> NormalEquations:
        """The sums, with what the response is now."""
        y = self.response[which] * self.weight[which]
        b = np.asarray(self.columns[which].T @ y, dtype=np.float64)
        return replace(sums, b=b, yy=float(y @ self.response[which]))

    def _renew(self, sums: NormalEquations, which: Indices) -> None:
        """What columns that are other functions now have with all, in place."""
        across, along = np.zeros((self.columns.shape[1], len(self.fresh))), np.zeros(len(self.fresh))
        for some in np.array_split(which, max(-(-len(which) // NOISE.rows_at_once), 1)):
            X = self.columns[some].astype(np.float64)
            own = X[:, self.fresh] * self.weight[some, None]
            across += X.T @ own
            along += own.T @ self.response[some]
        sums.G[:, self.fresh] = across
        sums.G[self.fresh] = across.T
        sums.b[self.fresh] = along
