"""Fitting error models by particle swarm: all models, axes, robots and seeds of a study in one batch.

In the layout "per axis" each axis has a swarm of its own: the axes share no coefficient, so that the split is exact.
In the layout "joint" one swarm looks for all 3 n coefficients and minimises the RMS of the error vector: "15 dimensions
in this case", as section 5 of the paper has it.
"""

from __future__ import annotations

import functools
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from armscope.core.types import Array
from armscope.errormodels.basis import Basis, BasisKind, make_basis
from armscope.errormodels.features import FeatureSet, ModelSpec, checked_inputs, fit_least_squares
from armscope.errormodels.fitted import Layout, SwarmFit
from armscope.swarm.least_squares import minimise_least_squares
from armscope.swarm.least_squares_objective import LeastSquares
from armscope.swarm.random_search import random_search
from armscope.swarm.result import SwarmResult
from armscope.swarm.settings import SwarmSettings

Search = Callable[[LeastSquares, Array, Array, list[np.random.Generator]], SwarmResult]


@dataclass(frozen=True)
class FitProblem:
    """One model to fit to one set of identification rows.

    Args:
        spec: the model.
        inputs: N x k: nominal tool positions in mm, or commanded joint angles in rad, as ``spec.space`` says.
        errors_mm: measured minus nominal (Eq. 8): N x 3 (axes x, y, z) or N.
        label: whose rows; with the model's name and the seed it sets the random numbers.
    """

    spec: ModelSpec
    inputs: ArrayLike
    errors_mm: ArrayLike
    label: str = ""


def fit_swarms(
    problems: Sequence[FitProblem],
    seeds: Sequence[int],
    settings: SwarmSettings | None = None,
    basis: BasisKind | str = BasisKind.QR,
    engine: str = "auto",
    layout: Layout | str = Layout.PER_AXIS,
) -> list[SwarmFit]:
    """Fit every problem by swarms, one per seed and axis, or one per seed.

    A fit depends on its own problem, label, seed and settings only, not on what else is in the batch or in which order.

    Args:
        problems: what to fit.
        seeds: at least one; the same seed gives the same fit.
        settings: of the swarm; the threshold is in mm.
        basis: the coordinates to search in; the search box follows from the data (`Basis.half_widths`).
        engine: see `minimise_least_squares`.
        layout: what one swarm looks for.

    Returns:
        One fit per problem, in the order of the problems, with every seed's coefficients.

    Raises:
        ValueError: problems, seeds or settings that can't be used.
    """
    settings = settings or SwarmSettings()
    search = functools.partial(minimise_least_squares, settings=settings, engine=engine)
    return _fit(problems, seeds, _Job("swarm", BasisKind(basis), Layout(layout), settings.particles), search)


def fit_random_search(
    problems: Sequence[FitProblem],
    seeds: Sequence[int],
    settings: SwarmSettings | None = None,
    basis: BasisKind | str = BasisKind.QR,
    layout: Layout | str = Layout.PER_AXIS,
) -> list[SwarmFit]:
    """The baseline: as `fit_swarms`, in the same box, with as many evaluations, but of independent random points.

    Args:
        problems: what to fit.
        seeds: at least one; the same seed gives the same fit.
        settings: of the swarm that it stands beside; the threshold is in mm.
        basis: the coordinates to search in.
        layout: what one search looks for.

    Returns:
        One fit per problem, in the order of the problems.

    Raises:
        ValueError: as `fit_swarms`.
    """
    settings = settings or SwarmSettings()
    search = functools.partial(random_search, settings=settings)
    return _fit(problems, seeds, _Job("random search", BasisKind(basis), Layout(layout), settings.particles), search)


class _Job(NamedTuple):
    """What searches, in which coordinates, for how many axes together, with how many evaluations per iteration."""

    method: str
    kind: BasisKind
    layout: Layout
    particles: int


@dataclass(frozen=True)
class _Prepared:
    """One problem in the coordinates of its basis, and its least-squares solution."""

    problem: FitProblem
    features: FeatureSet
    errors: Array
    basis: Basis
    layout: Layout
    least_squares: Array
    least_squares_mm: Array

    @property
    def axes(self) -> tuple[str, ...]:
        return ("x", "y", "z") if self.errors.shape[1] == 3 else ("error",)

    @property
    def swarms_per_seed(self) -> int:
        return len(self.axes) if self.layout is Layout.PER_AXIS else 1

    @property
    def dimensions(self) -> int:
        """Of one swarm."""
        return self.basis.dimensions * len(self.axes) // self.swarms_per_seed

    @property
    def factor(self) -> Array:
        """R of one swarm's objective |R z - b|^2 + rest: the basis's, once for each axis on the diagonal if joint."""
        axes_together = np.eye(len(self.axes) // self.swarms_per_seed)
        return np.asarray(np.kron(axes_together, self.basis.triangular), dtype=float)

    def of_one_seed(self) -> tuple[Array, Array, Array]:
        """b (H x D), rest (H) and half the width of the search box (H x D) of the swarms of one seed."""
        target, rest = self.basis.targets(self.errors)
        shape = (self.swarms_per_seed, self.dimensions)
        box = self.basis.half_widths(self.errors)
        return target.reshape(shape), rest.reshape(self.swarms_per_seed, -1).sum(axis=1), box.reshape(shape)

    def generators(self, seeds: Sequence[int]) -> list[np.random.Generator]:
        """One per swarm, seeds first; keyed by label and model, so that neighbours in a batch don't matter."""
        key = zlib.crc32(f"{self.problem.label}|{self.problem.spec.name}".encode())
        return [
            np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(key, swarm))))
            for seed in seeds
            for swarm in range(self.swarms_per_seed)
        ]


def _checked_errors(problem: FitProblem) -> Array:
    rows, errors = len(checked_inputs(problem.inputs)), np.asarray(problem.errors_mm, dtype=float)
    if errors.ndim == 1:
        errors = errors[:, None]
    if errors.ndim != 2 or errors.shape[1] not in (1, 3) or len(errors) != rows:
        raise ValueError(
            f"errors of shape {np.shape(problem.errors_mm)} for {rows} rows of inputs: must be rows x 3, or rows"
        )
    if not np.isfinite(errors).all():
        row = int(np.argwhere(~np.isfinite(errors))[0, 0])
        raise ValueError(f"error {errors[row]!r} in row {row}: all must be finite")
    return errors


def _prepared(problems: Sequence[FitProblem], job: _Job) -> list[_Prepared]:
    """All problems in their order; those of one model on the very same rows share their basis."""
    on_same_rows: dict[tuple[ModelSpec, int], list[int]] = {}
    for k, problem in enumerate(problems):
        on_same_rows.setdefault((problem.spec, id(problem.inputs)), []).append(k)
    prepared: dict[int, _Prepared] = {}
    for (spec, _), members in on_same_rows.items():
        inputs = checked_inputs(problems[members[0]].inputs)
        features = spec.features(inputs)
        basis = make_basis(job.kind, features.matrix(inputs), features.term_names)
        errors = [_checked_errors(problems[k]) for k in members]
        coefficients, rms = fit_least_squares(features, inputs, np.hstack(errors))
        first = 0
        for k, mine in zip(members, errors, strict=True):
            axes = slice(first, first + mine.shape[1])
            prepared[k] = _Prepared(problems[k], features, mine, basis, job.layout, coefficients[axes], rms[axes])
            first = axes.stop
    return [prepared[k] for k in range(len(problems))]


def _fit(problems: Sequence[FitProblem], seeds: Sequence[int], job: _Job, search: Search) -> list[SwarmFit]:
    if not len(problems):
        return []
    if not len(seeds) or len(set(seeds)) < len(seeds) or any(seed < 0 for seed in seeds):
        raise ValueError(f"seeds = {list(seeds)!r}: must be different whole numbers, 0 or more, at least one")
    prepared = _prepared(problems, job)
    fitted: dict[int, SwarmFit] = {}
    for dimensions in sorted({each.dimensions for each in prepared}):
        chosen = [k for k, each in enumerate(prepared) if each.dimensions == dimensions]
        result = _search_together([prepared[k] for k in chosen], seeds, search)
        first = 0
        for k in chosen:
            swarms = slice(first, first + len(seeds) * prepared[k].swarms_per_seed)
            fitted[k] = _fitted(prepared[k], seeds, result, swarms, job)
            first = swarms.stop
    return [fitted[k] for k in range(len(problems))]


def _search_together(group: list[_Prepared], seeds: Sequence[int], search: Search) -> SwarmResult:
    """One batch for problems with equally many coordinates: problem by problem, seed by seed, axis by axis."""
    targets, rests, widths, factor_of, generators = [], [], [], [], []
    for number, each in enumerate(group):
        target, rest, width = each.of_one_seed()
        targets.append(np.tile(target, (len(seeds), 1)))
        rests.append(np.tile(rest, len(seeds)))
        widths.append(np.tile(width, (len(seeds), 1)))
        factor_of.append(np.full(len(seeds) * each.swarms_per_seed, number))
        generators += each.generators(seeds)
    objective = LeastSquares(
        np.stack([each.factor for each in group]),
        np.concatenate(factor_of),
        np.concatenate(targets),
        np.concatenate(rests),
    )
    box = np.concatenate(widths)
    return search(objective, -box, box, generators)


def _fitted(each: _Prepared, seeds: Sequence[int], result: SwarmResult, swarms: slice, job: _Job) -> SwarmFit:
    shape = (len(seeds), each.swarms_per_seed)
    coordinates = result.positions[swarms].reshape(len(seeds), len(each.axes), -1)
    fitness = result.fitness[swarms].reshape(shape)
    return SwarmFit(
        label=each.problem.label,
        features=each.features,
        basis=each.basis.kind,
        method=job.method,
        seeds=tuple(int(seed) for seed in seeds),
        axes=each.axes,
        dropped=each.basis.dropped,
        coefficients=each.basis.raw_coefficients(coordinates),
        fitness_mm=fitness if each.layout is Layout.PER_AXIS else each.basis.residual_rms(each.errors, coordinates),
        least_squares=each.least_squares,
        least_squares_mm=each.least_squares_mm,
        reasons=result.reasons[swarms].reshape(shape),
        iterations=result.iterations[swarms].reshape(shape),
        history_mm=result.history[swarms].reshape(*shape, -1),
        rows=len(each.errors),
        particles=job.particles,
        layout=each.layout,
    )
