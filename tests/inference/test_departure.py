"""A hypothesis beside a known one has the evidence of its own factor, whatever enters, leaves or changes its size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.inference import evidence
from armscope.inference.constants import NUMERICS
from armscope.inference.departure import departure
from armscope.inference.evidence import Hypothesis, evaluate
from armscope.inference.model_space import BackgroundSizes
from armscope.inference.problem import Problem, SelectedEffect, prior_variances

from ..backgrounds import sizes
from .test_evidence import PERFECT, numbers, setting

__all__ = ["setting"]

HELD = (("joint_offset", "joint 3"), ("gear_ratio", "joint 4"), ("joint_compliance", "joint 2"))
LARGE = sizes(4, 2, 1)
PAIRS = [("og", "ogc"), ("ogc", "og"), ("oc", "lc"), ("ogc", "Ogl"), ("og", "og")]


def effects(problem: Problem, places: str) -> tuple[SelectedEffect, ...]:
    """Effects by their letters: o(ffset), g(ear ratio), c(ompliance), l(ink geometry), O: a larger offset."""
    o, g, c = numbers(problem, *HELD)
    (link,) = numbers(problem, ("link_geometry", "link 2"))
    by_letter = {"o": o, "g": g, "c": c, "l": link, "O": replace(o, size=4), "C": replace(c, size=4)}
    return tuple(by_letter[place] for place in places)


@pytest.mark.parametrize(("known", "before", "after"), [(PERFECT, "og", "ogc"), *((LARGE, *pair) for pair in PAIRS)])
def test_a_first_step_is_that_of_a_factor_of_its_own(
    setting: tuple[Problem, np.ndarray, np.ndarray], known: BackgroundSizes, before: str, after: str
) -> None:
    """By brute force: the noise's covariance of all data, its determinant and inverse."""
    problem, X, y = setting
    near = evaluate(problem, effects(problem, before), known, 0.05)
    prior = prior_variances(problem, effects(problem, after), known)
    columns = np.flatnonzero(prior)
    step = departure(near, columns, prior[columns])
    assert step is not None
    s = near.noise**2
    covariance = (X * prior) @ X.T + s * np.eye(len(y))
    of_noise = s * np.linalg.inv(covariance)
    left = of_noise @ y
    was = (X * prior_variances(problem, near.chosen, known)) @ X.T + s * np.eye(len(y))
    gain = step.log_evidence - near.log_evidence
    expected = np.linalg.slogdet(was)[1] - np.linalg.slogdet(covariance)[1]
    expected += y @ np.linalg.solve(was, y) - y @ np.linalg.solve(covariance, y)
    assert gain == pytest.approx(expected / 2, abs=1e-5)
    assert step.rss == pytest.approx(y @ left, rel=1e-7)
    assert step.misfit == pytest.approx(left @ left, rel=1e-7)
    assert step.effective_dof == pytest.approx(len(y) - np.trace(of_noise), abs=1e-6)
    at = np.setdiff1d(columns, [*step.lost, *problem.space.frames])  # of frames the brute force knows few digits
    values = prior[at] * (X[:, at].T @ left) / s
    np.testing.assert_allclose(step.means(at), values, atol=1e-6)
    spread = step.spread(at)
    assert spread is not None
    variances = prior[at] - prior[at] ** 2 * np.einsum("nk,nm,mk->k", X[:, at], of_noise / s, X[:, at])
    np.testing.assert_allclose(near.noise**2 * spread**2, variances, rtol=1e-4, atol=1e-9)


@pytest.mark.parametrize("noise", [0.02, 0.2])
@pytest.mark.parametrize("after", ["og", "ogcl", "gcO", "l", "oC"])
def test_evidence_beside_a_known_hypothesis_is_that_from_scratch(
    setting: tuple[Problem, np.ndarray, np.ndarray], after: str, noise: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the noise settles elsewhere, or stays, and where a value can't be negative."""
    problem, *_ = setting
    monkeypatch.setattr(evidence, "NUMERICS", replace(NUMERICS, beside=0))
    near = evaluate(problem, effects(problem, "ogc"), LARGE, 0.05)
    for start in (near, _at(problem, near, noise)):
        beside, alone = (evaluate(problem, effects(problem, after), LARGE, start.noise, k) for k in (start, None))
        assert beside.log_posterior == pytest.approx(alone.log_posterior, abs=1e-6)
        assert beside.noise == pytest.approx(alone.noise, rel=1e-9)
        np.testing.assert_allclose(beside.mean, alone.mean, atol=1e-8)
        np.testing.assert_allclose(beside.cholesky, alone.cholesky, rtol=1e-7, atol=1e-8)


def _at(problem: Problem, hypothesis: Hypothesis, noise: float) -> Hypothesis:
    """The hypothesis held at a noise."""
    held = replace(problem, least_noise=noise)
    return evaluate(held, hypothesis.chosen, hypothesis.background, noise)


def test_where_most_of_it_changes_nothing_follows_from_a_known_hypothesis(
    setting: tuple[Problem, np.ndarray, np.ndarray],
) -> None:
    problem, *_ = setting
    near = evaluate(problem, (), PERFECT, 0.05)
    prior = prior_variances(problem, (), LARGE)
    columns = np.flatnonzero(prior)
    assert departure(near, columns, prior[columns]) is None


@pytest.mark.parametrize("after", ["og", "ogcl", "gc"])
def test_what_is_predicted_beside_a_known_hypothesis_is_what_a_factor_of_its_own_predicts(
    setting: tuple[Problem, np.ndarray, np.ndarray], after: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem, *_ = setting
    monkeypatch.setattr(evidence, "NUMERICS", replace(NUMERICS, beside=0))
    near = evaluate(problem, effects(problem, "ogc"), PERFECT, 0.05)
    monkeypatch.setattr(evidence, "NUMERICS", replace(NUMERICS, beside=0, noise_settled=np.inf))
    found = evaluate(problem, effects(problem, after), PERFECT, near.noise, near)
    assert found.near_mean is not None
    np.testing.assert_allclose(found.near_mean, found.mean, atol=1e-9 * np.abs(found.mean).max())
    p = len(problem.scale)
    np.testing.assert_array_equal(found.coefficients(p)[found.columns], found.near_mean)
