"""The closed-form evidence against brute-force Gaussian densities, and its shortcuts against itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

from armscope.diagnosis.model_space import build_model_space
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.design_matrix import point_columns
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.registration import fit_frames
from armscope.inference.additions import best_additions, group_candidates
from armscope.inference.evidence import evaluate
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.normal_equations import total
from armscope.inference.problem import Problem, SelectedEffect, build_problem, prior_costs, prior_variances
from armscope.inference.removals import removal_log_bayes_factors, savage_dickey
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import FAMILIES, backgrounds
from armscope.physics.effect import Placed
from armscope.physics.frames import free_frames
from armscope.physics.registry import library

from ..backgrounds import sizes
from ..diagnosis.planted import planted

ROWS = 40
PERFECT = sizes()


@pytest.fixture(scope="module")
def setting() -> tuple[Problem, np.ndarray, np.ndarray]:
    """A problem with its columns (scaled) and response written out, mm."""
    arm, table = planted("six-axis", {("joint_compliance", "joint 2"): [2e-7]}, ROWS, 0.03, seed=1)
    model = fit_frames(arm, table)
    parts = build_model_space(free_frames(table, False), list(backgrounds(arm, table).values()), library(arm, table))
    blocks = normal_equations_by_block(
        parts.layout, model, table, RowWeights.of_positions(np.ones(ROWS)), np.arange(ROWS) % 5
    )
    problem = build_problem(parts, total(blocks), 0.0)
    X = point_columns(model.posture(model.scene(table)), parts.layout.terms) / problem.scale
    return problem, X, point_residuals(model, table).reshape(-1)


def numbers(problem: Problem, *keys: tuple[str, str]) -> tuple[SelectedEffect, ...]:
    at = {(*p.key, p.variant): n for n, p in reversed(list(enumerate(problem.space.candidates)))}
    return tuple(SelectedEffect(at[(*key, "")], 3) for key in keys)


def test_blocks_add_up_to_the_sums_over_all_rows(setting: tuple[Problem, np.ndarray, np.ndarray]) -> None:
    problem, X, y = setting
    np.testing.assert_allclose(problem.equations.G, X.T @ X, rtol=1e-9, atol=1e-9 * len(y))
    np.testing.assert_allclose(problem.equations.b, X.T @ y, atol=1e-8 * len(y))
    assert problem.equations.yy == pytest.approx(y @ y)
    assert problem.equations.n == 3 * ROWS


@pytest.mark.parametrize("background", [PERFECT, sizes(4), sizes(3, 2, 1)])
def test_evidence_is_the_density_of_the_data(
    setting: tuple[Problem, np.ndarray, np.ndarray], background: BackgroundSizes
) -> None:
    """Differences of evidence are differences of log N(y; 0, X P X' + noise^2 I), prices taken off.

    A compliance is not negative: its prior is the normal's upper half, twice as dense.
    """
    problem, X, y = setting

    def brute(chosen: tuple[SelectedEffect, ...], noise: float) -> float:
        prior = prior_variances(problem, chosen, background)
        covariance = (X * prior) @ X.T + noise**2 * np.eye(len(y))
        return float(multivariate_normal(np.zeros(len(y)), covariance, allow_singular=False).logpdf(y))

    def upper_half(chosen: tuple[SelectedEffect, ...], noise: float) -> float:
        prior = prior_variances(problem, chosen, background)
        at = problem.space.candidates[chosen[0].candidate].columns[0]
        covariance = (X * prior) @ X.T + noise**2 * np.eye(len(y))
        towards = prior[at] * np.linalg.solve(covariance, X[:, at])
        variance = prior[at] - prior[at] * X[:, at] @ towards
        return float(np.log(2) + norm.logcdf(towards @ y / np.sqrt(variance)))

    with_it = evaluate(problem, numbers(problem, ("joint_compliance", "joint 2")), background, 0.03)
    without = evaluate(problem, (), background, 0.1)
    price = problem.prior_costs[with_it.chosen[0].candidate] + np.log(len(problem.sizes))
    expected = brute(with_it.chosen, with_it.noise) - brute((), without.noise)
    expected += upper_half(with_it.chosen, with_it.noise)
    assert with_it.log_posterior - without.log_posterior + price == pytest.approx(expected, abs=1e-3)


def test_a_predicted_gain_is_the_gain(setting: tuple[Problem, np.ndarray, np.ndarray]) -> None:
    problem, *_ = setting
    parent = evaluate(problem, numbers(problem, ("joint_compliance", "joint 2")), PERFECT, 0.03)
    gain, size = best_additions(problem, group_candidates(problem), parent)
    for candidate in (0, 9, 40, 70):
        child = evaluate(
            problem, (*parent.chosen, SelectedEffect(candidate, int(size[candidate]))), PERFECT, parent.noise
        )
        assert child.log_posterior - parent.log_posterior == pytest.approx(gain[candidate], abs=0.3)


def test_a_predicted_loss_is_the_loss(setting: tuple[Problem, np.ndarray, np.ndarray]) -> None:
    """With noise known (not re-estimated), removal by the Savage-Dickey ratio is exact."""
    problem, *_ = setting
    chosen = numbers(problem, ("joint_offset", "joint 3"), ("gear_ratio", "joint 4"), ("link_geometry", "link 2"))
    for background in (PERFECT, sizes(4, 2, 1)):
        whole = evaluate(problem, chosen, background, 0.05)
        fixed = replace(problem, least_noise=whole.noise * 1.5)
        whole = evaluate(fixed, chosen, background, fixed.least_noise)
        lost = removal_log_bayes_factors(fixed, whole)
        for number in range(len(chosen)):
            less = evaluate(fixed, chosen[:number] + chosen[number + 1 :], background, fixed.least_noise)
            assert whole.log_posterior - less.log_posterior == pytest.approx(lost[number], abs=1e-4)


def test_pinning_an_effect_is_removing_it_where_nothing_else_holds_it(
    setting: tuple[Problem, np.ndarray, np.ndarray],
) -> None:
    problem, *_ = setting
    chosen = numbers(problem, ("gear_ratio", "joint 3"), ("joint_compliance", "joint 2"))
    whole = evaluate(problem, chosen, PERFECT, 0.05)
    pinned = np.array([savage_dickey(whole, problem.space.candidates[c.candidate].columns) for c in chosen])
    prices = [problem.prior_costs[c.candidate] + np.log(len(problem.sizes)) for c in chosen]
    np.testing.assert_allclose(pinned - prices, removal_log_bayes_factors(problem, whole), atol=1e-6)


def test_a_larger_library_makes_a_name_dearer() -> None:
    arm, table = planted("six-axis", {}, ROWS, 0.03, seed=1)
    frames = free_frames(table, False)
    none: list[list[Placed]] = [[] for _ in FAMILIES]
    few = build_model_space(frames, none, [p for p in library(arm, table) if p.name == "joint_offset"])
    many = build_model_space(frames, none, library(arm, table))
    cheap, dear = prior_costs(few)[0], prior_costs(many)[0]
    assert dear > cheap + 2
