"""A model's frames, background and effects as a problem for Gauss-Newton: exact residuals, robust weights, priors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.constants import STEPS
from armscope.fitting.gauss_newton import NonlinearProblem, Quadratic
from armscope.fitting.linearisation import Measured, linearised, residuals
from armscope.fitting.parameter_layout import ParameterLayout, current_parameters
from armscope.inference.normal_equations import NormalEquations, steadied
from armscope.measurement import robust
from armscope.measurement.channel import ChannelResiduals, retracted
from armscope.measurement.row_weights import RowWeights
from armscope.physics.effect import Part
from armscope.physics.model import FittedModel


class ModelFit(NonlinearProblem[FittedModel, ChannelResiduals]):
    """A model's frames, background and effects fitted to recordings with the exact model; noise found on the way.

    Args:
        parts: the columns that are fitted: all of the model's.
        rows: a table, or recordings.
        weigh: weights of the rows by what the model leaves.
        precision: (p,) prior precisions, SI units, by the columns' sums.
        least_noise: mm; 0 where nothing is known.
        negligible: steps end when residuals (RMS) move by less than this share of what the noise leaves uncertain.
    """

    may_grow = 1.5

    def __init__(
        self,
        parts: ParameterLayout,
        rows: Measured,
        weigh: Callable[[ChannelResiduals], RowWeights],
        precision: Callable[[NormalEquations], Array],
        least_noise: float,
        negligible: float,
    ) -> None:
        self.parts, self.table = parts, linearised(rows)
        self.weigh, self.prior = weigh, precision
        self.noise = self.least_noise = least_noise
        self.negligible = negligible
        self.steps_mm: list[float] = []
        self.known: NormalEquations | None = None
        """Sums where the fit starts, if they are known."""
        self.weights: RowWeights
        self.equations: NormalEquations
        self.precision: Array
        self.solved: Quadratic
        self.effective_dof: float

    def residual(self, state: FittedModel) -> ChannelResiduals:
        """What a model leaves of every row, mm and rad."""
        return residuals(state, self.table)

    def quadratic(self, state: FittedModel, residual: ChannelResiduals) -> Quadratic:
        """Sums over weighted rows; with the noise that they leave once all is fitted."""
        self.steps_mm.append(np.inf)
        self.weights = self.weigh(residual)
        self.equations = self.sums(state)
        noise = self.noise or robust.scale_of(residual.points_mm)
        self.precision = self.prior(self.equations)
        self.solved = solved = Quadratic(
            steadied(self.equations, self.parts.frames).G + np.diag(noise**2 * self.precision),
            self.equations.b,
            current_parameters(self.parts, state),
        )
        self.effective_dof = float(len(self.precision) - noise**2 * solved.variances @ self.precision)
        left = self.equations.rss(solved.values)
        self.noise = max(float(np.sqrt(max(left, 0.0) / max(self.equations.n - self.effective_dof, 1.0))), 1e-9)
        return solved

    def sums(self, state: FittedModel) -> NormalEquations:
        """Over the weighted rows, linearised about a state."""
        known, self.known = self.known, None
        if known is not None:
            return known
        blocks = np.zeros(len(self.table), dtype=np.intp)
        return normal_equations_by_block(self.parts, state, self.table, self.weights, blocks)[0]

    def misfit(self, state: FittedModel, residual: ChannelResiduals) -> float:
        """The usual row's size, whatever its weight."""
        return robust.scale_of(residual.points_mm)

    def moved(self, state: FittedModel, step: Array) -> FittedModel:
        """The model a step further; frame columns are increments where it stands."""
        values = current_parameters(self.parts, state) + step
        moved = retracted(self.table.channels, state, dict(zip(self.parts.terms, step, strict=True)))
        background, parts = (
            tuple(Part(part.placed, values[self.parts.of(part.placed)]) for part in some)
            for some in (state.background, state.parts)
        )
        return replace(moved, background=background, parts=parts)

    def settled(self, before: ChannelResiduals, after: ChannelResiduals) -> bool:
        """Whether points move by next to nothing beside what noise leaves uncertain.

        Of a long table it is enough that they will: each step is as much less than the last as that one was.
        """
        uncertain = self.noise * np.sqrt(self.effective_dof / max(self.equations.n, 1.0))
        moved = self.steps_mm[-1] = float(np.sqrt(np.mean((after.points_mm - before.points_mm) ** 2)))
        if len(self.table) > STEPS.quickly_passed and len(self.steps_mm) > 1:
            shrunk = moved / self.steps_mm[-2]
            moved *= shrunk / (1 - shrunk) if shrunk < STEPS.steady else 1.0
        return bool(moved < max(STEPS.converged_mm, self.negligible * uncertain))
