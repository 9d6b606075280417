"""What stands out of the small errors of an arm gets its name, on columns that are no robot's."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
import pytest

from armscope.diagnosis.model_space import EffectSpace
from armscope.diagnosis.naming import _promoted, named
from armscope.inference.evidence import evaluate
from armscope.inference.model_space import Candidate, ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import SelectedEffect, build_problem
from armscope.inference.search import Search

FRAMES, MEMBERS, ROWS, NOISE = 2, 12, 400, 0.05
USUAL = 0.1
CURVE = MEMBERS


def told(values: Sequence[float], taken_up: bool = False) -> set[int]:
    """Which of the family's members get a name, a curve being found beside them.

    Args:
        values: of the first members; those of the others are drawn, of size `USUAL`.
        taken_up: whether the frames take up the column that the curve shares with the last member: no row tells it.
    """
    rng = np.random.default_rng(8)
    X = rng.normal(size=(ROWS, FRAMES + MEMBERS + 1))
    family = FRAMES + np.arange(MEMBERS)
    if taken_up:
        X[:, family[-1]] = 1e-3 * X[:, 0]
    size = np.array([*values, *USUAL * rng.normal(size=MEMBERS - len(values)), 0.5])
    y = X[:, FRAMES:] @ size + rng.normal(0, NOISE, ROWS)
    geometry = ToleranceFamily("geometric", family, np.ones(MEMBERS), (0.0, 0.1, 0.3, 1.0))
    members = [Candidate(f"member {n}", f"here {n}", family[[n]], np.ones(1)) for n in range(MEMBERS)]
    curve = Candidate("curve", "there", np.array([family[-1], FRAMES + MEMBERS]), np.ones(2), is_curve=True)
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    problem = build_problem(ModelSpace(np.arange(FRAMES), (geometry,), (*members, curve)), equations, NOISE)
    found = evaluate(problem, (SelectedEffect(CURVE, len(problem.sizes) - 1),), (2,), NOISE)
    return set(_promoted(problem, found).candidates) - {CURVE}


@pytest.mark.parametrize(("values", "expected"), [([], set()), ([1.0], {0}), ([1.0, 0.6], {0, 1})])
def test_one_that_is_off_by_far_hides_no_second(values: list[float], expected: set[int]) -> None:
    assert told(values) == expected


def test_what_a_curve_leaves_open_hides_nothing() -> None:
    """A zero that the base takes up is free within the joint's curve, however right all others are."""
    assert told([1.0], taken_up=True) == {0}


def test_however_many_the_rows_leave_open_they_hide_none() -> None:
    """In a planar arm base and tool take up most values of its links: these are no evidence of how large all are."""
    rng = np.random.default_rng(8)
    X = rng.normal(size=(ROWS, FRAMES + MEMBERS))
    family = FRAMES + np.arange(MEMBERS)
    X[:, family[3:]] = 1e-5 * X[:, [0] * (MEMBERS - 3)]
    y = X[:, family] @ np.array([0.65, *[USUAL] * (MEMBERS - 1)]) + rng.normal(0, NOISE, ROWS)
    geometry = ToleranceFamily("geometric", family, np.ones(MEMBERS), (0.0, 0.3, 1.0))
    members = tuple(Candidate(f"member {n}", f"here {n}", family[[n]], np.ones(1)) for n in range(MEMBERS))
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    problem = build_problem(ModelSpace(np.arange(FRAMES), (geometry,), members), equations, NOISE)
    found = evaluate(problem, (), (1,), NOISE)
    assert set(_promoted(problem, found).candidates) == {0}


@pytest.mark.parametrize("background", [2, 0], ids=["a little wrong everywhere", "right elsewhere"])
def test_a_curve_that_is_not_worth_its_name_leaves_the_law_that_it_was(background: int) -> None:
    """A zero a hundred times as large as others is in no background: without the curve it would be lost."""
    rng = np.random.default_rng(8)
    X = rng.normal(size=(ROWS, FRAMES + MEMBERS + 1))
    family = FRAMES + np.arange(MEMBERS)
    y = X[:, family] @ np.array([10.0, *[USUAL * (background > 0)] * (MEMBERS - 1)]) + rng.normal(0, NOISE, ROWS)
    members = [Candidate(f"member {n}", f"here {n}", family[[n]], np.ones(1)) for n in range(MEMBERS)]
    geometry = ToleranceFamily("geometric", family, np.ones(MEMBERS), (0.0, 0.1, 0.3, 1.0))
    columns, zero = np.array([family[0], FRAMES + MEMBERS]), frozenset({0})
    curve = Candidate("curve", "here 0", columns, np.ones(2), variant="angle", is_curve=True, special_cases=zero)
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    problem = build_problem(ModelSpace(np.arange(FRAMES), (geometry,), (*members, curve)), equations, NOISE)
    found = evaluate(problem, (SelectedEffect(CURVE, len(problem.sizes) - 1),), (background,), NOISE)
    found = named(Search.on(problem), cast("EffectSpace", problem.space), found)
    assert found.candidates == {0}
    assert found.noise < 2 * NOISE
