"""Fitting error models by particle swarm: all models, axes, robots and seeds of a study in one batch.

Each axis has a swarm of its own: the axes share no coefficient, so one swarm in 3 n dimensions would look for the same
optimum with three times the dimensions.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from armscope.core.types import Array
from armscope.errormodels.basis import Basis, BasisKind, make_basis
from armscope.errormodels.features import FeatureSet, ModelSpec, checked_inputs
from armscope.errormodels.fitted import FittedModel
from armscope.errormodels.least_squares import fit_least_squares
from armscope.swarm import LeastSquares, SwarmResult, SwarmSettings, minimise_least_squares
from armscope.swarm.random_search import random_search

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
) -> list[FittedModel]:
    """Fit every problem by one swarm per axis and seed.

    A fit depends on its own problem, label, seed and settings only, not on what else is in the batch or in which order.

    Args:
        problems: what to fit.
        seeds: at least one; the same seed gives the same fit.
        settings: of the swarm; the threshold is in mm.
        basis: the coordinates to search in; the search box follows from the data (`Basis.half_widths`).
        engine: see `minimise_least_squares`.

    Returns:
        One fit per problem, in the order of the problems, with every seed's coefficients.

    Raises:
        ValueError: problems, seeds or settings that can't be used.
    """
    settings = settings or SwarmSettings()

    def search(objective: LeastSquares, low: Array, high: Array, generators: list[np.random.Generator]) -> SwarmResult:
        return minimise_least_squares(objective, low, high, generators, settings, engine)

    return _fit(problems, seeds, BasisKind(basis), search, "swarm")


def fit_random_search(
    problems: Sequence[FitProblem],
    seeds: Sequence[int],
    settings: SwarmSettings | None = None,
    basis: BasisKind | str = BasisKind.QR,
) -> list[FittedModel]:
    """The baseline: as `fit_swarms`, in the same box, with as many evaluations, but of independent random points.

    Args:
        problems: what to fit.
        seeds: at least one; the same seed gives the same fit.
        settings: of the swarm that it stands beside; the threshold is in mm.
        basis: the coordinates to search in.

    Returns:
        One fit per problem, in the order of the problems.

    Raises:
        ValueError: as `fit_swarms`.
    """
    settings = settings or SwarmSettings()

    def search(objective: LeastSquares, low: Array, high: Array, generators: list[np.random.Generator]) -> SwarmResult:
        return random_search(objective, low, high, generators, settings)

    return _fit(problems, seeds, BasisKind(basis), search, "random search")


@dataclass(frozen=True)
class _Prepared:
    """One problem in the coordinates of its basis."""

    problem: FitProblem
    features: FeatureSet
    inputs: Array
    errors: Array
    basis: Basis

    @property
    def axes(self) -> tuple[str, ...]:
        return ("x", "y", "z") if self.errors.shape[1] == 3 else ("error",)

    def generators(self, seeds: Sequence[int]) -> list[np.random.Generator]:
        """One per seed and axis, seeds first; keyed by label and model, so that neighbours in a batch don't matter."""
        key = zlib.crc32(f"{self.problem.label}|{self.problem.spec.name}".encode())
        return [
            np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(key, axis))))
            for seed in seeds
            for axis in range(len(self.axes))
        ]


def _prepared(problem: FitProblem, kind: BasisKind) -> _Prepared:
    inputs = checked_inputs(problem.inputs)
    errors = np.asarray(problem.errors_mm, dtype=float)
    if errors.ndim == 1:
        errors = errors[:, None]
    if errors.ndim != 2 or errors.shape[1] not in (1, 3) or len(errors) != len(inputs):
        raise ValueError(
            f"errors of shape {np.shape(problem.errors_mm)} for {len(inputs)} rows of inputs: must be rows x 3, or rows"
        )
    if not np.isfinite(errors).all():
        row = int(np.argwhere(~np.isfinite(errors))[0, 0])
        raise ValueError(f"error {errors[row]!r} in row {row}: all must be finite")
    features = problem.spec.features(inputs)
    return _Prepared(problem, features, inputs, errors, make_basis(kind, features.matrix(inputs), features.term_names))


def _fit(
    problems: Sequence[FitProblem], seeds: Sequence[int], kind: BasisKind, search: Search, method: str
) -> list[FittedModel]:
    if not len(problems):
        return []
    if not len(seeds) or len(set(seeds)) < len(seeds) or any(seed < 0 for seed in seeds):
        raise ValueError(f"seeds = {list(seeds)!r}: must be different whole numbers, 0 or more, at least one")
    prepared = [_prepared(problem, kind) for problem in problems]
    fitted: dict[int, FittedModel] = {}
    for dimensions in sorted({each.basis.dimensions for each in prepared}):
        chosen = [k for k, each in enumerate(prepared) if each.basis.dimensions == dimensions]
        result = _search_together([prepared[k] for k in chosen], seeds, search)
        first = 0
        for k in chosen:
            swarms = slice(first, first + len(seeds) * len(prepared[k].axes))
            fitted[k] = _fitted(prepared[k], seeds, result, swarms, method)
            first = swarms.stop
    return [fitted[k] for k in range(len(problems))]


def _search_together(group: list[_Prepared], seeds: Sequence[int], search: Search) -> SwarmResult:
    """One batch for problems with equally many coordinates: problem by problem, seed by seed, axis by axis."""
    targets, rests, widths, factor_of, generators = [], [], [], [], []
    for number, each in enumerate(group):
        target, rest = each.basis.targets(each.errors)
        targets.append(np.tile(target, (len(seeds), 1)))
        rests.append(np.tile(rest, len(seeds)))
        widths.append(np.tile(each.basis.half_widths(each.errors), (len(seeds), 1)))
        factor_of.append(np.full(len(seeds) * len(each.axes), number))
        generators += each.generators(seeds)
    objective = LeastSquares(
        np.stack([each.basis.triangular for each in group]),
        np.concatenate(factor_of),
        np.concatenate(targets),
        np.concatenate(rests),
    )
    box = np.concatenate(widths)
    return search(objective, -box, box, generators)


def _fitted(each: _Prepared, seeds: Sequence[int], result: SwarmResult, swarms: slice, method: str) -> FittedModel:
    shape = (len(seeds), len(each.axes))
    coordinates = result.positions[swarms].reshape(*shape, -1)
    least_squares, least_squares_mm = fit_least_squares(each.features, each.inputs, each.errors)
    return FittedModel(
        label=each.problem.label,
        features=each.features,
        basis=each.basis.kind,
        method=method,
        seeds=tuple(int(seed) for seed in seeds),
        axes=each.axes,
        dropped=each.basis.dropped,
        coefficients=each.basis.raw_coefficients(coordinates),
        fitness_mm=result.fitness[swarms].reshape(shape),
        least_squares=least_squares,
        least_squares_mm=least_squares_mm,
        reasons=result.reasons[swarms].reshape(shape),
        iterations=result.iterations[swarms].reshape(shape),
        history_mm=result.history[swarms].reshape(*shape, -1),
        rows=len(each.inputs),
    )
