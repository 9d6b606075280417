"""A fitted error model: coefficients of every seed beside the least-squares ones, and what they predict."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armscope.core.types import Array
from armscope.errormodels.basis import BasisKind
from armscope.errormodels.features import FeatureSet
from armscope.swarm import StopReason


@dataclass(frozen=True)
class FittedModel:
    """One model fitted to one set of rows, for each axis by itself, by one swarm per seed; S seeds, A axes, n terms.

    Attributes:
        label: whose rows: the robot, recording or sub-volume.
        features: the model's terms.
        basis: the coordinates that the swarm searched in.
        method: "swarm" or "random search".
        seeds: the seeds, S.
        axes: the names of the errors' axes, A: ("x", "y", "z") or ("error",).
        dropped: terms whose coefficients are 0 because they can't be told from earlier ones.
        coefficients: in raw units (mm per unit of the term), S x A x n.
        fitness_mm: RMS residual on the identification rows, S x A.
        least_squares: the least-squares coefficients, A x n.
        least_squares_mm: their RMS residual, A.
        reasons: why each swarm stopped, S x A of `StopReason`.
        iterations: how many iterations each used, S x A.
        history_mm: best RMS residual at the start and after each iteration, S x A x (T + 1).
        rows: the number of identification rows.
    """

    label: str
    features: FeatureSet
    basis: BasisKind
    method: str
    seeds: tuple[int, ...]
    axes: tuple[str, ...]
    dropped: tuple[str, ...]
    coefficients: Array
    fitness_mm: Array
    least_squares: Array
    least_squares_mm: Array
    reasons: NDArray[np.object_]
    iterations: NDArray[np.int64]
    history_mm: Array
    rows: int

    @property
    def name(self) -> str:
        """The model's name: "FDP(CI)"."""
        return self.features.spec.name

    @property
    def excess_mm(self) -> Array:
        """How far each fit stays above the least-squares RMS residual, mm, S x A."""
        return self.fitness_mm - self.least_squares_mm

    @property
    def excess_percent(self) -> Array:
        """The same in % of the least-squares residual, S x A (0 where both are 0; inf where only that one is)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            percent = 100 * self.excess_mm / self.least_squares_mm
        return np.where(self.excess_mm == 0, 0.0, percent)

    @property
    def best_seeds(self) -> NDArray[np.intp]:
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

    def predict_least_squares(self, inputs: ArrayLike) -> Array:
        """The predictions of the least-squares coefficients in mm, N x A."""
        return self.features.matrix(inputs) @ self.least_squares.T

    def to_dict(self, history: bool = False) -> dict[str, Any]:
        """Plain values for YAML or JSON; the histories, which are long, only if asked for."""
        content = {
            "label": self.label,
            "features": self.features.to_dict(),
            "terms": list(self.features.term_names),
            "basis": self.basis.value,
            "method": self.method,
            "rows": self.rows,
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
            content["history_mm"] = self.history_mm.tolist()
        return content

    @staticmethod
    def from_dict(content: dict[str, Any]) -> FittedModel:
        """The inverse of `to_dict`; histories that were not kept come back as their first axes with no columns."""
        fitness = np.array(content["fitness_mm"], dtype=float)
        reasons = np.empty(fitness.shape, dtype=object)
        reasons[:] = [[StopReason(sentence) for sentence in of_seed] for of_seed in content["reasons"]]
        return FittedModel(
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
            iterations=np.array(content["iterations"], dtype=np.int64),
            history_mm=np.array(content.get("history_mm", np.empty((*fitness.shape, 0))), dtype=float),
            rows=content["rows"],
        )
