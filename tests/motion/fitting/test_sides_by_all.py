"""How friction changes sides is what all of a motion says, also beside sums over a part that hardly shows it."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.inference.evidence import evaluate
from armscope.inference.model_space import ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import build_problem
from armscope.motion.fitting.sides_by_all import fitted_beside

FRAME, SIDE, MASS = range(3)


def sums(often: float, side: float, seed: int) -> NormalEquations:
    """Of rows that show a mass of one, and so much of how friction changes sides."""
    rng = np.random.default_rng(seed)
    X = rng.normal(size=(200, 3)) * [1.0, often, 1.0]
    y = side * X[:, SIDE] + X[:, MASS] + 0.1 * rng.normal(size=200)
    return NormalEquations(X.T @ X, X.T @ y, float(y @ y), 200.0)


def test_a_part_that_guesses_badly_is_told_by_all() -> None:
    turns_back, moves = sums(1.0, 1.0, 1), sums(0.05, 5.0, 2)
    families = (
        ToleranceFamily("reversals", np.array([SIDE]), np.array([10.0]), (0.0, 1.0)),
        ToleranceFamily("masses", np.array([MASS]), np.array([10.0]), (0.0, 1.0)),
    )
    whole = build_problem(ModelSpace(np.arange(1), families, ()), total([turns_back, moves]), 0.05)
    rest = whole.with_equations(moves)
    by_itself = evaluate(rest, (), (1, 1), 0.1).coefficients(3) / whole.scale
    assert by_itself[SIDE] == pytest.approx(5, abs=0.5)
    beside = fitted_beside(whole, rest, (), (1, 1), 0.1).coefficients(3) / whole.scale
    assert beside[SIDE] == pytest.approx(1, abs=0.1)
    assert beside[MASS] == pytest.approx(by_itself[MASS], abs=0.01)
