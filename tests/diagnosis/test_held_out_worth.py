"""Names and held-out rows, on columns that are no robot's: what helps stays, what harms goes."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.diagnosis.held_out_worth import earned, held_out_gains, predicted_better
from armscope.inference.evidence import evaluate
from armscope.inference.model_space import Candidate, Companion, ModelSpace, ToleranceFamily
from armscope.inference.normal_equations import NormalEquations, total
from armscope.inference.problem import Problem, SelectedEffect, build_problem

BLOCKS, ROWS, FRAMES, NOISE = 10, 12, 2, 0.1
HELPFUL, WIDE = 0, 1
LARGE = 4


def blocks_and_problem(helpful: float = 0.5) -> tuple[list[NormalEquations], Problem]:
    """One column that made the response, and thirty that follow nothing, as one candidate."""
    rng = np.random.default_rng(5)
    X = rng.normal(size=(BLOCKS * ROWS, FRAMES + 31))
    y = helpful * X[:, FRAMES] + rng.normal(0, NOISE, len(X))
    space = ModelSpace(
        np.arange(FRAMES),
        (),
        (
            Candidate("helpful", "here", np.array([FRAMES]), np.ones(1)),
            Candidate("wide", "there", np.arange(FRAMES + 1, FRAMES + 31), np.ones(30)),
        ),
    )
    parts = np.split(np.arange(len(X)), BLOCKS)
    blocks = [NormalEquations(X[r].T @ X[r], X[r].T @ y[r], float(y[r] @ y[r]), float(len(r))) for r in parts]
    return blocks, build_problem(space, total(blocks), 0.5 * NOISE)


def test_what_makes_held_out_rows_worse_is_not_named() -> None:
    blocks, problem = blocks_and_problem()
    both = evaluate(problem, (SelectedEffect(HELPFUL, LARGE), SelectedEffect(WIDE, LARGE)), (), NOISE)
    assert earned(problem, blocks, both).candidates == {HELPFUL}


def test_what_is_not_worth_its_price_once_others_went_goes_with_them() -> None:
    """It foretells rows a little better; without the wide one it is not worth a name."""
    blocks, problem = blocks_and_problem(0.025)
    chosen = (SelectedEffect(HELPFUL, 1), SelectedEffect(WIDE, LARGE))
    assert held_out_gains(problem, blocks, evaluate(problem, chosen[:1], (), NOISE), [((), ())])[0] > 0
    assert earned(problem, blocks, evaluate(problem, chosen, (), NOISE)).candidates == frozenset()
    alone = evaluate(problem, chosen[:1], (), NOISE)
    assert earned(problem, blocks, alone).candidates == {HELPFUL}


def test_a_name_within_something_else_is_not_asked() -> None:
    blocks, problem = blocks_and_problem()
    nested = evaluate(problem, (SelectedEffect(HELPFUL, LARGE), SelectedEffect(WIDE, LARGE, nested=True)), (), NOISE)
    assert earned(problem, blocks, nested).candidates == {HELPFUL, WIDE}


def test_gains_are_those_of_rows_left_out_by_hand() -> None:
    blocks, problem = blocks_and_problem()
    with_it = evaluate(problem, (SelectedEffect(HELPFUL, LARGE),), (), NOISE)
    (gain,) = held_out_gains(problem, blocks, with_it, [((), ())])
    expected = 0.0
    for fold in range(5):
        held = [k for k in range(BLOCKS) if k % 5 == fold]
        trained = problem.with_equations(total([b for k, b in enumerate(blocks) if k not in held]))
        judged = total([blocks[k] for k in held])
        for chosen, sign in (((), 1), ((SelectedEffect(HELPFUL, LARGE),), -1)):
            fitted = evaluate(trained, chosen, (), with_it.noise)
            expected += sign * judged.rss(fitted.coefficients(len(problem.scale)) / problem.scale)
    np.testing.assert_allclose(gain, expected / with_it.noise**2)


def rows_that_wander(wander: float, in_order: float) -> tuple[list[NormalEquations], Problem]:
    """What follows the posture, which may go with the row, and a wander of so many mm, which follows the row alone."""
    rng = np.random.default_rng(8)
    count = 30 * BLOCKS
    course = np.cos(np.pi * np.arange(count) / (count - 1))
    posture = in_order * course + 0.3 * rng.normal(size=count)
    X = np.column_stack([np.ones(count), posture, course])
    y = 0.5 * posture + wander * course + rng.normal(0, NOISE, count)
    space = ModelSpace(
        np.array([0]),
        (ToleranceFamily("wander", np.array([2]), np.array([1.0]), (0.0, 1.0)),),
        (Candidate("of posture", "here", np.array([1]), np.ones(1)),),
    )
    parts = [np.arange(first, count, BLOCKS) for first in range(BLOCKS)]
    blocks = [NormalEquations(X[r].T @ X[r], X[r].T @ y[r], float(y[r] @ y[r]), float(len(r))) for r in parts]
    return blocks, build_problem(space, total(blocks), 0.5 * NOISE)


@pytest.mark.parametrize(("wander", "in_order", "better"), [(1.0, 0.0, True), (0.0, 1.0, False)])
def test_a_wander_of_rows_stays_where_other_rows_are_predicted_better(
    wander: float, in_order: float, better: bool
) -> None:
    """It clears the view of what follows the posture; or there is none, and it takes a part of what does."""
    blocks, problem = rows_that_wander(wander, in_order)
    hypothesis = evaluate(problem, (SelectedEffect(0, LARGE),), (1,), NOISE)
    assert predicted_better(problem, blocks, hypothesis, 0, np.array([2])) is better


def test_masses_that_are_off_do_not_go_on_giving_way_in_place_of_a_name() -> None:
    """Their columns were written around what gives way: three loads, twice as heavy, are all that it does."""
    rng = np.random.default_rng(5)
    by_link = rng.normal(size=(BLOCKS * ROWS, 3))
    elsewhere = rng.normal(size=(BLOCKS * ROWS, 1 + FRAMES))
    X = np.column_stack([elsewhere, by_link.sum(axis=1), 0.5 * by_link])
    y = 0.5 * by_link @ [1.0, 1.05, 0.95] + 0.2 * X[:, 2] + rng.normal(0, NOISE, len(X))
    little = ToleranceFamily("elsewhere", np.array([2]), np.ones(1), (0.0, 0.2))
    masses = ToleranceFamily("masses", np.arange(4, 7), 0.1 * np.ones(3), (1.0,))
    through = Companion(masses, frozenset({0}), frozenset({0}))
    bends = Candidate("bends", "here", np.array([3]), np.ones(1))
    space = ModelSpace(np.arange(FRAMES), (little,), (bends,), companions=(through,))
    parts = np.split(np.arange(len(X)), BLOCKS)
    blocks = [NormalEquations(X[r].T @ X[r], X[r].T @ y[r], float(y[r] @ y[r]), float(len(r))) for r in parts]
    problem = build_problem(space, total(blocks), 0.5 * NOISE)
    found = evaluate(problem, (SelectedEffect(0, LARGE),), (1,), NOISE)
    assert found.log_posterior - evaluate(problem, (), (1,), NOISE).log_posterior > 20
    (gain,) = held_out_gains(problem, blocks, found, [((), (1,))])
    assert gain > 0.9 * np.sum((0.5 * by_link @ [1.0, 1.05, 0.95]) ** 2) / NOISE**2
