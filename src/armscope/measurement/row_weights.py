"""How much each row counts: a weight, and a whitening where rows scatter along known directions."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array, Indices
from armscope.measurement import robust
from armscope.physics.lens import Lens

INLIER_WEIGHT = 0.5
"""Rows with a smaller part of their clean weight do not count as measurements."""


FINEST_TURN_RAD = 1e-6
"""No instrument resolves less: orientations that fit better are as good as that."""


@dataclass(frozen=True, eq=False)
class Missed:
    """What a model leaves of N rows, base axes.

    Attributes:
        shift: (N, 3) mm.
        turn: (N, 3) rad, NaN where the orientation was not measured; None where it was not in any row.
    """

    shift: Array
    turn: Array | None = None


@dataclass(frozen=True, eq=False)
class RowNoise:
    """What is known of N rows' noise beside its size.

    Attributes:
        uncertainty: (N,) relative to the usual row's.
        independence_weight: (N,) of an independent row that each stands for: a pose visited again is no new pose.
    """

    uncertainty: Array
    independence_weight: Array

    @property
    def nominal_weight(self) -> Array:
        """(N,) weights of rows that are no bad shots."""
        return np.asarray(self.independence_weight / self.uncertainty**2)

    def weights(self, missed: Missed, least: float, whitening: Array | None = None) -> RowWeights:
        """Weights against what a fitted model leaves, its shifts whitened."""
        white = RowWeights(self.nominal_weight, whitening).whitened(missed.shift)
        return self._weights(robust.quartic_weights, white, missed.turn, least, whitening)

    def first_weights(self, missed: Missed, least: float) -> RowWeights:
        """Weights while structure may still be in the residuals."""
        return self._weights(robust.huber_weights, missed.shift, missed.turn, least, None)

    def _weights(
        self, rule: robust.Rule, white: Array, turn: Array | None, least: float, whitening: Array | None
    ) -> RowWeights:
        row = rule(white, self.uncertainty, least) * self.independence_weight
        shifts = RowWeights(row, whitening, self.nominal_weight, self.independence_weight)
        if turn is None:
            return shifts
        known = np.isfinite(turn).all(axis=1)
        clean = np.where(known, self.independence_weight, 0.0)
        of_turns = clean.copy()
        of_turns[known] *= rule(turn[known], np.ones(int(known.sum())), FINEST_TURN_RAD)
        noise = robust.scale_of(white / self.uncertainty[:, None], least)
        lever = 1e-3 * noise / robust.scale_of(turn[known], FINEST_TURN_RAD)
        return replace(shifts, turns=RowWeights(of_turns, None, clean, self.independence_weight), lever=lever)


@dataclass(frozen=True, eq=False)
class RowWeights:
    """Weights of N rows.

    Attributes:
        weight: (N,) weights.
        whitening: (N, 3, 3) of each row's shift, or None.
        nominal_weight: (N,) the weights if no row were a bad shot; None: ones.
        independence_weight: (N,) of an independent row that each row stands for; None: ones.
        turns: weights of the rows' orientations, 0 where not measured; None: orientations don't count.
        lever: m/rad by which a turn counts beside a shift: the ratio of their noises.
    """

    weight: Array
    whitening: Array | None = None
    nominal_weight: Array | None = None
    independence_weight: Array | None = None
    turns: RowWeights | None = None
    lever: float = 0.0

    @property
    def robust_weight(self) -> Array:
        """(N,) 1 for rows that look like the others, less for bad shots."""
        return self.weight if self.nominal_weight is None else np.asarray(self.weight / self.nominal_weight)

    def count(self, rows: Indices) -> Array:
        """(n,) how many independent measurements each of ``rows`` is: none, if it looks like a bad shot."""
        clean = 1.0 if self.nominal_weight is None else self.nominal_weight[rows]
        share = np.ones(len(rows)) if self.independence_weight is None else self.independence_weight[rows]
        return np.where(self.weight[rows] > INLIER_WEIGHT * clean, share, 0.0)

    def numbers(self, rows: Indices) -> Array:
        """(n,) how many independent numbers each of ``rows`` holds."""
        shifts = 3 * self.count(rows)
        return shifts if self.turns is None else shifts + 3 * self.turns.count(rows)

    def lens(self, rows: Indices) -> Lens:
        """W^1/2 of ``rows``: roots of the weights, times the whitening and the lever."""
        root = np.sqrt(self.weight[rows])[:, None, None]
        shift = root * (np.eye(3) if self.whitening is None else self.whitening[rows])
        return Lens(shift, None if self.turns is None else self.lever * np.sqrt(self.turns.weight[rows]))

    @property
    def of_points(self) -> RowWeights:
        """The weights of the points alone, as they are measured: without whitening and orientations."""
        return replace(self, whitening=None, turns=None)

    def take(self, rows: Indices, share: float = 1.0) -> RowWeights:
        """The weights of some rows, each standing for 1 / ``share`` rows."""
        white, clean, independent = (
            None if x is None else x[rows] for x in (self.whitening, self.nominal_weight, self.independence_weight)
        )
        turns = None if self.turns is None else self.turns.take(rows, share)
        clean = None if clean is None else clean / share
        return RowWeights(self.weight[rows] / share, white, clean, independent, turns, self.lever)

    def whitened(self, residuals: Array) -> Array:
        """Residuals (N, 3) without the known scatter."""
        if self.whitening is None:
            return residuals
        white: Array = (self.whitening @ residuals[:, :, None])[:, :, 0]
        return white
