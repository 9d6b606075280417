"""How much: all chosen effects together with frames and background, with the exact model and robust weights."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.constants import STEPS
from armscope.fitting.gauss_newton import NonlinearProblem, Quadratic, gauss_newton
from armscope.fitting.linearisation import Measured, linearised, residuals
from armscope.fitting.parameter_layout import ParameterLayout, current_parameters, parameter_layout
from armscope.inference.constants import PRIORS
from armscope.inference.normal_equations import NormalEquations, column_scales
from armscope.measurement import robust
from armscope.measurement.channel import ChannelResiduals, retracted
from armscope.measurement.row_weights import RowNoise, RowWeights
from armscope.physics.effect import Placed, Term
from armscope.physics.model import FittedModel
from armscope.physics.scene import Part


@dataclass(frozen=True, eq=False)
class Refit:
    """An exact fit.

    Attributes:
        model: the fitted model.
        layout: of the frames, background and effects that were fitted.
        equations: the normal equations at the solution, mm per SI unit.
        precision: (p,) prior precision of all values, SI units.
        covariance: (p, p) of all values, SI units.
        noise: mm per axis.
        effective_dof: effective number of fitted values.
        weights: of the rows, in every channel.
        channel_residuals: what the model leaves of every row, by channel.
    """

    model: FittedModel
    layout: ParameterLayout
    equations: NormalEquations
    precision: Array
    covariance: Array
    noise: float
    effective_dof: float
    weights: RowWeights
    channel_residuals: ChannelResiduals

    @property
    def residuals(self) -> Array:
        """(N, 3) mm, base axes."""
        return self.channel_residuals.points_mm

    def covariance_of(self, placed: Placed) -> Array:
        """Covariance of one effect's terms, SI units."""
        at = self.layout.of(placed)
        return np.asarray(self.covariance[np.ix_(at, at)])


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
        self.noise, self.negligible = least_noise, negligible
        self.steps_mm: list[float] = []
        self.weights: RowWeights
        self.equations: NormalEquations
        self.precision: Array
        self.inverse: Array
        self.effective_dof: float

    def residual(self, state: FittedModel) -> ChannelResiduals:
        """What a model leaves of every row, mm and rad."""
        return residuals(state, self.table)

    def quadratic(self, state: FittedModel, residual: ChannelResiduals) -> Quadratic:
        """Sums over weighted rows; with the noise that they leave once all is fitted."""
        self.steps_mm.append(np.inf)
        self.weights = self.weigh(residual)
        blocks = np.zeros(len(self.table), dtype=np.intp)
        self.equations = normal_equations_by_block(self.parts, state, self.table, self.weights, blocks)[0]
        noise = self.noise or robust.scale_of(residual.points_mm)
        self.precision = self.prior(self.equations)
        solved = Quadratic(
            self.equations.G + np.diag(noise**2 * self.precision),
            self.equations.b,
            current_parameters(self.parts, state),
        )
        self.inverse = solved.inverse
        self.effective_dof = float(len(self.precision) - noise**2 * np.sum(np.diag(solved.inverse) * self.precision))
        left = self.equations.rss(solved.values)
        self.noise = max(float(np.sqrt(max(left, 0.0) / max(self.equations.n - self.effective_dof, 1.0))), 1e-9)
        return solved

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
        if len(self.table) > STEPS.kept_rows and len(self.steps_mm) > 1:
            shrunk = moved / self.steps_mm[-2]
            moved *= shrunk / (1 - shrunk) if shrunk < STEPS.steady else 1.0
        return bool(moved < max(STEPS.converged_mm, self.negligible * uncertain))


# so many parameters: what is fitted (four), to what (one), and how its rows count (three)
def refit(
    model: FittedModel,
    rows: Measured,
    frames: Sequence[Placed],
    backgrounds: Sequence[tuple[Sequence[Placed], float]],
    effects: Sequence[tuple[Placed, float]],
    row_noise: RowNoise,
    least_noise: float,
    whitening: Array | None = None,
) -> Refit:
    """Gauss-Newton on the exact model, weights and noise re-estimated at each step.

    Args:
        model: where to start from; its effects are replaced.
        rows: a table, or recordings.
        frames: always free.
        backgrounds: per family (effects, share of their tolerances); families of size 0 are left out.
        effects: (effect, size at the tool, mm).
        row_noise: relative uncertainty of the rows, and which are independent.
        least_noise: mm; the noise is never taken to be below.
        whitening: (N, 3, 3) of rows that scatter along known directions.

    Returns:
        The fitted model, its weights, noise and covariance.
    """
    effects = [(_apart(placed, effects), size) for placed, size in effects]
    named = {term for placed, _ in effects for term in placed.terms}
    kept = [[b for placed in family if size and (b := _without(placed, named))] for family, size in backgrounds]
    background = [placed for family in kept for placed in family]
    parts = parameter_layout(frames, kept, [placed for placed, _ in effects])
    problem = ModelFit(
        parts,
        rows,
        lambda left: row_noise.weights(left, least_noise, whitening),
        lambda equations: _precision(parts, equations, [size for _, size in backgrounds], effects),
        least_noise,
        STEPS.converged_share,
    )
    found = gauss_newton(problem, _start(model, background, effects), STEPS.refit)
    # a lucky residual does not make the instrument better than it is known to be
    covariance = max(problem.noise, least_noise) ** 2 * problem.inverse
    return Refit(
        found.state, parts, problem.equations, problem.precision, covariance,
        problem.noise, problem.effective_dof, problem.weights, found.residual,
    )  # fmt: skip


def _without(placed: Placed, named: set[Term]) -> Placed | None:
    """A background effect without the terms that a named effect has: one term, one value."""
    kept = [n for n, term in enumerate(placed.terms) if term not in named]
    if not kept:
        return None
    return replace(
        placed, terms=tuple(placed.terms[n] for n in kept), prior_scale=tuple(placed.prior_scale[n] for n in kept)
    )


def _apart(placed: Placed, effects: Sequence[tuple[Placed, float]]) -> Placed:
    """A free curve without the terms that a named effect has, which is then the rest of it; others as they are."""
    if placed.parametrisation != "curve":
        return placed
    return (
        _without(placed, {t for other, _ in effects if other.parametrisation != "curve" for t in other.terms}) or placed
    )


def _start(model: FittedModel, background: Sequence[Placed], effects: Sequence[tuple[Placed, float]]) -> FittedModel:
    """The model with the new set of effects, values taken over where a term was there before."""
    known = {
        term: value
        for part in (*model.background, *model.parts)
        for term, value in zip(part.placed.terms, part.values, strict=True)
    }

    def part(placed: Placed) -> Part:
        return Part(placed, np.array([known.get(term, 0.0) for term in placed.terms]))

    return replace(
        model, background=tuple(part(p) for p in background), parts=tuple(part(placed) for placed, _ in effects)
    )


def _precision(
    parts: ParameterLayout, equations: NormalEquations, sizes: Sequence[float], effects: Sequence[tuple[Placed, float]]
) -> Array:
    """(p,) prior precisions in SI units."""
    scale = column_scales(equations, parts.frames)
    variance = np.full(len(parts.terms), np.inf)
    for columns, tolerance, size in zip(parts.background, parts.background_scale, sizes, strict=True):
        variance[columns] = (size * tolerance) ** 2
    for (placed, size), at in zip(effects, parts.columns, strict=True):
        wide = 1.0 if placed.partly_unseen else STEPS.free
        variance[at] = (wide * size * np.array(placed.prior_scale) / scale[at]) ** 2
        # nor farther than frames go, however much of it they would absorb
        variance[at] = np.minimum(
            variance[at], PRIORS.frame_mm**2 * equations.n / np.maximum(np.diag(equations.G)[at], 1e-24)
        )
    inside = np.unique(np.concatenate([*parts.background, *parts.columns])) if parts.columns else np.empty(0, np.intp)
    variance[inside] = np.minimum(variance[inside], np.array([parts.terms[n].prior_size for n in inside]) ** 2)
    variance[parts.frames] = (PRIORS.frame_mm / scale[parts.frames]) ** 2
    return np.asarray(1 / variance)
