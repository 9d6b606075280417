"""What a value that can't be negative gains or pays, and what a hypothesis pays for its names."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm

from armscope.inference.prices import half_line_columns, half_line_gain, negative_log_prior
from armscope.inference.problem import Problem

from ..backgrounds import sizes
from .test_evidence import PERFECT, numbers, setting

__all__ = ["setting"]


def test_half_a_prior_is_twice_as_dense_and_costs_what_of_the_posterior_it_leaves_out() -> None:
    z_scores = np.array([-3.0, 0.0, 8.0])
    assert half_line_gain(z_scores) == pytest.approx(np.log(2 * norm.cdf(z_scores)).sum())
    assert half_line_gain(np.empty(0)) == 0.0


def test_a_name_pays_its_price_a_nested_one_nothing_and_a_background_that_of_its_family(
    setting: tuple[Problem, np.ndarray, np.ndarray],
) -> None:
    problem, *_ = setting
    none, background = np.empty(0), sizes(4, 2)
    (offset,) = numbers(problem, ("joint_offset", "joint 3"))
    (compliance,) = numbers(problem, ("joint_compliance", "joint 2"))
    assert half_line_columns(problem, (offset, compliance)) == [
        int(problem.space.candidates[compliance.candidate].columns[0])
    ]
    assert negative_log_prior(problem, (), PERFECT, none) == 0.0
    assert negative_log_prior(problem, (offset,), PERFECT, none) == pytest.approx(problem.cost(offset.candidate))
    family_costs = sum(cost for cost, size in zip(problem.family_costs, background, strict=True) if size)
    assert negative_log_prior(problem, (), background, none) == pytest.approx(family_costs)
