"""How noisy each row is, as the residuals tell it between rounds: its weight, its distance, scatter with a place."""

from __future__ import annotations

import functools

import numpy as np

from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.diagnosis.constants import LOOP
from armscope.fitting.joint_scatter import Scattered, find_rounding, motor_jacobians, noise_between, whitening
from armscope.fitting.linearisation import LinearisedTable
from armscope.measurement import robust
from armscope.measurement.channel import ChannelResiduals
from armscope.measurement.constants import WEIGHTS
from armscope.measurement.noise import (
    Growth,
    Noise,
    distances,
    growth,
    independence_weights,
    poses,
    relative_uncertainty,
)
from armscope.measurement.row_weights import RowNoise
from armscope.physics.model import FittedModel
from armscope.recordings.resolution import angle_steps


class NoiseOfRows:
    """What is known of the rows' noise; it changes as the residuals do.

    Args:
        start: the arm with its frames fitted.
        table: the rows.
        noise: what is known of it beforehand.
        residuals: what the model leaves of every row.

    Attributes:
        rows: relative uncertainty of the rows, and which are independent.
        weights: of the rows.
        scatter: of motors that stand elsewhere each time, or whose angles are rounded.
        steps: (m,) rad, in which the motors' angles stand; 0 where in none.
        growth: with the distance, where there is such.
    """

    def __init__(self, start: FittedModel, table: LinearisedTable, noise: Noise, residuals: ChannelResiduals) -> None:
        recordings = table.recordings
        self.recordings, self.least_mm = recordings, noise.least_mm
        self.start, self.table, self.pose = start, table, poses(recordings)
        self.residuals = residuals
        self.scatter: list[Scattered] = []
        self.steps = angle_steps(recordings.motor_angles)
        self.growth: Growth | None = None
        uncertainty = relative_uncertainty(recordings, robust.scale_of(residuals.points_mm))
        near = np.ones(len(recordings), dtype=bool)
        self.rows = RowNoise(uncertainty, independence_weights(residuals.points_mm, self.pose, near))
        self.weights = self.rows.first_weights(residuals, self.least_mm)

    @functools.cached_property
    def moved(self) -> Array:
        """(m, N, 3) displacement of the tool by each motor, mm/rad: where rows scatter, or scatter is looked for."""
        return motor_jacobians(self.start, self.table)

    def follow(self, other: NoiseOfRows, residuals: ChannelResiduals, noise_mm: float) -> None:
        """Go on from what other rows told.

        Args:
            other: what was found on other rows of the same table.
            residuals: of these rows, by channel.
            noise_mm: per axis.
        """
        self.scatter, self.growth = other.scatter, other.growth
        self.weigh(residuals, noise_mm, whitening(self.scatter, self.moved, noise_mm) if self.scatter else None)

    def weigh(self, residuals: ChannelResiduals, noise_mm: float, white: Array | None) -> None:
        """What the residuals tell about the rows' noise, and their weights by it.

        Args:
            residuals: of the rows, by channel.
            noise_mm: per axis.
            white: (N, 3, 3) of rows that scatter along known directions; None where none does.
        """
        self.residuals = residuals
        by_distance = None
        if self.growth is not None:
            by_distance = self.growth.at(np.linalg.norm(self.recordings.positions, axis=1))
        uncertainty = relative_uncertainty(self.recordings, noise_mm, by_distance)
        alone = RowNoise(uncertainty, np.ones(len(uncertainty))).weights(residuals, self.least_mm)
        self.rows = RowNoise(
            uncertainty,
            independence_weights(residuals.points_mm, self.pose, alone.robust_weight > WEIGHTS.inlier_weight),
        )
        self.weights = self.rows.weights(residuals, self.least_mm, white)

    def has_changed(self, model: FittedModel, noise_mm: float) -> bool:
        """Look for noise that grows with the distance, or else for scatter; whether something new was found."""
        return self._grows(model, noise_mm) or self.scatter_has_changed()

    def scatter_has_changed(self) -> bool:
        """Look for scatter in what is left; take its whitening into account where its places or sizes are new.

        What a fit leaves that knew nothing of the scatter tells neither for good: base and tool took up a part of it.
        """
        found = self._find_scatter()
        known = {(s.motor, s.rounded): s.size for s in self.scatter}
        if {(s.motor, s.rounded) for s in found} == known.keys() and all(
            s.rounded or abs(s.size - known[s.motor, False]) <= LOOP.scatter_settled * s.size for s in found
        ):
            return False
        self._take(found)
        return True

    def look_for_scatter(self) -> None:
        """Whiten the rows by what scatter is left."""
        self._take(self._find_scatter())

    def _grows(self, model: FittedModel, noise_mm: float) -> bool:
        """Look for noise that grows with distance in what is left, where no row's own noise is stated."""
        if self.recordings.sigma is not None or self.growth is not None or self.scatter:
            return False
        away = distances(model, self.recordings)
        found = (
            None
            if away is None
            else growth(self.residuals.points_mm, away, self.weights.robust_weight > WEIGHTS.inlier_weight)
        )
        if found is None or found.evidence < sum(each.evidence for each in self._find_scatter()):
            return False
        self.growth = found
        self.weigh(self.residuals, noise_mm, self.weights.whitening)
        return True

    def _find_scatter(self) -> list[Scattered]:
        """Scatter in what is left, on as many rows as it takes."""
        left = self.residuals.points_mm
        rows = spread_evenly(len(left), LOOP.scatter_rows)
        relative = self.rows.uncertainty[rows, None]
        return find_rounding(left[rows] / relative, self.moved[:, rows] / relative, self.steps, self.least_mm)

    def _take(self, found: list[Scattered]) -> None:
        """Whiten the rows by scatter of these places and sizes, and weigh them anew."""
        self.scatter = found
        white = None
        if found:
            rows = spread_evenly(len(self.moved[0]), LOOP.scatter_rows)
            between = noise_between(self.residuals.points_mm[rows], self.moved[:, rows], found, self.least_mm)
            white = whitening(found, self.moved, between)
        self.weights = self.rows.weights(self.residuals, self.least_mm, white)
