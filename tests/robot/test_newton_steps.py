"""Steps towards tool poses, against the pseudo-inverse and singular values by NumPy."""

import numpy as np
import pytest

from armscope.robot.newton_steps import damping, least_turns, shortened, smallest_singular_value


@pytest.fixture
def jacobian() -> np.ndarray:
    return np.random.default_rng(1).normal(size=(20, 3, 7))


def test_least_turns_are_the_pseudo_inverses(jacobian: np.ndarray) -> None:
    gap = np.random.default_rng(2).normal(size=(20, 3))
    turns = least_turns(jacobian, gap, np.zeros(20))
    expected = [np.linalg.pinv(one) @ missing for one, missing in zip(jacobian, gap, strict=True)]
    np.testing.assert_allclose(turns, expected, atol=1e-12)


def test_a_stretched_arm_makes_finite_steps_of_which_none_goes_where_the_tool_cannot(jacobian: np.ndarray) -> None:
    jacobian[:, 2] = 0.0  # the tool can't move along z
    turns = least_turns(jacobian, np.ones((20, 3)), damping(np.full(20, 0.1), 1e-14))
    assert np.isfinite(turns).all()
    moved = np.einsum("nkm,nm->nk", jacobian, turns)
    np.testing.assert_allclose(moved, np.tile([1.0, 1.0, 0.0], (20, 1)), atol=1e-6)


def test_damping_vanishes_with_the_gap_and_is_bounded_far_away() -> None:
    near, middle, far, farther = damping(np.array([0.0, 0.1, 1.0, 50.0]), 1e-14)
    assert near == 1e-14
    assert near < middle < far == farther


def test_shortened_steps_keep_their_direction_and_small_ones_their_size() -> None:
    step = np.array([[0.1, -0.2], [2.0, -4.0], [0.0, 0.0]])
    np.testing.assert_allclose(shortened(step, 0.5), [[0.1, -0.2], [0.25, -0.5], [0.0, 0.0]])


def test_the_smallest_singular_value_is_that_of_the_singular_value_decomposition(jacobian: np.ndarray) -> None:
    expected = np.linalg.svd(jacobian, compute_uv=False)[:, -1]
    np.testing.assert_allclose(smallest_singular_value(jacobian), expected, rtol=1e-9)
    assert smallest_singular_value(jacobian[:0]).shape == (0,)
