"""Sizes that rows give to a background's values: few waves are told from many, and what has a name keeps its own."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.inference.evidence import evaluate
from armscope.inference.model_space import ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import Problem, build_problem
from armscope.inference.sizes_by_group import SizeGroups, sizes_by_group

GEARS, WAVES = 3, 20
NOISE = 0.02
SMALL = np.repeat(np.arange(GEARS * WAVES), 2)
LARGE = np.repeat(np.arange(GEARS), 2 * WAVES)
COLUMNS = len(SMALL)


def sums(values: np.ndarray, rows: int, seed: int) -> tuple[NormalEquations, np.ndarray]:
    """Normal equations of rows that follow values, and the columns (a constant stands for the frames)."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2 * np.pi, (rows, GEARS))
    waves = np.outer(angle.T.ravel(), np.arange(1, WAVES + 1)).reshape(GEARS, rows, WAVES)
    pairs = np.stack([np.cos(waves), np.sin(waves)], axis=-1).transpose(1, 0, 2, 3).reshape(rows, COLUMNS)
    X = np.concatenate([np.ones((rows, 1)), pairs], axis=1)
    y = X[:, 1:] @ values + NOISE * rng.normal(size=rows)
    return NormalEquations(X.T @ X, X.T @ y, float(y @ y), rows), X


def problem_of(equations: NormalEquations) -> Problem:
    family = ToleranceFamily("gears", np.arange(1, COLUMNS + 1), np.full(COLUMNS, 0.02), (0.0, 1.0))
    space = ModelSpace(np.array([0]), (family,), (), (), ((1,),), ())
    return build_problem(space, equations, NOISE / 2)


def missed(values: np.ndarray, freedom: float | None) -> float:
    """RMS of what a fit to 200 rows misses of 2000 others without noise; values of one size where no freedom."""
    problem = problem_of(sums(values, 200, seed=1)[0])
    found = evaluate(problem, (), (1,), NOISE)
    if freedom is not None:
        groups = SizeGroups(0, SMALL, LARGE, np.full(COLUMNS, True))
        _, found = sizes_by_group(problem, found, groups, freedom)
    X = sums(values, 2000, seed=2)[1][:, 1:]
    fitted = (found.coefficients(COLUMNS + 1) / problem.scale)[1:]
    return float(np.sqrt(np.mean((X @ (fitted - values)) ** 2)))


def test_a_few_waves_are_told_better_by_a_t_and_many_alike_hardly_worse():
    rng = np.random.default_rng(3)
    few = np.zeros(COLUMNS)
    few[2 * np.array([1, 8, 30, 44])] = [0.05, -0.04, 0.03, 0.05]
    alike = rng.normal(0, 0.02, COLUMNS)
    assert missed(few, 1.0) < 0.7 * missed(few, None)
    assert missed(few, 1.0) < missed(few, 4.0) < missed(few, None)
    assert missed(alike, 4.0) < 1.1 * missed(alike, None)


def test_one_bad_gear_does_not_make_the_others_look_bad():
    """Where sizes go by gear alone, the one whose waves are five times larger gets the larger size."""
    rng = np.random.default_rng(4)
    values = rng.normal(0, 0.02, COLUMNS) * np.repeat([1.0, 5.0, 0.2], 2 * WAVES)
    problem = problem_of(sums(values, 400, seed=1)[0])
    plain = evaluate(problem, (), (1,), NOISE)
    factor, _ = sizes_by_group(problem, plain, SizeGroups(0, SMALL, LARGE, np.full(COLUMNS, True)), np.inf)
    assert factor[LARGE == 0] == pytest.approx(1.0, rel=0.3)
    assert factor[LARGE == 1] == pytest.approx(5.0, rel=0.3)
    assert factor[LARGE == 2] == pytest.approx(0.35, abs=0.2)  # 0.2, drawn towards 1 by what is believed beforehand


def test_what_has_a_name_keeps_its_size_and_tells_the_rest_nothing():
    values = np.zeros(COLUMNS)
    values[0] = 0.2  # ten times the usual size
    problem = problem_of(sums(values, 300, seed=5)[0])
    plain = evaluate(problem, (), (1,), NOISE)
    learned = SMALL != 0
    factor, _ = sizes_by_group(problem, plain, SizeGroups(0, SMALL, LARGE, learned), 4.0)
    assert np.all(factor[:2] == 1)
    assert np.all(factor[2:] < 1)
