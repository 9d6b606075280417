"""How much: all chosen effects together with frames and background, with the exact model and robust weights."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.core.types import Array
from armscope.fitting.linearisation import current_parameters, missed, normal_equations_by_block
from armscope.fitting.parameter_layout import ParameterLayout, parameter_layout
from armscope.fitting.registration import moved_base
from armscope.inference.normal_equations import NormalEquations, column_scales
from armscope.inference.problem import FRAME_PRIOR_MM
from armscope.measurement import robust
from armscope.measurement.row_weights import Missed, RowNoise, RowWeights
from armscope.physics.backgrounds import TOLERANCE
from armscope.physics.effect import AXES, Placed, Term
from armscope.physics.frames import ToolKey, tool_key
from armscope.physics.model import FittedModel
from armscope.physics.scene import Part
from armscope.recordings import Recordings

STEPS = 6
CONVERGED_MM, CONVERGED = 1e-6, 0.05
"""Steps end when residuals (RMS) move by less: mm, or this share of what the noise leaves uncertain anyway."""
LEADS_AWAY, SHORTEST_STEP = 1.5, 0.1
"""A step that makes the residual this many times larger is halved, down to this share of it."""
FREE = 10.0
"""A named effect's values are held by a prior this many times wider than its size: freely, but not where poses hardly
tell it."""


@dataclass(frozen=True, eq=False)
class Refit:
    """An exact fit.

    Attributes:
        model: the fitted model.
        pool: frames, background and effects that were fitted.
        gram: at the solution, mm per SI unit.
        precision: (p,) prior precision of all values, SI units.
        covariance: (p, p) of all values, SI units.
        noise: mm per axis.
        spent: effective number of fitted values.
        missed: what the model leaves.
    """

    model: FittedModel
    pool: ParameterLayout
    gram: NormalEquations
    precision: Array
    covariance: Array
    noise: float
    spent: float
    weights: RowWeights
    missed: Missed

    @property
    def residuals(self) -> Array:
        """(N, 3) mm, base axes."""
        return self.missed.shift

    def covariance_of(self, placed: Placed) -> Array:
        """Covariance of one effect's terms, SI units."""
        at = self.pool.of(placed)
        return np.asarray(self.covariance[np.ix_(at, at)])


def refit(
    model: FittedModel,
    recordings: Recordings,
    frames: Sequence[Placed],
    backgrounds: Sequence[tuple[Sequence[Placed], float]],
    effects: Sequence[tuple[Placed, float]],
    rows: RowNoise,
    least_noise: float,
    whitening: Array | None = None,
) -> Refit:
    """Gauss-Newton on the exact model, weights and noise re-estimated at each step.

    Args:
        model: where to start from; its effects are replaced.
        backgrounds: per family (effects, size): a share of the tolerance for the first, mm at the tool for the others;
            families of size 0 are left out.
        effects: (effect, size at the tool, mm).
        rows: relative uncertainty of the rows, and which are independent.
        whitening: (N, 3, 3) of rows that scatter along known directions.
    """
    named = {term for placed, _ in effects for term in placed.terms}
    kept = [[b for placed in family if size and (b := _without(placed, named))] for family, size in backgrounds]
    background = [placed for family in kept for placed in family]
    parts = parameter_layout(frames, kept, [placed for placed, _ in effects])
    model = _start(model, background, effects)
    blocks = np.zeros(len(recordings), dtype=np.intp)
    noise = least_noise
    left = missed(model, recordings)
    for _ in range(STEPS):
        weights = rows.weights(left, least_noise, whitening)
        gram = normal_equations_by_block(parts, model, recordings, weights, blocks)[0]
        noise = noise or robust.scale_of(left.shift)
        precision = _precision(parts, gram, [size for _, size in backgrounds], effects)
        A = gram.G + np.diag(noise**2 * precision)
        values, covariance = _solve(A, gram.b)
        spent = float(len(values) - noise**2 * np.sum(np.diag(covariance) * precision))
        misfit = gram.rss(values)
        noise = max(float(np.sqrt(max(misfit, 0.0) / max(gram.n - spent, 1.0))), 1e-9)
        before = left
        model, left = _not_worse(partial(_updated, model, parts, background, effects, values), recordings, left)
        uncertain = noise * np.sqrt(spent / max(gram.n, 1.0))
        if np.sqrt(np.mean((left.shift - before.shift) ** 2)) < max(CONVERGED_MM, CONVERGED * uncertain):
            break
    # a lucky residual does not make the instrument better than it is known to be
    covariance = max(noise, least_noise) ** 2 * covariance
    return Refit(model, parts, gram, precision, covariance, noise, spent, weights, left)


def _not_worse(
    updated: Callable[[float], FittedModel], recordings: Recordings, left: Missed
) -> tuple[FittedModel, Missed]:
    """The model after a step that is shortened until it does not lead away, and what it leaves."""
    share, here = 1.0, robust.scale_of(left.shift)
    while True:
        model = updated(share)
        new = missed(model, recordings)
        if share < SHORTEST_STEP or robust.scale_of(new.shift) < LEADS_AWAY * here:
            return model, new
        share /= 2


def _without(placed: Placed, named: set[Term]) -> Placed | None:
    """A background effect without the terms that a named effect has: one term, one value."""
    kept = [n for n, term in enumerate(placed.terms) if term not in named]
    if not kept:
        return None
    return replace(
        placed, terms=tuple(placed.terms[n] for n in kept), prior_scale=tuple(placed.prior_scale[n] for n in kept)
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
    parts: ParameterLayout, gram: NormalEquations, sizes: Sequence[float], effects: Sequence[tuple[Placed, float]]
) -> Array:
    """(p,) prior precisions in SI units."""
    scale = column_scales(gram, parts.frames)
    variance = np.full(len(parts.terms), np.inf)
    for number, (columns, shape, size) in enumerate(zip(parts.background, parts.background_scale, sizes, strict=True)):
        variance[columns] = (size * TOLERANCE) ** 2 if number == 0 else (size * shape / scale[columns]) ** 2
    for (placed, size), at in zip(effects, parts.columns, strict=True):
        wide = 1.0 if placed.partly_unseen else FREE
        variance[at] = (wide * size * np.array(placed.prior_scale) / scale[at]) ** 2
        # nor farther than frames go, however much of it they would absorb
        variance[at] = np.minimum(variance[at], FRAME_PRIOR_MM**2 * gram.n / np.maximum(np.diag(gram.G)[at], 1e-24))
    variance[parts.frames] = (FRAME_PRIOR_MM / scale[parts.frames]) ** 2
    return np.asarray(1 / variance)


def _solve(A: Array, b: Array) -> tuple[Array, Array]:
    """(A^-1 b, A^-1), equilibrated first: SI units differ by many powers of ten."""
    d = 1 / np.sqrt(np.diag(A))
    inverse = np.linalg.inv(A * np.outer(d, d)) * np.outer(d, d)
    return inverse @ b, inverse


def _updated(
    model: FittedModel,
    parts: ParameterLayout,
    background: Sequence[Placed],
    effects: Sequence[tuple[Placed, float]],
    values: Array,
    share: float,
) -> FittedModel:
    """The model with new values, or a share of the way there; frame columns are increments where it stands."""
    present = current_parameters(parts, model)
    values = present + share * (values - present)

    def new(placed: Placed) -> Array:
        return values[[parts.index[term] for term in placed.terms]]

    moved = moved_frames(model, dict(zip(parts.terms, values, strict=True)))
    return replace(
        moved,
        background=tuple(Part(p, new(p)) for p in background),
        parts=tuple(Part(placed, new(placed)) for placed, _ in effects),
    )


def moved_frames(model: FittedModel, steps: Mapping[Term, float]) -> FittedModel:
    """The model with its bases and tools moved by steps (SI units) of the free frames' terms; others don't count."""
    twists: dict[str, Array] = {}
    turns: dict[ToolKey, Array] = {}
    for term, value in steps.items():
        product = term.products[0]
        axis = AXES.index(product.direction.axis) if product.direction.axis in AXES else -1
        if product.driver.kind == "in run" and product.direction.location == "base":
            twists.setdefault(str(product.driver.arguments[0]), np.zeros(6))[axis] = value
        elif product.driver.kind.startswith("on target") and product.direction.location == "tool" and axis >= 3:
            turns.setdefault(tool_key(product.driver), np.zeros(3))[axis - 3] = value
    bases = {run: moved_base(base, twists.get(run, np.zeros(6))) for run, base in model.bases.items()}
    tools = tuple(
        Part(part.placed, part.values + np.array([steps.get(term, 0.0) for term in part.placed.terms]))
        for part in model.tools
    )
    turned = {
        key: Rotation.from_rotvec(turns.get(key, np.zeros(3))).as_matrix() @ turn
        for key, turn in model.tool_turns.items()
    }
    return replace(model, bases=bases, tools=tools, tool_turns=turned)
