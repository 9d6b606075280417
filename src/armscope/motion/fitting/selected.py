"""What a selection of causes ends with: rows, how much they count, what competed, and what won."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array, Indices
from armscope.inference.evidence import Hypothesis
from armscope.inference.model_space import ModelSpace
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem
from armscope.motion.fitting.rows import MotionRows
from armscope.motion.fitting.sums import JointSums
from armscope.motion.fitting.weights import TorqueWeights, estimate_weights, left_elsewhere, weighed
from armscope.motion.library.layout import DRY, OWN


@dataclass(frozen=True, eq=False)
class SelectedCauses:
    """A finished selection."""

    # rows, weights: the rows, and how much they count
    rows: MotionRows
    weights: TorqueWeights
    block: Indices  # (K,) number of each row's block; by_joint: their sums by joint, whatever its noise
    by_joint: list[list[JointSums]]
    # space, problem, best: what competed, on which sums, and what won
    space: ModelSpace
    problem: Problem
    best: Hypothesis

    @functools.cached_property
    def blocks(self) -> list[NormalEquations]:
        """Sums over each block, of all joints by their noise."""
        return [weighed(self.rows, parts, self.weights) for parts in self.by_joint]

    @functools.cached_property
    def coefficients(self) -> Array:
        """(p,) of all columns, SI."""
        return coefficients_of(self.problem, self.best)

    @functools.cached_property
    def dry(self) -> Array:
        """(m,) N m of dry friction, the stated part counted in."""
        layout = self.rows.layout
        fitted = self.coefficients[layout.own].reshape(-1, OWN)[:, DRY]
        return np.asarray(fitted + np.nan_to_num(layout.arm.stated_background[:, DRY]))

    @functools.cached_property
    def told(self) -> Array:
        """(p,) coefficients as a model holds them: friction's change of sides counted from the speed's."""
        found = self.coefficients.copy()
        found[self.rows.layout.reversals[:, -1]] += self.rows.turning * self.dry
        return found

    @functools.cached_property
    def modelled(self) -> Array:
        """(K, m) N m of the model."""
        return self.rows.nominal + self.rows.modelled(self.coefficients)

    @functools.cached_property
    def residuals(self) -> Array:
        """(K, m) N m that the model leaves."""
        return self.rows.without_pauses(self.rows.torque - self.modelled)

    @property
    def noise(self) -> TorqueWeights:
        """How much rows count by what the model leaves of them, as part of the fit and apart from it."""
        blocks = dict(enumerate(self.blocks))
        apart = left_elsewhere(self.rows, self.block, blocks, self.problem, self.best) if len(blocks) > 1 else None
        return estimate_weights(self.rows, self.residuals, apart)


def coefficients_of(problem: Problem, hypothesis: Hypothesis) -> Array:
    """(p,) posterior means, SI."""
    return np.asarray(hypothesis.coefficients(len(problem.scale)) / problem.scale)
