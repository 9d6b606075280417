"""The one fitter against SciPy's, its damping, and its named reasons to stop."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

from armscope.core.types import Array
from armscope.fitting.gauss_newton import SETTLED, STUCK, UNSETTLED, NonlinearProblem, Quadratic, gauss_newton

AT = np.linspace(0, 4, 60)


class Decay(NonlinearProblem[Array, Array]):
    """y = a exp(-k t), a prior of unit precision times ``held`` about zero, Huber weights of fixed scale."""

    def __init__(self, y: Array, held: float = 0.0, scale: float = np.inf) -> None:
        self.y, self.held, self.scale, self.weights = y, held, scale, np.ones(len(y))

    def residual(self, state: Array) -> Array:
        return np.asarray(self.y - state[0] * np.exp(-state[1] * AT))

    def quadratic(self, state: Array, residual: Array) -> Quadratic:
        self.weights = np.minimum(1.0, self.scale / np.abs(residual))
        shape = np.exp(-state[1] * AT)
        X = np.column_stack([shape, -state[0] * AT * shape])
        normal = (X * self.weights[:, None]).T @ X + self.held * np.eye(2)
        return Quadratic(normal, X.T @ (self.weights * residual) - self.held * state, np.zeros(2))

    def misfit(self, state: Array, residual: Array) -> float:
        return float(self.weights @ residual**2 + self.held * state @ state)

    def moved(self, state: Array, step: Array) -> Array:
        return state + step

    def settled(self, before: Array, after: Array) -> bool:
        return float(np.abs(after - before).max()) < 1e-12


@pytest.fixture
def y() -> Array:
    rng = np.random.default_rng(0)
    y = 3 * np.exp(-0.7 * AT) + 0.05 * rng.normal(size=len(AT))
    y[::15] += 2.0
    return np.asarray(y)


@pytest.mark.parametrize("held", [0.0, 5.0])
@pytest.mark.parametrize("start", [[1.0, 0.1], [50.0, 6.0]])
def test_it_ends_where_scipy_does_from_near_and_far(y: Array, held: float, start: list[float]) -> None:
    problem = Decay(y, held)
    found = gauss_newton(problem, np.array(start), 200)
    theirs = scipy.optimize.least_squares(
        lambda x: np.concatenate([problem.residual(x), np.sqrt(held) * x]), [1.0, 0.5], xtol=1e-15, ftol=1e-15
    )
    assert found.reason in (SETTLED, STUCK)
    np.testing.assert_allclose(found.state, theirs.x, rtol=1e-6)
    np.testing.assert_allclose(found.residual, problem.residual(found.state))


def test_weights_are_those_of_hubers_loss(y: Array) -> None:
    found = gauss_newton(Decay(y, scale=0.1), np.array([1.0, 0.1]), 200)
    theirs = scipy.optimize.least_squares(
        Decay(y).residual, [1.0, 0.1], loss="huber", f_scale=0.1, xtol=1e-15, ftol=1e-15, gtol=1e-15
    )
    np.testing.assert_allclose(found.state, theirs.x, rtol=1e-5)


def test_why_it_stopped_is_named(y: Array) -> None:
    assert gauss_newton(Decay(y), np.array([1.0, 0.1]), 2).reason == UNSETTLED
    uphill = Decay(y)
    uphill.moved = lambda state, step: state - step  # type: ignore[method-assign]
    stuck = gauss_newton(uphill, np.array([1.0, 0.1]), 50)
    assert (stuck.reason, stuck.steps) == (STUCK, 1)
    np.testing.assert_array_equal(stuck.state, [1.0, 0.1])


def test_values_in_place_or_counted_from_it_give_the_same_step() -> None:
    rng = np.random.default_rng(1)
    X, y, here = rng.normal(size=(20, 4)), rng.normal(size=20), rng.normal(size=4)
    for damping in (0.0, 0.1):
        whole = Quadratic(X.T @ X, X.T @ y, here).step(damping)
        change = Quadratic(X.T @ X, X.T @ (y - X @ here), np.zeros(4)).step(damping)
        np.testing.assert_allclose(whole, change, rtol=1e-9)


def test_a_value_that_nothing_tells_stays_where_it_is() -> None:
    quadratic = Quadratic(np.diag([2.0, 0.0]), np.array([4.0, 0.0]), np.array([0.0, 7.0]))
    np.testing.assert_allclose(quadratic.step(1e-9), [2.0, 0.0], atol=1e-8)
