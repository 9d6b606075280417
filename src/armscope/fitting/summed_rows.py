"""An exact fit to a long table of which the sums at a point nearby are known: one pass over all rows, at its end.

Sums over all rows at a near point say where the fit ends but for what is not linear on the way there: how the
model bends, and rows whose weights change. That is little, and a few thousand rows tell it (a control variate; near the
surrogate likelihood of Jordan, Lee & Yang 2019, but with the curvature of all rows). Values then lie within a small
part of their standard error of where passes over all rows lead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from armscope.core.types import Array, Indices
from armscope.fitting.block_sums import normal_equations_by_block, slope_at
from armscope.fitting.constants import STEPS
from armscope.fitting.linearisation import LinearisedTable, residuals
from armscope.fitting.model_fit import ModelFit
from armscope.fitting.parameter_layout import ParameterLayout, current_parameters
from armscope.inference.normal_equations import NormalEquations
from armscope.measurement import robust
from armscope.measurement.channel import ChannelResiduals
from armscope.measurement.row_weights import RowNoise, RowWeights
from armscope.physics.model import FittedModel
from armscope.recordings.some_rows import some_rows, standing_for

Weigher = Callable[[ChannelResiduals], RowWeights]


@dataclass(eq=False)
class SummedRows:
    """The N rows of a long table, and sums over all of them.

    Of a table that is not so long that passes over it can't be afforded, the sums save the first of them alone.
    """

    table: LinearisedTable  # the rows
    layout: ParameterLayout  # of the p columns that were summed up
    point: FittedModel  # where they were linearised
    equations: NormalEquations  # the sums, mm per SI unit
    some: Indices  # (n,) numbers of the rows that tell what is not linear
    standing_for: Array  # (n,) how many rows each of them stands for
    on_the_way: bool = False  # whether a fit is not the last one: what it leaves is then told of these rows alone
    sample: LinearisedTable = field(init=False, repr=False)
    _linear: NormalEquations | None = field(default=None, init=False, repr=False)

    @classmethod
    def of(
        cls,
        table: LinearisedTable,
        layout: ParameterLayout,
        point: FittedModel,
        equations: NormalEquations,
        of_each: int,
    ) -> SummedRows:
        """A table with its sums, and rows spread over it that tell what is not linear.

        Args:
            table: N rows.
            layout: of the p columns that were summed up.
            point: where they were linearised.
            equations: the sums, mm per SI unit.
            of_each: rows of every run and target among them at least.

        Returns:
            Both.
        """
        some = some_rows(table.recordings, STEPS.telling_rows, of_each)
        return cls(table, layout, point, equations, some, standing_for(table.recordings, some))

    @classmethod
    def few(
        cls, table: LinearisedTable, layout: ParameterLayout, point: FittedModel, equations: NormalEquations
    ) -> SummedRows:
        """A table that is short enough for fits to pass over all its rows, with its sums.

        Args:
            table: N rows.
            layout: of the p columns that were summed up.
            point: where they were linearised.
            equations: the sums, mm per SI unit.

        Returns:
            Both.
        """
        return cls(table, layout, point, equations, np.arange(len(table)), np.ones(len(table)))

    def __post_init__(self) -> None:
        if self.are_passed_over:
            self.sample = self.table
            return
        rows = self.table.recordings.rows(self.some)
        self.sample = LinearisedTable(rows, self.table.channels, np.arange(len(self.some)))

    @property
    def are_passed_over(self) -> bool:
        """Whether a fit passes over all rows."""
        return len(self.some) == len(self.table)

    def among(self, parts: ParameterLayout, sums: NormalEquations | None = None) -> NormalEquations:
        """The sums, or others of the same columns, of some of the columns alone."""
        at, whole = np.array([self.layout.index[term] for term in parts.terms]), sums or self.equations
        return NormalEquations(whole.G[np.ix_(at, at)], whole.b[at], whole.yy, whole.n)

    def weigher(self, noise: RowNoise, least_mm: float, whitening: Array | None) -> Weigher:
        """Weights of the rows that stand for all, by what a model leaves of them.

        Args:
            noise: of all rows.
            least_mm: below which noise is not taken to be.
            whitening: (N, 3, 3) of all rows that scatter along known directions, or None.

        Returns:
            From residuals of n rows to their weights.
        """
        some = RowNoise(noise.uncertainty[self.some], noise.independence_weight[self.some] * self.standing_for)
        white = None if whitening is None else whitening[self.some]
        return lambda left: some.weights(left, least_mm, white)

    def of_some(self, weigh: Weigher) -> NormalEquations:
        """Sums over the rows that stand for all, linearised where all were."""
        if self._linear is None:
            weights = weigh(residuals(self.point, self.sample))
            one = np.zeros(len(self.some), dtype=np.intp)
            self._linear = normal_equations_by_block(self.layout, self.point, self.sample, weights, one)[0]
        return self._linear


class SummedFit(ModelFit):
    """A model fitted to rows whose sums are known near by: some rows say what is not linear, all rows the rest.

    Args:
        parts: the columns that are fitted; the sums hold them all.
        rows: with sums at the point where the fit starts.
        weigh: weights of the rows that stand for all, by what the model leaves of them.
        precision: (p,) prior precisions, SI units, by the columns' sums.
        least_noise: mm; 0 where nothing is known.
    """

    def __init__(
        self,
        parts: ParameterLayout,
        rows: SummedRows,
        weigh: Weigher,
        precision: Callable[[NormalEquations], Array],
        least_noise: float,
    ) -> None:
        super().__init__(parts, rows.sample, weigh, precision, least_noise, STEPS.converged_share)
        self.rows = rows
        self.whole, self.linear = rows.among(parts), rows.among(parts, rows.of_some(weigh))
        self.gone: tuple[FittedModel | None, Array] = None, np.zeros(len(parts.terms))
        self.values = np.zeros(len(parts.terms))

    def moved(self, state: FittedModel, step: Array) -> FittedModel:
        """The model a step further, and how far it has gone from the point."""
        there = super().moved(state, step)
        self.gone = there, self.values + step
        return there

    def sums(self, state: FittedModel) -> NormalEquations:
        """Over all rows about a state: their sums at the point, and what some rows say is not linear since."""
        here = slope_at(self.parts, state, self.table, self.weights)
        at = current_parameters(self.parts, state)
        started = state is not self.gone[0]
        # frames count from where they are, in their own axes; from the point they have gone the sum of their steps
        self.values = at if started else self.gone[1]
        left = self.whole.rss(at) if started else self.equations.rss(self.solved.values)
        bent = here.b - _slope(self.linear, self.values)
        b = _slope(self.whole, self.values) + bent + self.whole.G @ at
        return NormalEquations(self.whole.G, b, left + float((2 * b - self.whole.G @ at) @ at), self.whole.n)

    def holds_for(self, everything: ChannelResiduals, some: ChannelResiduals) -> bool:
        """Whether the model leaves as little of all rows as of those that stood for them."""
        left, told = (robust.scale_of(each.points_mm) for each in (everything, some))
        return left <= self.may_grow * told


def _slope(sums: NormalEquations, values: Array) -> Array:
    """(p,) half of what squares fall by per unit of each value."""
    return np.asarray(sums.b - sums.G @ values)
