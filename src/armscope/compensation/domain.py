"""Where a model holds: the range of the data it was identified from, and how far outside a point lies.

Every input (motor angles, nominal positions, payload, temperature) is standardised: minus its mean, over its standard
deviation. The domain is the intersection of all slabs "lowest <= direction . z <= highest" over the axes and, for
every two inputs of one kind that move, the directions (e_i +- e_j) / sqrt 2: an outer bound of the data's convex hull
with the hull's exact extent in these directions. It catches what single ranges miss (joints that moved in lockstep),
costs one matrix product, and suits designs that sit in the corners of the workspace, where the distance to the nearest
recorded row says little; that distance is stated beside it.

Of sixty rows drawn alike one in four lies outside such a bound of the others. So as much is allowed as recorded rows
lie outside of all other recorded rows: more than nine of ten poses of the same kind are inside.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armscope.compensation.constants import RANGE
from armscope.core.types import Array


@dataclass(frozen=True, eq=False)
class Domain:
    """The range of M identification rows in k inputs."""

    # inputs, units: (k) names of the inputs, and their units, keys of `RANGE.still`
    inputs: tuple[str, ...]
    units: tuple[str, ...]
    rows: int
    # mean, scale: (k,) in these units
    mean: Array
    scale: Array
    moving: NDArray[np.bool_]  # (k,) whether the input moved in the data
    # low, high: (d,) extent along each direction, in standard deviations
    low: Array
    high: Array
    standardised_rows: Array  # (M', k) rows less their mean, over the scale
    allowed: float = RANGE.allowed  # how far outside a point may lie, in standard deviations

    @staticmethod
    def of(inputs: ArrayLike, names: Sequence[str], units: Sequence[str]) -> Domain:
        """The domain of identification rows ``inputs`` (M, k).

        Args:
            inputs: (M, k) identification rows.
            names: (k,) of the inputs.
            units: (k,) of the inputs.

        Returns:
            Their means, spreads and ranges, and a thinned copy for distances to the nearest row.
        """
        table = np.asarray(inputs, dtype=float)
        tolerances = np.array([RANGE.still[unit] for unit in units])
        moving = np.ptp(table, axis=0) > tolerances
        scale = np.where(moving, table.std(axis=0), np.inf)
        mean = table.mean(axis=0)
        directions = _directions(moving, units)
        allowed = max(RANGE.allowed, _beyond_the_others((table - mean) / scale, directions))
        # a still input's unit makes its tolerance the allowed distance
        scale = np.where(moving, scale, tolerances / allowed)
        low, high = np.full(len(directions), np.inf), np.full(len(directions), -np.inf)
        for start in range(0, len(table), RANGE.rows_at_a_time):
            extent = (table[start : start + RANGE.rows_at_a_time] - mean) / scale @ directions.T
            low, high = np.minimum(low, extent.min(axis=0)), np.maximum(high, extent.max(axis=0))
        thin = (table[:: _every(len(table))] - mean) / scale
        return Domain(tuple(names), tuple(units), len(table), mean, scale, moving, low, high, thin, allowed)

    def outside(self, inputs: ArrayLike) -> tuple[Array, NDArray[np.object_]]:
        """How far (N,) rows (N, k) lie outside, in standard deviations (0 inside), and what does most ("" inside)."""
        table, directions = np.asarray(inputs, dtype=float), _directions(self.moving, self.units)
        distance, worst = np.zeros(len(table)), np.zeros(len(table), dtype=np.intp)
        for start in range(0, len(table), RANGE.rows_at_a_time):  # there are many directions
            at = slice(start, start + RANGE.rows_at_a_time)
            extent = (table[at] - self.mean) / self.scale @ directions.T
            excess = np.maximum(np.maximum(self.low - extent, extent - self.high), 0.0)
            distance[at], worst[at] = excess.max(axis=1), np.argmax(excess, axis=1)
        labels = np.array(_labels(self.inputs, self.moving, self.units), dtype=object)
        return distance, np.where(distance > 0, labels[worst], "")

    def nearest(self, inputs: ArrayLike) -> Array:
        """(N,) distance to the nearest identification row, in standard deviations per input (root mean square)."""
        from scipy.spatial import cKDTree  # slow to import, and whoever writes a domain asks no distance

        z = (np.asarray(inputs, dtype=float) - self.mean) / self.scale
        distance: Array = cKDTree(self.standardised_rows).query(z)[0] / np.sqrt(len(self.inputs))
        return distance

    def still(self, unit: str) -> dict[str, float]:
        """Inputs of a unit that stood still, with their values."""
        return {
            name: float(value)
            for name, of, value, moves in zip(self.inputs, self.units, self.mean, self.moving, strict=True)
            if of == unit and not moves
        }

    def value(self, name: str) -> float:
        """The mean of an input."""
        return float(self.mean[self.inputs.index(name)])

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        said = {**vars(self), "standardised_rows": self.standardised_rows.round(4)}
        return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in said.items()}

    @staticmethod
    def from_dict(content: dict[str, Any]) -> Domain:
        """The inverse of `to_dict`."""
        known: dict[str, Any] = {
            name: np.array(content[name], dtype=float) for name in ("mean", "scale", "low", "high", "standardised_rows")
        }
        known["moving"] = np.array(content["moving"], dtype=bool)
        return Domain(**content | known)


def _beyond_the_others(standardised: Array, directions: Array) -> float:
    """What 95 of 100 rows (M, k), thinned, lie at most outside the bound of all others, in standard deviations."""
    extent = standardised[:: _every(len(standardised))] @ directions.T
    if len(extent) < 2:
        return 0.0
    lone = np.zeros(len(extent))
    for side in (extent, -extent):
        second, first = np.partition(side, -2, axis=0)[-2:]
        np.maximum.at(lone, side.argmax(axis=0), first - second)
    return float(np.quantile(lone, RANGE.alike, method="lower"))


def _every(rows: int) -> int:
    """Every how manieth row of a long table is kept."""
    return -(-rows // RANGE.neighbours)


def count_directions(moving: NDArray[np.bool_], units: Sequence[str]) -> int:
    """In how many directions a domain of such inputs has an extent."""
    return len(moving) + 2 * len(_pairs(moving, units))


def _pairs(moving: NDArray[np.bool_], units: Sequence[str]) -> list[tuple[int, int]]:
    """Inputs of one kind: that the hall warmed up while joint 1 turned to the right need not hold on another day."""
    return [(i, j) for i, j in combinations(np.flatnonzero(moving).tolist(), 2) if units[i] == units[j]]


def _directions(moving: NDArray[np.bool_], units: Sequence[str]) -> Array:
    """(d, k) unit directions: the axes, then sum and difference of every two inputs of one kind that move."""
    axes = np.eye(len(moving))
    pairs = [(axes[i] + sign * axes[j]) / np.sqrt(2) for i, j in _pairs(moving, units) for sign in (1, -1)]
    return np.array([*axes, *pairs])


def _labels(names: Sequence[str], moving: NDArray[np.bool_], units: Sequence[str]) -> list[str]:
    return [*names, *(f"{names[i]} together with {names[j]}" for i, j in _pairs(moving, units) for _ in (1, -1))]
