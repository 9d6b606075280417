"""Whether anything is missing at all is told before, and apart from, what it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import diagnose
from armscope.diagnosis.model_space import build_model_space
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.registration import fit_frames
from armscope.inference.constants import DETECTION, PRIORS
from armscope.inference.detection import averaged_log_odds
from armscope.inference.evidence import evaluate
from armscope.inference.normal_equations import total
from armscope.inference.problem import Problem, SelectedEffect, build_problem
from armscope.inference.search import Search
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import backgrounds
from armscope.physics.frames import free_frames
from armscope.physics.registry import library

from ..backgrounds import sizes
from ..diagnosis.planted import planted
from ..diagnosis.test_diagnose import QUICK

ROWS, NOISE_MM = 80, 0.03
PERFECT = sizes()


@pytest.fixture(scope="module")
def setting() -> tuple[Problem, np.ndarray]:
    """An arm's library at random poses, and its columns, scaled."""
    arm, table = planted("six-axis", {}, ROWS, NOISE_MM, seed=5)
    model = fit_frames(arm, table)
    parts = build_model_space(free_frames(table, False), list(backgrounds(arm, table).values()), library(arm, table))
    weights = RowWeights.of_positions(np.ones(ROWS))
    gram = total(normal_equations_by_block(parts.layout, model, table, weights, np.arange(ROWS) % 5))
    problem = build_problem(parts, gram, 0.97 * NOISE_MM)
    return problem, point_columns(model.posture(model.scene(table)), parts.layout.terms) / problem.scale


def read(problem: Problem, X: np.ndarray, y: np.ndarray) -> Problem:
    """The same poses with other readings, mm."""
    return replace(problem, equations=replace(problem.equations, b=X.T @ y, yy=float(y @ y)))


def log_odds(problem: Problem, X: np.ndarray, y: np.ndarray) -> float:
    return averaged_log_odds(Search.on(read(problem, X, y))).log_odds


@pytest.mark.parametrize(("draws", "most"), [(75, 1), pytest.param(150, 2, marks=pytest.mark.long)])
def test_noise_alone_seldom_looks_like_something(setting: tuple[Problem, np.ndarray], draws: int, most: int) -> None:
    """An average of evidence exceeds odds of x to 1 in at most one case of x by chance (Markov's inequality)."""
    problem, X = setting
    rng = np.random.default_rng(8)
    odds = np.array([log_odds(problem, X, rng.normal(0, NOISE_MM, len(X))) for _ in range(draws)])
    for bound in (0.0, 1.0):
        assert np.mean(odds > bound) < np.exp(-bound)
    assert np.count_nonzero(odds > DETECTION.detected_nats) <= most


@pytest.mark.long
@pytest.mark.parametrize("draws", [20, pytest.param(40, marks=pytest.mark.long)])
def test_something_is_known_to_be_there_before_it_can_be_named(setting: tuple[Problem, np.ndarray], draws: int) -> None:
    problem, X = setting
    offset = next(n for n, p in enumerate(problem.space.candidates) if p.key == ("gear_ratio", "joint 3"))
    column = X[:, problem.space.candidates[offset].columns[0]]
    rng = np.random.default_rng(9)
    seen = named = 0
    for _ in range(draws):
        other = read(problem, X, 5.8 * NOISE_MM * column / np.linalg.norm(column) + rng.normal(0, NOISE_MM, len(X)))
        search = Search.on(other)
        seen += averaged_log_odds(search).detected
        named += bool(search.best().chosen)
    assert named < seen
    assert seen >= draws / 2


def test_a_name_that_is_not_worth_its_price_goes(setting: tuple[Problem, np.ndarray]) -> None:
    problem, X = setting
    rng = np.random.default_rng(10)
    strong = next(n for n, p in enumerate(problem.space.candidates) if p.key == ("joint_compliance", "joint 2"))
    weak = next(n for n, p in enumerate(problem.space.candidates) if p.key == ("servo_lag", "joint 4"))
    y = 10 * NOISE_MM * X[:, problem.space.candidates[strong].columns[0]] + rng.normal(0, NOISE_MM, len(X))
    search = Search.on(read(problem, X, y))
    both = evaluate(search.problem, (SelectedEffect(strong, 4), SelectedEffect(weak, 0)), PERFECT, NOISE_MM)
    assert search.log_odds(both, weak) < PRIORS.sure_nats < search.log_odds(both, strong)
    weakest = search.weakest(both)
    assert weakest is not None
    left = search.without(both, [weakest.candidate])
    assert left.candidates == {strong}
    assert search.weakest(left) is None


def test_a_faint_effect_is_told_without_a_name() -> None:
    """About four standard errors of one number: more than noise, not enough for a name out of a large library."""
    arm, table = planted("six-axis", {("servo_lag", "joint 2"): [3e-5]}, 100, 0.03, seed=14)
    verdict = diagnose(arm, table, QUICK)
    assert not verdict.effects
    assert verdict.mismatch
    assert verdict.answer == "cannot tell"
    assert "servo lag at joint 2" in verdict.unexplained.description
    assert verdict.unexplained.description in verdict.headline
