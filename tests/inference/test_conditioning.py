"""Gains and changes at the noise as it is, against hypotheses that are weighed anew with the noise held."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis.model_space import build_model_space
from armscope.fitting.block_sums import normal_equations_by_block
from armscope.fitting.registration import fit_frames
from armscope.inference import linear_algebra
from armscope.inference.additions import AskedAdditions, addition_scores, background_scores, group_candidates
from armscope.inference.conditioning import condition_on, low_rank_update
from armscope.inference.edits import replaced
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.normal_equations import total
from armscope.inference.problem import Problem, SelectedEffect, build_problem
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import backgrounds
from armscope.physics.frames import free_frames
from armscope.physics.registry import library
from tests.diagnosis.planted import planted

from ..backgrounds import sizes

ROWS, NOISE = 40, 0.2
"""The noise is held at this: far above what the data would say, so that it is the least that is allowed."""


@pytest.fixture(scope="module")
def setting() -> Problem:
    arm, table = planted("six-axis", {("joint_compliance", "joint 2"): [2e-7]}, ROWS, 0.03, seed=1)
    model = fit_frames(arm, table)
    parts = build_model_space(free_frames(table, False), list(backgrounds(arm, table).values()), library(arm, table))
    weights = RowWeights.of_positions(np.ones(ROWS))
    gram = total(normal_equations_by_block(parts.layout, model, table, weights, np.arange(ROWS) % 5))
    return replace(build_problem(parts, gram, 0.0), least_noise=NOISE)


def whole(problem: Problem, background: BackgroundSizes) -> Hypothesis:
    at = {(*p.key, p.variant): n for n, p in reversed(list(enumerate(problem.space.candidates)))}
    names = [("joint_compliance", "joint 2"), ("gear_ratio", "joint 4"), ("link_geometry", "link 2")]
    hypothesis = evaluate(problem, tuple(SelectedEffect(at[(*key, "")], 3) for key in names), background, NOISE)
    assert hypothesis.noise == NOISE
    return hypothesis


@pytest.mark.parametrize("background", [sizes(), sizes(4, 2, 1)])
@pytest.mark.parametrize("removed", [0, 1, 2])
def test_a_removal_is_what_is_weighed_without_it(setting: Problem, background: BackgroundSizes, removed: int) -> None:
    """Alone or, where a background holds the same columns, with that."""
    hypothesis = whole(setting, background)
    kept = tuple(c for n, c in enumerate(hypothesis.chosen) if n != removed)
    smaller, anew = low_rank_update(setting, hypothesis, kept, background), evaluate(setting, kept, background, NOISE)
    assert smaller is not None
    assert smaller.log_posterior == pytest.approx(anew.log_posterior, abs=1e-6)
    assert smaller.rss == pytest.approx(anew.rss, rel=1e-9)
    groups = group_candidates(setting)
    told = smaller.conditioned(condition_on(setting, groups.competing, hypothesis))
    expected = condition_on(setting, groups.competing, anew)
    np.testing.assert_allclose(told.b, expected.b, atol=1e-7 * np.abs(setting.equations.b).max())
    for at in groups.columns:
        np.testing.assert_allclose(told.own(setting, at), expected.own(setting, at), atol=1e-7 * 3 * ROWS)
    # gains differ only in what is added for the noise, which here stays in both
    promised = addition_scores(setting, groups, smaller, rest=told)
    np.testing.assert_allclose(promised, addition_scores(setting, groups, anew), atol=1e-4)


@pytest.mark.parametrize("size", [0, 2, 4])
@pytest.mark.parametrize("number", [0, 2])
def test_another_size_is_what_is_weighed_with_it(setting: Problem, number: int, size: int) -> None:
    hypothesis = whole(setting, sizes(2, 1))
    resized = replace(hypothesis.chosen[number], size=size)
    chosen = (*hypothesis.chosen[:number], resized, *hypothesis.chosen[number + 1 :])
    other = low_rank_update(setting, hypothesis, chosen, hypothesis.background)
    assert other is not None
    assert other.log_posterior == pytest.approx(
        evaluate(setting, chosen, hypothesis.background, NOISE).log_posterior, abs=1e-6
    )


@pytest.mark.parametrize("background", [sizes(2), sizes(4, 1), sizes(0, 1)])
def test_another_background_is_what_is_weighed_with_it(setting: Problem, background: BackgroundSizes) -> None:
    hypothesis = whole(setting, sizes(2, 1))
    other = low_rank_update(setting, hypothesis, hypothesis.chosen, background)
    assert other is not None
    assert other.log_posterior == pytest.approx(
        evaluate(setting, hypothesis.chosen, background, NOISE).log_posterior, abs=1e-6
    )


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("background", [sizes(), sizes(2, 1)])
def test_a_background_promises_what_is_weighed_with_it(
    setting: Problem, background: BackgroundSizes, number: int
) -> None:
    hypothesis, family = whole(setting, background), setting.space.families[number]
    if background[number] or not len(family.columns):
        pytest.skip("it is there already, or has no members on this arm")
    promised = background_scores(setting, hypothesis, number)
    for size in range(1, family.sizes):
        other = evaluate(setting, hypothesis.chosen, replaced(background, number, size), NOISE)
        gained = other.log_evidence - hypothesis.log_evidence - setting.family_costs[number]
        assert promised[size - 1] == pytest.approx(gained, abs=1e-5)


def test_what_needs_further_columns_must_be_weighed(setting: Problem) -> None:
    hypothesis = whole(setting, sizes())
    assert low_rank_update(setting, hypothesis, hypothesis.chosen, sizes(2)) is None


def test_only_what_is_asked_is_answered(setting: Problem) -> None:
    hypothesis, groups = whole(setting, sizes(2)), group_candidates(setting)
    asked = np.arange(len(setting.prior_costs)) % 3 == 0
    everything = addition_scores(setting, groups, hypothesis)
    some = addition_scores(setting, groups, hypothesis, AskedAdditions(asked, len(asked), -np.inf))
    np.testing.assert_array_equal(some[:, asked], everything[:, asked])
    assert np.all(np.isneginf(some[:, ~asked]))


def test_gains_are_the_same_by_factors_as_by_eigenvalues(setting: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    hypothesis, groups = whole(setting, sizes(2)), group_candidates(setting)
    by_factors = addition_scores(setting, groups, hypothesis)

    def indefinite(*blocks: Array) -> None:
        raise np.linalg.LinAlgError

    monkeypatch.setattr(linear_algebra, "_factorised", indefinite)
    np.testing.assert_allclose(by_factors, addition_scores(setting, groups, hypothesis), rtol=1e-8, atol=1e-7)


@pytest.mark.parametrize("columns", [1, 2, 5])
def test_quadratic_and_volume_are_those_of_whole_matrices(columns: int) -> None:
    rng = np.random.default_rng(columns)
    half, r, widths = (rng.normal(size=shape) for shape in ((4, 9, columns), (4, columns), (3, 4, columns)))
    D = np.swapaxes(half, 1, 2) @ half
    quadratic, logdet = linear_algebra.quadratic_and_logdet(D, r, np.abs(widths))
    for size, block in np.ndindex(3, 4):
        width = np.diag(np.abs(widths[size, block]))
        whole_matrix = D[block] + np.linalg.inv(width**2)
        assert quadratic[size, block] == pytest.approx(r[block] @ np.linalg.solve(whole_matrix, r[block]))
        assert logdet[size, block] == pytest.approx(np.linalg.slogdet(np.eye(columns) + width @ D[block] @ width)[1])
