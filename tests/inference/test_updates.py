"""Gains and changes at the noise as it is, against hypotheses that are weighed anew with the noise held."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.fitting.linearisation import accumulate
from armscope.fitting.model_space import pool
from armscope.fitting.registration import fit_frames
from armscope.inference import evidence
from armscope.inference import updates as gains
from armscope.inference.evidence import Chosen, Hypothesis, Problem, weigh
from armscope.inference.normal_equations import total
from armscope.inference.updates import changed, gains_by_size, group, left
from armscope.measurement.row_weights import RowWeights
from armscope.physics.backgrounds import backgrounds
from armscope.physics.frames import free_frames
from armscope.physics.registry import library
from tests.diagnosis.planted import planted

ROWS, NOISE = 40, 0.2
"""The noise is held at this: far above what the data would say, so that it is the least that is allowed."""


@pytest.fixture(scope="module")
def setting() -> Problem:
    arm, table = planted("six-axis", {("joint_compliance", "joint 2"): [2e-7]}, ROWS, 0.03, seed=1)
    model = fit_frames(arm, table)
    parts = pool(free_frames(table, False), list(backgrounds(arm, table).values()), library(arm, table))
    gram = total(accumulate(parts, model, table, RowWeights(np.ones(ROWS)), np.arange(ROWS) % 5))
    return replace(evidence.problem(parts, gram, 0.0), least_noise=NOISE)


def whole(problem: Problem, background: evidence.Background) -> Hypothesis:
    at = {(*p.key, p.variant): n for n, p in reversed(list(enumerate(problem.pool.candidates)))}
    names = [("joint_compliance", "joint 2"), ("gear_ratio", "joint 4"), ("link_geometry", "link 2")]
    hypothesis = weigh(problem, tuple(Chosen(at[(*key, "")], 3) for key in names), background, NOISE)
    assert hypothesis.noise == NOISE
    return hypothesis


@pytest.mark.parametrize("background", [(0, 0, 0), (4, 2, 1)])
@pytest.mark.parametrize("removed", [0, 1, 2])
def test_a_removal_is_what_is_weighed_without_it(
    setting: Problem, background: evidence.Background, removed: int
) -> None:
    """Alone or, where a background holds the same columns, with that."""
    hypothesis = whole(setting, background)
    kept = tuple(c for n, c in enumerate(hypothesis.chosen) if n != removed)
    smaller, anew = changed(setting, hypothesis, kept, background), weigh(setting, kept, background, NOISE)
    assert smaller is not None
    assert smaller.value == pytest.approx(anew.value, abs=1e-6)
    assert smaller.rss == pytest.approx(anew.rss, rel=1e-9)
    groups = group(setting.pool)
    told = smaller.left(left(setting, groups.competing, hypothesis))
    expected = left(setting, groups.competing, anew)
    np.testing.assert_allclose(told.b, expected.b, atol=1e-7 * np.abs(setting.gram.b).max())
    for at in groups.columns:
        np.testing.assert_allclose(told.own(setting, at), expected.own(setting, at), atol=1e-7 * 3 * ROWS)
    # gains differ only in what is added for the noise, which here stays in both
    promised = gains_by_size(setting, groups, smaller, rest=told)
    np.testing.assert_allclose(promised, gains_by_size(setting, groups, anew), atol=1e-4)


@pytest.mark.parametrize("size", [0, 2, 4])
@pytest.mark.parametrize("number", [0, 2])
def test_another_size_is_what_is_weighed_with_it(setting: Problem, number: int, size: int) -> None:
    hypothesis = whole(setting, (2, 1, 0))
    resized = replace(hypothesis.chosen[number], size=size)
    chosen = (*hypothesis.chosen[:number], resized, *hypothesis.chosen[number + 1 :])
    other = changed(setting, hypothesis, chosen, hypothesis.background)
    assert other is not None
    assert other.value == pytest.approx(weigh(setting, chosen, hypothesis.background, NOISE).value, abs=1e-6)


@pytest.mark.parametrize("background", [(2, 0, 0), (4, 1, 0), (0, 1, 0)])
def test_another_background_is_what_is_weighed_with_it(setting: Problem, background: evidence.Background) -> None:
    hypothesis = whole(setting, (2, 1, 0))
    other = changed(setting, hypothesis, hypothesis.chosen, background)
    assert other is not None
    assert other.value == pytest.approx(weigh(setting, hypothesis.chosen, background, NOISE).value, abs=1e-6)


def test_what_needs_further_columns_must_be_weighed(setting: Problem) -> None:
    hypothesis = whole(setting, (0, 0, 0))
    assert changed(setting, hypothesis, hypothesis.chosen, (2, 0, 0)) is None


def test_only_what_is_asked_is_answered(setting: Problem) -> None:
    hypothesis, groups = whole(setting, (2, 0, 0)), group(setting.pool)
    asked = np.arange(len(setting.costs)) % 3 == 0
    everything = gains_by_size(setting, groups, hypothesis)
    some = gains_by_size(setting, groups, hypothesis, asked)
    np.testing.assert_array_equal(some[:, asked], everything[:, asked])
    assert np.all(np.isneginf(some[:, ~asked]))


def test_sets_of_many_columns_gain_the_same_by_factors_as_by_eigenvalues(
    setting: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    hypothesis, groups = whole(setting, (2, 0, 0)), group(setting.pool)
    assert max(columns.shape[1] for columns in groups.columns) > gains.MANY_COLUMNS
    by_factors = gains_by_size(setting, groups, hypothesis)
    monkeypatch.setattr(gains, "MANY_COLUMNS", 1000)
    np.testing.assert_allclose(by_factors, gains_by_size(setting, groups, hypothesis), rtol=1e-8, atol=1e-7)
