"""Look-alikes are told: what the rows can't keep apart stands beside the name."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose, judgement
from armscope.diagnosis.held_out_worth import held_out_errors
from armscope.diagnosis.model_space import EffectSpace
from armscope.diagnosis.naming import named
from armscope.diagnosis.summary import alternatives as summary
from armscope.diagnosis.summary.alternatives import _held_out_errors, alternatives, inclusion_frequency
from armscope.diagnosis.summary.rivals import too_close
from armscope.inference.edits import by_posterior
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import Candidate, ModelSpace
from armscope.inference.problem import SelectedEffect, build_problem
from armscope.inference.search import Search
from tests.diagnosis.planted import planted
from tests.diagnosis.test_better_placed import (
    DRIVE_AT,
    NOISE,
    TILT_AT,
    problem_where,
    rows_where,
    sums,
    with_drive_named,
)
from tests.seeds import seeds


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(6, 7))
def test_what_got_its_name_out_of_a_background_has_rivals_too(seed: int) -> None:
    """An upright first bearing and the second drive turn a seven-axis arm alike where loads are alike."""
    rng = np.random.default_rng(seed)
    give = {("joint_compliance", f"joint {j}"): [4e-7 * rng.uniform(0.5, 1.5)] for j in range(2, 7)}
    give |= {("bearing_compliance", f"joint {j}"): [2e-7 * rng.uniform(0.5, 1.5)] for j in range(2, 6)}
    give[("bearing_compliance", "joint 1")] = [2.4e-6]
    arm, table = planted("seven-axis", give, 250, 0.025, seed)
    largest = diagnose(arm, table, Settings(resamples=0, cross_validation=False)).effects[0]
    told = {(largest.effect, largest.location), *((a.effect, a.location) for a in largest.alternatives)}
    assert told >= {("bearing_compliance", "joint 1"), ("joint_compliance", "joint 2")}
    assert largest.named_as != "effect"


def test_a_rival_in_the_same_background_pays_no_more_than_the_name() -> None:
    """The gap is that of the evidence: what is freed, the name's own column held at zero, at no price."""
    problem = problem_where(DRIVE_AT, 0.98, drive=-0.2)
    best = with_drive_named(problem)
    (rival,) = [r for r in alternatives(Search.on(problem), best)[DRIVE_AT] if r.hypothesis.candidates == {TILT_AT}]
    held = problem.holding(problem.space.candidates[DRIVE_AT].columns)
    by_hand = max(
        evaluate(held, (SelectedEffect(TILT_AT, size, nested=True),), best.background, NOISE).log_posterior
        for size in range(len(problem.sizes))
    )
    assert rival.gap == pytest.approx(best.log_posterior - by_hand, abs=0.2)
    assert rival.held == tuple(problem.space.candidates[DRIVE_AT].columns)


def test_a_name_that_paid_is_weighed_against_a_rival_that_pays_nothing_at_the_same_price() -> None:
    """A bearing stood beside a drive as "8.6 nats better": the drive had paid for its name, and the bearing had not."""
    problem = problem_where(DRIVE_AT, 0.98, drive=-0.2)
    promoted, search = with_drive_named(problem), Search.on(problem)
    paid = search.evaluated(tuple(replace(c, nested=False) for c in promoted.chosen), promoted)
    assert paid.log_posterior < promoted.log_posterior - 1
    gaps = [{r.hypothesis.candidates: r.gap for r in alternatives(search, best)[DRIVE_AT]} for best in (promoted, paid)]
    tilt = frozenset({TILT_AT})
    assert gaps[1][tilt] == pytest.approx(gaps[0][tilt], abs=0.1)


def test_a_rival_is_judged_on_held_out_rows_with_the_names_own_column_at_zero() -> None:
    """The drive gives way besides: the background would take that up if it were not held."""
    X, y = rows_where(DRIVE_AT, 0.98, drive=-0.2)
    blocks = [sums(X[n::10], y[n::10]) for n in range(10)]
    problem = problem_where(DRIVE_AT, 0.98, drive=-0.2)
    best = with_drive_named(problem)
    rival = next(r for r in alternatives(Search.on(problem), best)[DRIVE_AT] if r.hypothesis.candidates == {TILT_AT})
    state: Any = SimpleNamespace(problem=problem, best=best, blocks=blocks)
    told = _held_out_errors(state, [rival]).sum(axis=0)
    without = problem.holding(np.array(rival.held))
    readings = [(rival.hypothesis.chosen, rival.hypothesis.background)]
    assert told[1] == pytest.approx(held_out_errors(without, blocks, readings, best.noise).sum())
    assert told[1] > held_out_errors(problem, blocks, readings, best.noise).sum() > told[0]


@pytest.mark.parametrize(
    ("nats", "excluded", "family", "sure"),
    [(1.0, True, "elastic", False), (7.0, False, "elastic", False), (7.0, True, "elastic", True),
     (7.0, None, "elastic", True), (7.0, False, "geometric", True)],
)  # fmt: skip
def test_a_name_out_of_a_background_is_sure_where_held_out_rows_exclude_its_rivals_there(
    nats: float, excluded: bool | None, family: str, sure: bool
) -> None:
    problem = problem_where(DRIVE_AT, 0.98, drive=-0.2)
    best = with_drive_named(problem)
    rival = next(r for r in alternatives(Search.on(problem), best)[DRIVE_AT] if r.hypothesis.candidates == {TILT_AT})
    effect = replace(problem.space.candidates[DRIVE_AT], family="elastic")
    judged = rival._replace(excluded=excluded, candidate=replace(rival.candidate, family=family))
    assert (too_close(effect, [judged], [nats]) == []) == sure
    assert too_close(effect, [judged._replace(near=False)], [nats]) == []
    assert too_close(effect, [judged._replace(held=())], [7.0]) == []


def test_what_explains_nothing_is_no_rival_however_faint_the_name() -> None:
    problem = problem_where(DRIVE_AT, 0.0, drive=-0.27)
    best = with_drive_named(problem)
    base = Search.on(problem).holding(problem.space.candidates[DRIVE_AT].columns).without(best, [DRIVE_AT])
    assert 3 < best.log_posterior - base.log_posterior < 10  # any other would be near enough to be listed
    assert alternatives(Search.on(problem), best)[DRIVE_AT] == []


def test_what_is_less_likely_than_nothing_is_no_rival() -> None:
    """A faint effect stands little above nothing in its place; so would any other column, near enough to be listed."""
    rng = np.random.default_rng(11)
    X = rng.normal(size=(200, 3))
    both = tuple(Candidate(name, "here", np.array([n]), np.ones(1)) for n, name in ((1, "faint"), (2, "other")))
    space = ModelSpace(np.array([0]), (), both)
    problem = build_problem(space, sums(X, 0.035 * X[:, 1] + rng.normal(0, 0.1, len(X))), 0.05)
    nothing, best, other = (
        max((evaluate(problem, chosen, (), 0.1) for chosen in readings), key=by_posterior)
        for readings in (
            [()],
            *([(SelectedEffect(n, size),) for size in range(len(problem.sizes))] for n in (0, 1)),
        )
    )
    assert 0 < best.log_posterior - nothing.log_posterior < 10
    assert nothing.log_posterior - other.log_posterior > 0
    assert best.log_posterior - other.log_posterior < 10
    assert alternatives(Search.on(problem), best)[0] == []


@pytest.mark.parametrize(("columns", "listed"), [((1, 2), False), ((2,), True)])
def test_an_effect_and_something_beside_is_no_rival_of_it(columns: tuple[int, ...], listed: bool) -> None:
    """A zero that moves with temperature and is off at 20 degrees is a zero that is off, and maybe nothing else."""
    rng = np.random.default_rng(12)
    X = rng.normal(size=(60, 3))
    X[:, 2] = X[:, 1] + 0.1 * X[:, 2]  # as near as to be listed where it is another effect
    many = tuple(
        Candidate(name, "here", np.array(of), np.ones(len(of))) for name, of in (("off", (1,)), ("moves", columns))
    )
    space = ModelSpace(np.array([0]), (), many)
    problem = build_problem(space, sums(X, 0.3 * X[:, 1] + rng.normal(0, 0.1, len(X))), 0.05)
    sizes = range(len(problem.sizes))
    best = max((evaluate(problem, (SelectedEffect(0, size),), (), 0.1) for size in sizes), key=by_posterior)
    assert bool(alternatives(Search.on(problem), best)[0]) == listed


@pytest.mark.parametrize("alike", [0.0, 1.0])
def test_what_was_refused_beside_an_effect_does_not_take_its_place(alike: float) -> None:
    """The other column is large and by itself; or it is nearly the effect's own, and may well be it instead."""
    rng = np.random.default_rng(9)
    X = rng.normal(size=(200, 3))
    X[:, 2] = alike * X[:, 1] + (1 - 0.95 * alike) * X[:, 2]
    y = 0.04 * X[:, 1] + (0.5 if not alike else 0.0) * X[:, 2] + rng.normal(0, 0.1, len(X))
    both = tuple(Candidate(name, "here", np.array([n]), np.ones(1)) for n, name in ((1, "faint"), (2, "other")))
    problem = build_problem(ModelSpace(np.array([0]), (), both), sums(X, y), 0.05)
    best = max(
        (evaluate(problem, (SelectedEffect(0, size),), (), 0.1) for size in range(len(problem.sizes))), key=by_posterior
    )
    rivals = alternatives(Search.on(problem), best)[0]
    assert [rival.candidate.kind for rival in rivals] == (["other"] if alike else [])


@pytest.mark.long
def test_rows_that_are_drawn_twice_make_no_noise_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the same reading to the last digit looks as if there was none: any curve through it was then right."""
    told, drawn = [], []

    def frequency(state: Any, draws: int, rng: np.random.Generator) -> dict[int, float]:
        told.append(state.best.noise)
        return inclusion_frequency(state, draws, rng)

    def names(search: Search, space: EffectSpace, found: Hypothesis) -> Hypothesis:
        drawn.append(found.noise)
        return named(search, space, found)

    monkeypatch.setattr(judgement, "inclusion_frequency", frequency)
    monkeypatch.setattr(summary, "named", names)
    arm, table = planted("four-axis", {("joint_offset", "joint 3"): [1e-3]}, 60, 0.03, 1)
    diagnose(arm, table, Settings(resamples=6, cross_validation=False))
    assert len(drawn) == 6
    assert min(drawn) >= told[0]
