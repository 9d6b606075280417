"""Free curves and held-out rows, on columns that are no robot's: what can follow anything foretells nothing."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis.free_curves import predicted_without_curves, told_by_laws
from armscope.inference.constants import PRIORS
from armscope.inference.edits import by_posterior
from armscope.inference.evidence import evaluate
from armscope.inference.model_space import Candidate, ModelSpace
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, SelectedEffect, build_problem
from armscope.inference.search import Search

ROWS, KNOTS, NOISE = 9, 20, 0.1
STEADY, OTHER, CURVE = 0, 1, 2
LARGE = 4


def table(configurations: int, response: str) -> tuple[list[NormalEquations], Problem]:
    """Nine numbers of each configuration, one block each; what follows the angle has a knot for nearly every one."""
    rng = np.random.default_rng(3)
    angle = rng.uniform(0, 1, configurations).repeat(ROWS)
    direction, other = rng.normal(size=len(angle)), rng.normal(size=configurations).repeat(ROWS)
    hats = np.maximum(1 - np.abs(angle[:, None] * (KNOTS - 1) - np.arange(KNOTS)), 0) * direction[:, None]
    X = np.column_stack([np.ones(len(angle)), direction, other * direction, hats])
    made: dict[str, Array] = {
        "nearly": 0.4 * X[:, 1] + 0.107 * np.sin(9 * angle) * direction,
        "one": X[:, 1],
        "two": X[:, 1] + X[:, 2],
        "curve": np.sin(20 * angle) * direction,
    }
    y = made[response] + rng.normal(0, NOISE, len(angle))
    candidates = (
        Candidate("steady", "here", np.array([1]), np.ones(1)),
        Candidate("other", "there", np.array([2]), np.ones(1)),
        Candidate(
            "curve", "here", np.arange(3, 3 + KNOTS), np.ones(KNOTS), is_curve=True, special_cases=frozenset({STEADY})
        ),
    )
    parts = np.split(np.arange(len(X)), configurations)
    blocks = [NormalEquations(X[r].T @ X[r], X[r].T @ y[r], float(y[r] @ y[r]), float(len(r))) for r in parts]
    return blocks, build_problem(ModelSpace(np.array([0]), (), candidates, starts=((),)), total(blocks), 0.5 * NOISE)


def test_a_curve_that_foretells_no_other_rows_gives_way_to_what_does() -> None:
    blocks, problem = table(25, "two")
    found = predicted_without_curves(problem, blocks, evaluate(problem, (SelectedEffect(CURVE, LARGE),), (), NOISE))
    assert found is not None
    assert found.candidates == {STEADY, OTHER}


@pytest.mark.parametrize("configurations", [60, 200])
def test_a_curve_that_is_one_stays(configurations: int) -> None:
    blocks, problem = table(configurations, "curve")
    curve = evaluate(problem, (SelectedEffect(CURVE, LARGE),), (), NOISE)
    assert predicted_without_curves(problem, blocks, curve) is None


def test_where_there_is_no_curve_nothing_is_asked() -> None:
    """However badly a hypothesis foretells the rows."""
    blocks, problem = table(25, "two")
    assert (
        predicted_without_curves(problem, blocks, evaluate(problem, (SelectedEffect(STEADY, LARGE),), (), NOISE))
        is None
    )


@pytest.mark.parametrize(("response", "told"), [("one", STEADY), ("nearly", STEADY), ("curve", CURVE)])
def test_a_law_that_the_evidence_does_not_tell_from_a_curve_comes_first(response: str, told: int) -> None:
    problem = table(8, response)[1]
    search = Search.on(problem)
    sizes = range(len(problem.sizes))
    curve, law = (
        max((evaluate(problem, (SelectedEffect(n, size),), (), NOISE) for size in sizes), key=by_posterior)
        for n in (CURVE, STEADY)
    )
    if response == "nearly":
        assert law.log_posterior < curve.log_posterior < law.log_posterior + PRIORS.sure_nats
    assert told_by_laws(search, curve).candidates == {told}
    assert told_by_laws(search, law) is law
