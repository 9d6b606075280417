"""The package's one robust Gauss-Newton: frames, effects, constants of an arm and compliances are all fitted by it.

A problem says what a state leaves, what the normal equations are there (rows weighted by what they leave: iteratively
reweighted least squares, Holland & Welsch 1977) and where a step leads. A step after which the misfit grows too much is
damped (Marquardt 1963) until it no longer does.
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Generic, Literal, TypeVar

import numpy as np
from scipy.linalg.lapack import dposv, dpotrf

from armscope.core.types import Array
from armscope.fitting.constants import STEPS
from armscope.inference.linear_algebra import lower_inverse

State = TypeVar("State")
Residual = TypeVar("Residual")

Reason = Literal["the step became negligible", "no step lowers the misfit", "the largest number of steps was made"]
SETTLED: Reason = "the step became negligible"
STUCK: Reason = "no step lowers the misfit"
UNSETTLED: Reason = "the largest number of steps was made"


@dataclass(frozen=True, eq=False)
class Quadratic:
    """The penalised sum of squares about a state; its lowest point solves ``matrix @ values = right``."""

    matrix: Array  # (p, p) X'WX plus the prior's precision, in any units
    right: Array  # (p,) X'Wy
    present: Array  # (p,) values at the state; zeros where values are counted from it

    @property
    def _scale(self) -> Array:
        """(p,) what makes the diagonal one: conditioning must not depend on units."""
        return np.asarray(1 / np.sqrt(np.maximum(np.diag(self.matrix), 1e-300)))

    @functools.cached_property
    def _root(self) -> Array | None:
        """(p, p) lower: its transpose times it is the inverse; None where rounding leaves the matrix indefinite."""
        scaled = self.matrix * np.outer(self._scale, self._scale)
        factor, failed = dpotrf(scaled.T, lower=1, clean=1, overwrite_a=1)
        return None if failed else np.asarray(lower_inverse(factor) * self._scale)

    @functools.cached_property
    def inverse(self) -> Array:
        """(p, p) of the matrix."""
        if self._root is not None:
            return np.asarray(self._root.T @ self._root)
        product = np.outer(self._scale, self._scale)
        return np.asarray(np.linalg.inv(self.matrix * product) * product)

    @functools.cached_property
    def variances(self) -> Array:
        """(p,) diagonal of the inverse, which is not needed for it."""
        if self._root is None:
            return np.asarray(self.inverse.diagonal())
        return np.asarray(np.einsum("ij,ij->j", self._root, self._root))

    @functools.cached_property
    def values(self) -> Array:
        """(p,) at the lowest point."""
        if self._root is None:
            return np.asarray(self.inverse @ self.right)
        return np.asarray(self._root.T @ (self._root @ self.right))

    def step(self, damping: float) -> Array:
        """(p,) towards the lowest point; damped, the less a value is told the more it stays."""
        if damping == 0 or not len(self.right):
            return self.values - self.present
        scale = self._scale
        scaled = self.matrix * np.outer(scale, scale)
        scaled.reshape(-1)[:: len(scale) + 1] += damping
        downhill = self.right - self.matrix @ self.present
        _, solution, failed = dposv(scaled, scale * downhill)  # a tenth of what SciPy's checks around it take
        if failed:
            raise np.linalg.LinAlgError(f"the damped normal equations are not positive definite at column {failed}")
        return np.asarray(scale * solution)


class NonlinearProblem(ABC, Generic[State, Residual]):
    """What is fitted to what."""

    may_grow: float = 1.0  # a step is damped after which the misfit is more than this many times what it was
    least_damping: float = 0.0  # of every step; values that the rows do not tell then stay where they are

    @abstractmethod
    def residual(self, state: State) -> Residual:
        """What a state leaves."""

    @abstractmethod
    def quadratic(self, state: State, residual: Residual) -> Quadratic:
        """The penalised sum of squares about a state, rows weighted by what it leaves of them."""

    @abstractmethod
    def moved(self, state: State, step: Array) -> State:
        """Where a step (p,) leads."""

    @abstractmethod
    def settled(self, before: Residual, after: Residual) -> bool:
        """Whether a step that changed residuals so is negligible."""

    def misfit(self, state: State, residual: Residual) -> float:
        """What no step may raise much, by the weights of the last `quadratic`; constant where any step will do."""
        return 0.0


@dataclass(frozen=True, eq=False)
class FitResult(Generic[State, Residual]):
    """Where a fit ended, what that leaves, how many steps it took, and why it stopped."""

    state: State
    residual: Residual
    steps: int
    reason: Reason


def gauss_newton(
    problem: NonlinearProblem[State, Residual], start: State, most_steps: int
) -> FitResult[State, Residual]:
    """Minimise a problem's robust, penalised sum of squares from a start.

    Args:
        problem: what is fitted to what.
        start: where to begin.
        most_steps: after so many steps the fit stops where it is.

    Returns:
        State, residual, steps, and why it stopped.
    """
    state, residual = start, problem.residual(start)
    damping = problem.least_damping
    for steps in range(1, most_steps + 1):
        quadratic = problem.quadratic(state, residual)
        bound = problem.may_grow * problem.misfit(state, residual)
        while True:
            candidate = problem.moved(state, quadratic.step(damping))
            left = problem.residual(candidate)
            if problem.settled(residual, left):
                return FitResult(candidate, left, steps, SETTLED)
            if problem.misfit(candidate, left) <= bound:
                break
            damping = max(10 * damping, STEPS.first_damping)
            if damping > STEPS.most_damping:
                return FitResult(state, residual, steps, STUCK)
        state, residual = candidate, left
        damping = max(damping / 100 if damping > 1e-6 else 0.0, problem.least_damping)
    return FitResult(state, residual, most_steps, UNSETTLED)
