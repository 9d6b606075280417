"""How much: all chosen effects together with frames and background, with the exact model and robust weights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.fitting.constants import STEPS
from armscope.fitting.gauge import NamedFrames, covariance_of_others, gauge
from armscope.fitting.gauss_newton import SETTLED, gauss_newton
from armscope.fitting.linearisation import Measured, residuals
from armscope.fitting.model_fit import ModelFit
from armscope.fitting.parameter_layout import ParameterLayout, parameter_layout
from armscope.fitting.summed_rows import SummedFit, SummedRows
from armscope.inference.constants import PRIORS
from armscope.inference.normal_equations import NormalEquations, column_scales
from armscope.measurement.channel import ChannelResiduals
from armscope.measurement.row_weights import RowNoise, RowWeights
from armscope.physics.effect import Part, Placed
from armscope.physics.model import FittedModel
from armscope.physics.parallel_axes import lengths_told_once


@dataclass(frozen=True, eq=False)
class Refit:
    """An exact fit."""

    model: FittedModel  # the fitted model
    layout: ParameterLayout  # of the frames, background and effects that were fitted
    equations: NormalEquations  # the normal equations at the solution, mm per SI unit
    precision: Array  # (p,) prior precision of all values, SI units
    covariance: Array  # (p, p) of all values, SI units
    noise: float  # mm per axis
    effective_dof: float  # effective number of fitted values
    weights: RowWeights  # of the rows, in every channel
    channel_residuals: ChannelResiduals  # what the model leaves of every row, by channel

    @property
    def residuals(self) -> Array:
        """(N, 3) mm, base axes."""
        return self.channel_residuals.points_mm

    def covariance_of(self, placed: Placed) -> Array:
        """Covariance of one effect's terms, SI units."""
        at = self.layout.of(placed)
        return np.asarray(self.covariance[np.ix_(at, at)])


# so many parameters: what is fitted (four), to what (one), and how its rows count (three)
def refit(
    model: FittedModel,
    rows: Measured | SummedRows,
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
        rows: a table, or recordings; or a long table with sums over all rows at a point: the model, or where others of
            its fits started. On the way to its last fit residuals and weights are of the rows that stand for it.
        frames: always free.
        backgrounds: per family (effects, share of their tolerances); families of size 0 are left out.
        effects: (effect, size at the tool, mm).
        row_noise: relative uncertainty of the rows, and which are independent.
        least_noise: mm; the noise is never taken to be below.
        whitening: (N, 3, 3) of rows that scatter along known directions.

    Returns:
        The fitted model, its weights, noise and covariance.
    """
    apart = lengths_told_once(model.arm, [_apart(placed, effects) for placed, _ in effects])
    effects = [(placed, size) for placed, (_, size) in zip(apart, effects, strict=True)]
    named = {term for placed, _ in effects for term in placed.terms}
    kept = [[b for placed in family if size and (b := placed.without(named))] for family, size in backgrounds]
    background = [placed for family in kept for placed in family]
    parts = parameter_layout(frames, kept, [placed for placed, _ in effects])
    start = _start(model, background, effects)

    def weigh(left: ChannelResiduals) -> RowWeights:
        return row_noise.weights(left, least_noise, whitening)

    def prior(equations: NormalEquations) -> Array:
        return _precision(parts, equations, [size for _, size in backgrounds], effects)

    if isinstance(rows, SummedRows) and not rows.are_passed_over:
        some = SummedFit(parts, rows, rows.weigher(row_noise, least_noise, whitening), prior, least_noise)
        found = gauss_newton(some, start, STEPS.refit)
        if rows.on_the_way:
            return _ended(some, found.state, found.residual, some.weights, some.table)
        left = residuals(found.state, rows.table)
        if found.reason == SETTLED and some.holds_for(left, found.residual):
            return _ended(some, found.state, left, weigh(left), rows.table)
    table = rows.table if isinstance(rows, SummedRows) else rows
    problem = ModelFit(parts, table, weigh, prior, least_noise, STEPS.converged_share)
    most_steps = STEPS.refit if len(table) <= STEPS.quickly_passed else STEPS.refit_of_many_rows
    if isinstance(rows, SummedRows):
        problem.known = rows.among(parts) if model is rows.point else None
        most_steps = STEPS.on_the_way if rows.on_the_way else most_steps
    found = gauss_newton(problem, start, most_steps)
    return _ended(problem, found.state, found.residual, problem.weights, problem.table)


def _ended(
    problem: ModelFit, model: FittedModel, left: ChannelResiduals, weights: RowWeights, table: Measured
) -> Refit:
    """What a fit ended in; a lucky residual does not make the instrument better than it is known to be."""
    noise = max(problem.noise, problem.least_noise)
    found = Refit(
        replace(model, undetermined=()),
        problem.parts,
        problem.equations,
        problem.precision,
        noise**2 * problem.solved.inverse,
        problem.noise,
        problem.effective_dof,
        weights,
        left,
    )
    return _with_tools_as_stated(problem, found, noise, table)


def _with_tools_as_stated(problem: ModelFit, found: Refit, noise: float, table: Measured) -> Refit:
    """A fit with tool points as stated where its rows do not tell them from the base, which then takes what they had.

    What the fit's steps held frames by where they stood is no reason for a tool to stay away from where it is stated.
    """
    at = NamedFrames.among(problem.parts.terms, problem.parts.frames)
    if not len(at.tools):
        return found
    known = {
        term: value for part in found.model.tools for term, value in zip(part.placed.terms, part.values, strict=True)
    }
    deviation = np.array([known[problem.parts.terms[column]] for column in at.tools])
    precision = found.precision.copy()
    precision[at.tools] = 0.0
    matrix = problem.equations.G + noise**2 * np.diag(precision)
    held = gauge(matrix, problem.equations.G, at, deviation, noise)
    if held is None:
        return found
    model = replace(problem.moved(found.model, held.step), undetermined=at.told(held))
    return replace(
        found,
        model=model,
        covariance=noise**2 * covariance_of_others(problem.solved.matrix, at.tools, held.directions),
        channel_residuals=residuals(model, table),
    )


def _apart(placed: Placed, effects: Sequence[tuple[Placed, float]]) -> Placed:
    """A free curve without the terms that a named effect has, which is then the rest of it; others as they are."""
    if placed.parametrisation != "curve":
        return placed
    named = {t for other, _ in effects if other.parametrisation != "curve" for t in other.terms}
    return placed.without(named) or placed


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
