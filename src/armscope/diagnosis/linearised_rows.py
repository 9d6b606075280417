"""Rows at the point where columns were taken: what any values of the columns leave of them, without another model."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array, Indices
from armscope.fitting.design_matrix import columns, structured_design
from armscope.fitting.linearisation import LinearisedTable
from armscope.fitting.parameter_layout import ParameterLayout, current_parameters
from armscope.measurement.constants import WEIGHTS
from armscope.measurement.row_weights import RowWeights
from armscope.measurement.whitening import WhitenedPosture, Whitener
from armscope.physics.effect import Term
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings


@dataclass(frozen=True, eq=False)
class LinearisedRows:
    """Rows at a point of linearisation."""

    point: FittedModel  # the model at which columns were taken
    table: LinearisedTable  # the rows, with what is already known of them
    weights: RowWeights  # of the fit
    layout: ParameterLayout  # of the columns
    # columns that were fitted, but foretell nothing of other rows: readings are judged without them
    untold: Indices = field(default_factory=lambda: np.empty(0, dtype=np.intp))

    def some(self, which: Indices) -> LinearisedRows:
        """Some of the rows."""
        if len(which) == len(self.table):
            return self
        return replace(self, table=self.table.rows(which), weights=self.weights.take(which))

    @property
    def recordings(self) -> Recordings:
        """The rows as they were recorded."""
        return self.table.recordings

    @property
    def slices(self) -> dict[str, slice]:
        """Where the numbers of each channel stand in a row."""
        ends = itertools.accumulate((channel.width for channel in self.weights.channels), initial=0)
        return {c.name: slice(*at) for c, at in zip(self.weights.channels, itertools.pairwise(ends), strict=True)}

    @property
    def width(self) -> int:
        """How many numbers a row has in all channels."""
        return sum(channel.width for channel in self.weights.channels)

    @property
    def trusted(self) -> NDArray[np.bool_]:
        """(N,) rows that do not look like bad shots."""
        return np.asarray(self.weights.robust_weight > WEIGHTS.inlier_weight)

    def unweighted_columns(self, terms: Sequence[Term], at: Indices | None = None) -> Array:
        """(N c, p) displacements and turns of the tool by unit terms, mm and mrad per SI unit.

        Returns:
            A row's numbers in all channels stand together.
        """
        table = self.table if at is None else self.table.rows(at)
        found = np.empty((len(table), self.width, len(terms)))
        for part, posture in table.chunks(self.point):
            X = columns(WhitenedPosture.plain(posture, self.weights.channels), terms)
            found[part] = X.reshape(len(part), self.width, -1)
        return found.reshape(-1, len(terms))

    def residuals(self, values: Array, number: Indices | None = None) -> Array:
        """(K, N, c) what K readings leave of every row in all channels, base axes, mm and mrad; NaN where not measured.

        Args:
            values: (K, p) values of the layout's terms, SI units; or (F, K, p): each row takes those of its ``number``.
            number: (N,) 0 ... F - 1.

        Returns:
            The residuals.
        """
        values = values if number is not None else values[None]
        number = np.zeros(len(self.recordings), dtype=np.intp) if number is None else number
        values = values.copy()
        values[:, :, self.untold] = 0.0
        column_order, current = self.layout.column_order, current_parameters(self.layout, self.point)
        added = (values - current)[:, :, column_order.order]
        left = np.empty((values.shape[1], len(self.recordings), self.width))
        for part, posture in self.table.chunks(self.point):
            plain = Whitener.plain(self.weights.channels, len(part))
            seen = structured_design(WhitenedPosture(posture, plain), column_order)
            y = plain.response(self.point, posture)
            for f in np.unique(number[part]):
                inside = np.flatnonzero(number[part] == f)
                modelled = seen.at(inside).matvec(added[f])
                left[:, part[inside]] = y[inside] - np.swapaxes(modelled, 1, 2)
        for channel in self.weights.channels:
            left[:, ~channel.measured(self.recordings), self.slices[channel.name]] = np.nan
        return left
