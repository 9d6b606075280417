"""Fitted error models: every swarm's coefficients beside least squares, and models extended as the outlook has it."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from armscope.core.types import Array, Indices
from armscope.errormodels.basis import BasisKind
from armscope.errormodels.features import FeatureSet, ModelSpec
from armscope.errormodels.products import ProductFeatures, fit_products
from armscope.errormodels.regions import Cut, blended, divide, fit_regions, halvings_of
from armscope.swarm.result import StopReason


class Layout(StrEnum):
    """Which coefficients one swarm looks for."""

    PER_AXIS = "per axis"
    JOINT = "joint"


@dataclass(frozen=True)
class SwarmFit:
    """One model fitted to one set of rows, by swarms of several seeds; S seeds, A axes, n terms."""

    label: str  # whose rows: the robot, recording or sub-volume
    features: FeatureSet  # the model's terms
    basis: BasisKind  # the coordinates that the swarm searched in
    method: str  # "swarm" or "random search"
    seeds: tuple[int, ...]  # the seeds, S
    axes: tuple[str, ...]  # the names of the errors' axes, A: ("x", "y", "z") or ("error",)
    dropped: tuple[str, ...]  # terms whose coefficients are 0 because they can't be told from earlier ones
    coefficients: Array  # in raw units (mm per unit of the term), S x A x n
    fitness_mm: Array  # RMS residual on the identification rows, S x A
    least_squares: Array  # the least-squares coefficients, A x n
    least_squares_mm: Array  # their RMS residual, A
    # why each swarm stopped, S x H of `StopReason`; H swarms per seed: A, or one for all axes together
    reasons: NDArray[np.object_]
    iterations: NDArray[np.int64]  # how many iterations each used, S x H
    # what each swarm minimised, at the start and after each iteration, S x H x (T + 1): the RMS residual of its axis,
    # or of the error vector (3D) in the joint layout
    history_mm: Array
    rows: int  # the number of identification rows
    particles: int
    # "per axis" (a swarm for each axis) or "joint" (one swarm in 3 n dimensions, as the paper describes)
    layout: Layout = Layout.PER_AXIS

    @property
    def name(self) -> str:
        """The model's name: "FDP(CI)"."""
        return self.features.spec.name

    @property
    def reached_mm(self) -> Array:
        """What each swarm ended with: the RMS residual of its axis, or of the error vector (joint layout), S x H."""
        if self.layout is Layout.PER_AXIS:
            return self.fitness_mm
        return np.asarray(np.sqrt(np.sum(self.fitness_mm**2, axis=1, keepdims=True)))

    @property
    def optimum_mm(self) -> Array:
        """The same by least squares, H."""
        if self.layout is Layout.PER_AXIS:
            return self.least_squares_mm
        return np.asarray(np.sqrt(np.sum(self.least_squares_mm**2, keepdims=True)))

    @property
    def excess_mm(self) -> Array:
        """How far each swarm stays above the least-squares RMS residual, mm, S x H."""
        return self.reached_mm - self.optimum_mm

    @property
    def excess_percent(self) -> Array:
        """The same in % of the least-squares residual, S x H (0 where both are 0; inf where only that one is)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            percent = 100 * self.excess_mm / self.optimum_mm
        return np.where(self.excess_mm == 0, 0.0, percent)

    @property
    def best_seeds(self) -> Indices:
        """For each axis, the index of the seed with the smallest residual on the identification rows, A."""
        return np.asarray(np.argmin(self.fitness_mm, axis=0))

    def predict(self, inputs: ArrayLike, seed: int | None = None) -> Array:
        """The predicted errors in mm, N x A, at ``inputs`` (N x k).

        Args:
            inputs: mm or rad, as the model takes them.
            seed: one of ``seeds``; None takes, per axis, the one that fitted the identification rows best.

        Raises:
            ValueError: a seed that was not fitted, or inputs that don't suit the model.
        """
        if seed is None:
            chosen = self.coefficients[self.best_seeds, np.arange(len(self.axes))]
        elif seed in self.seeds:
            chosen = self.coefficients[self.seeds.index(seed)]
        else:
            raise ValueError(f"seed {seed!r}: this model was fitted with {', '.join(map(str, self.seeds))}")
        return self.features.matrix(inputs) @ chosen.T

    def predict_all(self, inputs: ArrayLike) -> Array:
        """The predictions of all seeds in mm, S x N x A."""
        return np.asarray(np.matmul(self.features.matrix(inputs), self.coefficients.transpose(0, 2, 1)))

    def to_dict(self, history: bool = False) -> dict[str, Any]:
        """Plain values for YAML or JSON; the histories, which are long, only if asked for."""
        content = {
            "label": self.label,
            "features": self.features.to_dict(),
            "terms": list(self.features.term_names),
            "basis": self.basis.value,
            "method": self.method,
            "layout": self.layout.value,
            "rows": self.rows,
            "particles": self.particles,
            "seeds": list(self.seeds),
            "axes": list(self.axes),
            "dropped": list(self.dropped),
            "coefficients": self.coefficients.tolist(),
            "fitness_mm": self.fitness_mm.tolist(),
            "least_squares": self.least_squares.tolist(),
            "least_squares_mm": self.least_squares_mm.tolist(),
            "reasons": [[reason.value for reason in of_seed] for of_seed in self.reasons],
            "iterations": self.iterations.tolist(),
        }
        if history:
            content["history_mm"] = _packed(self.history_mm)
        return content

    @staticmethod
    def from_dict(content: dict[str, Any]) -> SwarmFit:
        """The inverse of `to_dict`; histories that were not kept come back as their first axes with no columns."""
        fitness = np.array(content["fitness_mm"], dtype=float)
        iterations = np.array(content["iterations"], dtype=np.int64)
        shape = iterations.shape
        reasons = np.empty(shape, dtype=object)
        reasons[:] = [[StopReason(sentence) for sentence in of_seed] for of_seed in content["reasons"]]
        return SwarmFit(
            label=content["label"],
            features=FeatureSet.from_dict(content["features"]),
            basis=BasisKind(content["basis"]),
            method=content["method"],
            seeds=tuple(content["seeds"]),
            axes=tuple(content["axes"]),
            dropped=tuple(content["dropped"]),
            coefficients=np.array(content["coefficients"], dtype=float),
            fitness_mm=fitness,
            least_squares=np.array(content["least_squares"], dtype=float),
            least_squares_mm=np.array(content["least_squares_mm"], dtype=float),
            reasons=reasons,
            iterations=iterations,
            history_mm=_unpacked(content["history_mm"])
            if "history_mm" in content
            else np.empty((*iterations.shape, 0)),
            rows=content["rows"],
            particles=content["particles"],
            layout=Layout(content["layout"]),
        )


def _packed(history: Array) -> dict[str, Any]:
    """Histories are long, and seven digits of them are enough: single precision, as text."""
    bits = history.astype("<f4").tobytes()
    return {"shape": list(history.shape), "float32": base64.b64encode(bits).decode()}


def _unpacked(content: dict[str, Any]) -> Array:
    bits = np.frombuffer(base64.b64decode(content["float32"]), dtype="<f4")
    return bits.reshape(content["shape"]).astype(float)


@dataclass(frozen=True)
class ModelSet:
    """Which models are fitted."""

    plain: tuple[ModelSpec, ...] = ()
    products: tuple[ModelSpec, ...] = ()  # with a sparse choice of products
    regions: tuple[tuple[ModelSpec, int], ...] = ()  # divided into so many blended regions


@dataclass(frozen=True, eq=False)
class ExtendedModel:
    """A model fitted by least squares."""

    name: str  # the model's name and how it is extended
    features: FeatureSet | ProductFeatures
    coefficients: Array  # (regions, axes, terms) mm per unit of a term
    cut: Cut | None = None  # the borders of the regions; None for a single one

    def predict(self, inputs: ArrayLike) -> Array:
        """(N, axes) mm at inputs (N, k), mm or rad."""
        return blended(self.features, self.cut, self.coefficients, inputs)


def with_regions(spec: ModelSpec, inputs: Array, errors_mm: Array, count: int) -> ExtendedModel:
    """A model divided into blended regions.

    Args:
        spec: of every region.
        inputs, errors_mm: (M, k), (M, axes) identification rows.
        count: 1, 2, 4, ... regions.

    Returns:
        The fitted model.
    """
    features, cut = spec.features(inputs), divide(inputs, halvings_of(count))
    name = f"{spec.name}, {count} regions" if count > 1 else spec.name
    return ExtendedModel(name, features, fit_regions(features, cut, inputs, errors_mm), cut)


def with_products(
    spec: ModelSpec, inputs: Array, errors_mm: Array, rng: np.random.Generator
) -> tuple[ExtendedModel, pd.DataFrame]:
    """A model with a sparse choice of products.

    Args:
        spec: whose products.
        inputs, errors_mm: (M, k), (M, axes) identification rows.
        rng: draws the folds.

    Returns:
        The fitted model, and how the number of terms was chosen (see `fit_products`).
    """
    features, coefficients, compared = fit_products(spec, inputs, errors_mm, rng)
    return ExtendedModel(features.name, features, coefficients[None]), compared
