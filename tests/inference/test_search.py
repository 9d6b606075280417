"""The search on columns that are no robot's: what is data in a model space is kept to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.inference.additions import AskedAdditions, addition_scores
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import Candidate, Exchange, ModelSpace, ToleranceFamily
from armscope.inference.neighbours import block_removals, neighbours
from armscope.inference.normal_equations import NormalEquations
from armscope.inference.problem import SelectedEffect, build_problem
from armscope.inference.search import Search

ROWS, FRAMES, SINGLE, NOISE = 300, 3, 8, 0.05
CURVE = np.arange(FRAMES, FRAMES + 4)
"""The curve's columns are those of the first four single candidates."""


def single(number: int, **more: object) -> Candidate:
    """A candidate of one column."""
    candidate = Candidate(f"kind {number % 3}", f"place {number}", np.array([FRAMES + number]), np.ones(1))
    return replace(candidate, label=f"effect {number}", region=f"place {number // 2}", **more)


def space_of(candidates: list[Candidate], **more: object) -> ModelSpace:
    everything = np.arange(FRAMES, FRAMES + SINGLE)
    families = (
        ToleranceFamily("tolerances", everything, np.full(SINGLE, 0.02), (0.0, 0.3, 1.0)),
        ToleranceFamily("small", everything[:4], np.ones(4), (0.0, 0.01, 0.03), is_priced=True),
    )
    return replace(ModelSpace(np.arange(FRAMES), families, tuple(candidates), ((0, 0), (2, 1))), **more)


def search_on(space: ModelSpace, truth: dict[int, float], seed: int = 1) -> Search:
    """Random columns, of which those of some single candidates made the response."""
    rng = np.random.default_rng(seed)
    X = rng.normal(size=(ROWS, FRAMES + SINGLE))
    y = X[:, :FRAMES] @ rng.normal(size=FRAMES) + rng.normal(0, NOISE, ROWS)
    for number, value in truth.items():
        y += value * X[:, FRAMES + number]
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    return Search.on(build_problem(space, equations, 0.5 * NOISE))


@pytest.mark.parametrize("truth", [{}, {2: 0.3}, {1: 0.3, 6: -0.4}, {0: 0.2, 3: 0.3, 5: 0.5}])
def test_what_made_the_response_is_found_and_nothing_else(truth: dict[int, float]) -> None:
    best = search_on(space_of([single(n) for n in range(SINGLE)]), truth).best()
    assert best.candidates == truth.keys()
    assert best.noise == pytest.approx(NOISE, rel=0.1)
    for number, value in truth.items():
        assert best.means(np.array([FRAMES + number]))[0] == pytest.approx(value, rel=0.15)


def test_what_is_plausible_bounds_what_rows_hardly_tell() -> None:
    """A column that all but vanishes beyond the frames: without a limit its value is as large as its rows allow."""
    rng = np.random.default_rng(3)
    X = rng.normal(size=(ROWS, FRAMES + SINGLE))
    X[:, FRAMES] = X[:, :FRAMES] @ rng.normal(size=FRAMES) + 1e-2 * rng.normal(size=ROWS)
    y = 0.5 * X[:, FRAMES + 3] + rng.normal(0, NOISE, ROWS)
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    for limit in (None, np.array([0.01])):
        candidates = [single(n) for n in range(SINGLE)]
        candidates[0] = replace(candidates[0], plausible=limit)
        problem = build_problem(space_of(candidates), equations, 0.5 * NOISE)
        largest = SelectedEffect(0, len(problem.sizes) - 1)
        told = evaluate(problem, (largest,), problem.space.no_background, NOISE)
        spread = float(np.sqrt(told.variances(np.array([FRAMES]))[0])) / problem.scale[FRAMES]
        assert (spread > 0.05) if limit is None else (spread <= 0.01)


def test_predicted_gains_keep_to_what_is_plausible() -> None:
    """What an addition promises is what it brings, also where its own limit holds it smaller than its size."""
    candidates = [single(n, plausible=np.array([0.02 * (1 + n)])) for n in range(SINGLE)]
    search = search_on(space_of(candidates), {2: 0.1, 5: 0.02})
    before = search.evaluated((SelectedEffect(2, 3),), search.perfect())
    promised = addition_scores(search.problem, search.groups, before)
    for candidate in set(range(SINGLE)) - {2}:
        for size in range(len(search.problem.sizes)):
            brought = search.evaluated((*before.chosen, SelectedEffect(candidate, size)), before)
            gain = brought.log_posterior - before.log_posterior
            assert promised[size, candidate] == pytest.approx(gain, abs=0.2 + 0.05 * abs(gain))


def test_what_is_much_smaller_than_usual_is_the_less_likely_and_what_it_promises_is_what_it_brings() -> None:
    candidates = [single(n) for n in range(SINGLE)]
    candidates[2] = replace(candidates[2], usual=np.array([50.0]))
    plain, usual = (
        search_on(space_of([single(n) for n in range(SINGLE)]), {2: 0.1}),
        search_on(space_of(candidates), {2: 0.1}),
    )
    worth = []
    for search in (plain, usual):
        before = search.perfect()
        promised = addition_scores(search.problem, search.groups, before)[:, 2].max()
        found = [search.evaluated((SelectedEffect(2, n),), before) for n in range(len(search.problem.sizes))]
        worth.append(max(each.log_posterior for each in found) - before.log_posterior)
        assert promised == pytest.approx(worth[-1], abs=0.2 + 0.05 * abs(worth[-1]))
    assert worth[0] - worth[1] > 3.0


def test_the_frames_take_up_what_is_theirs() -> None:
    search = search_on(space_of([single(n) for n in range(SINGLE)]), {})
    assert search.problem.mismatch == pytest.approx(NOISE, rel=0.15)


def test_what_excludes_each_other_never_stands_side_by_side() -> None:
    candidates = [single(n) for n in range(SINGLE)]
    candidates[1], candidates[6] = (replace(candidates[a], excludes=frozenset({b})) for a, b in ((1, 6), (6, 1)))
    best = search_on(space_of(candidates), {1: 0.3, 6: -0.4}).best()
    assert best.candidates & {1, 6} == {6}


def test_what_requires_another_enters_only_beside_it_and_leaves_with_it() -> None:
    candidates = [single(n) for n in range(SINGLE)]
    candidates[5] = replace(candidates[5], requires=frozenset({2}))
    assert search_on(space_of(candidates), {5: 0.4}).best().candidates == frozenset()
    search = search_on(space_of(candidates), {2: 0.3, 5: 0.4})
    best = search.best()
    assert best.candidates == {2, 5}
    assert search.without(best, [2]).candidates == frozenset()
    alone = evaluate(search.problem, (SelectedEffect(5, 2),), (0, 0), NOISE)
    assert alone.log_posterior == -np.inf


def test_a_value_that_cannot_be_negative_is_not_found_where_it_would_be() -> None:
    candidates = [single(n, nonnegative=True) for n in range(SINGLE)]
    best = search_on(space_of(candidates), {1: -0.3, 4: 0.3}).best()
    assert 1 not in best.candidates
    assert 4 in best.candidates


def with_curve() -> list[Candidate]:
    curve = Candidate("curve", "place", CURVE, np.ones(4), is_curve=True, special_cases=frozenset(range(4)))
    held = frozenset({SINGLE})
    members = [single(n, excludes=held if n < 4 else frozenset()) for n in range(SINGLE)]
    return [*members, replace(curve, excludes=frozenset(range(4)))]


def test_a_curve_takes_the_place_of_many_special_cases_and_one_that_of_a_curve() -> None:
    assert search_on(space_of(with_curve()), {0: 0.3, 1: -0.2, 2: 0.25, 3: 0.2}).best().candidates == {SINGLE}
    assert search_on(space_of(with_curve()), {2: 0.3}).best().candidates == {2}


def test_a_curve_that_stood_for_one_of_its_special_cases_and_something_else_is_left() -> None:
    """Neither of the two alone is better than the curve that imitates their sum."""
    rng = np.random.default_rng(5)
    X = rng.normal(size=(ROWS, FRAMES + SINGLE))
    X[:, FRAMES + 6] = X[:, FRAMES + 1 : FRAMES + 4] @ np.array([0.6, -0.5, 0.6]) + 0.12 * rng.normal(size=ROWS)
    y = 0.5 * X[:, FRAMES] + 0.4 * X[:, FRAMES + 6] + rng.normal(0, NOISE, ROWS)
    equations = NormalEquations(X.T @ X, X.T @ y, float(y @ y), float(ROWS))
    search = Search.on(build_problem(space_of(with_curve()), equations, 0.5 * NOISE))
    curve = search.evaluated((SelectedEffect(SINGLE, 3),), search.perfect())
    better = {h.candidates for h in neighbours(search, curve) if h.log_posterior > curve.log_posterior}
    assert {0, 6} in better


@pytest.mark.parametrize("truth", [{}, {2: 0.3}, {0: 0.2, 3: 0.3, 5: 0.5}])
def test_what_is_not_scored_at_every_size_is_not_among_the_best(truth: dict[int, float]) -> None:
    search = search_on(space_of(with_curve()), truth)
    everything = addition_scores(search.problem, search.groups, search.perfect())
    best = np.sort(everything.max(axis=0))[::-1]
    for count in (1, 3):
        for least in (-np.inf, 0.0, float(best[count])):
            asked = AskedAdditions(np.ones(SINGLE + 1, dtype=bool), count, least)
            some = addition_scores(search.problem, search.groups, search.perfect(), asked).max(axis=0)
            expected = [gain for gain in best[:count] if gain > least]
            np.testing.assert_allclose(np.sort(some)[::-1][: len(expected)], expected)


def test_special_cases_beyond_what_is_common_cost_more() -> None:
    search = search_on(space_of(with_curve()), {})
    assert search.space.excess_special_cases(frozenset({0, 1, 6})) == 1
    two, apart = (
        evaluate(search.problem, tuple(SelectedEffect(n, 0) for n in numbers), (0, 0), NOISE)
        for numbers in ((0, 1), (0, 6))
    )
    prices = [h.log_evidence - h.log_posterior for h in (two, apart)]
    costs = [sum(search.problem.cost(n) for n in numbers) for numbers in ((0, 1), (0, 6))]
    assert (prices[0] - costs[0]) - (prices[1] - costs[1]) == pytest.approx(15.0)


def test_special_cases_that_are_one_cause_count_as_one() -> None:
    *members, curve = with_curve()
    space = space_of([*members, replace(curve, as_one=frozenset({0, 1}))])
    assert space.excess_special_cases(frozenset({0, 1})) == 0
    assert space.excess_special_cases(frozenset({0, 1, 2})) == 1
    assert space.excess_special_cases(frozenset({0, 2})) == 1


def test_a_finer_form_competes_only_in_its_coarse_forms_place() -> None:
    fine = replace(single(1), columns=np.array([FRAMES + 1, FRAMES + 7]), prior_scale=np.ones(2))
    candidates = [*(single(n) for n in range(7)), replace(fine, competes=False, refines=1)]
    search = search_on(space_of(candidates), {1: 0.3, 7: 0.4})
    coarse = search.best()
    assert coarse.candidates == {1}
    finer = search.refined(coarse)
    assert finer.candidates == {7}
    assert search.coarsened(finer).candidates == {1}


def test_a_hypothesis_is_told_in_another_space_by_what_its_candidates_are() -> None:
    one = search_on(space_of([single(n) for n in range(SINGLE)]), {1: 0.3, 6: -0.4})
    other = search_on(space_of([single(n) for n in (6, 3, 2)]), {6: -0.4})
    assert other.transferred(one.best(), one.space).candidates == {0}


def test_candidates_of_an_exchange_leave_at_once_for_their_twins() -> None:
    space = space_of([single(n) for n in range(SINGLE)], exchanges=(Exchange({0: 4, 1: None}, (6,)),))
    search = search_on(space, {})

    def sets(numbers: tuple[int, ...]) -> list[Hypothesis]:
        chosen = tuple(SelectedEffect(n, 1) for n in numbers)
        return neighbours(search, evaluate(search.problem, chosen, (0, 0), NOISE))

    exchanged = [h for h in sets((0, 1, 3)) if h.candidates == {3, 4, 6}]
    assert {h.chosen[-1].size for h in exchanged} == {1, 2, 3}
    assert not any(h.candidates == {3, 4, 6} for h in sets((2, 3)))


def test_what_is_taken_out_together() -> None:
    candidates = [single(n) for n in range(SINGLE)]
    candidates[5] = replace(candidates[5], removed_with=frozenset({0, 7}))
    assert block_removals(space_of(candidates), [0, 4, 5]) == [(0,), (4,), (5,), (4, 5), (5, 0)]


def test_what_was_tried_with_all_backgrounds_is_not_remembered_where_some_columns_are_held() -> None:
    search = search_on(space_of([single(n) for n in range(SINGLE)]), {2: 0.3})
    search.best()
    assert search.resized
    assert not search.holding(np.array([FRAMES + 2])).resized


def test_many_small_values_are_a_background_and_one_large_one_a_name() -> None:
    rng = np.random.default_rng(5)
    everywhere = dict(enumerate(rng.normal(0, 0.02, SINGLE)))
    search = search_on(space_of([single(n) for n in range(SINGLE)]), everywhere | {3: 0.8})
    best = search.best()
    assert best.candidates == {3}
    assert best.background[0] == 2
    assert search.in_background(best, 3)
