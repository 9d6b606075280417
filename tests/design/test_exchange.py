import itertools

import numpy as np
import pytest

from armscope.design.exchange import _Information, d_optimal, optimal
from armscope.design.indices import SOURCES, all_indices
from armscope.design.separation import separating


def determinant(jacobian, rows):
    stacked = jacobian[list(rows)].reshape(-1, jacobian.shape[2])
    return np.linalg.det(stacked.T @ stacked)


@pytest.fixture
def jacobian():
    return np.random.default_rng(4).normal(size=(40, 3, 5)) * np.array([1, 10, 0.1, 3, 1e3])


def test_no_single_swap_improves_the_choice(jacobian):
    rows = d_optimal(jacobian, 8, np.random.default_rng(0)).tolist()
    best = determinant(jacobian, rows)
    for leaving, entering in itertools.product(rows, set(range(40)) - set(rows)):
        swapped = [entering if row == leaving else row for row in rows]
        assert determinant(jacobian, swapped) <= best * (1 + 1e-5)


def test_it_finds_the_best_of_all_subsets(jacobian):
    few = jacobian[:13]
    best = max(determinant(few, rows) for rows in itertools.combinations(range(13), 4))
    assert determinant(few, d_optimal(few, 4, np.random.default_rng(0), starts=10)) == pytest.approx(best)


def test_more_starts_are_never_worse(jacobian):
    one, many = (determinant(jacobian, d_optimal(jacobian, 6, np.random.default_rng(1), n)) for n in (1, 6))
    assert many >= one * (1 - 1e-9)


def test_units_do_not_change_the_d_optimal_choice(jacobian):
    units = np.array([1e-3, 1, 50, 0.2, 7])
    first, second = (d_optimal(each, 8, np.random.default_rng(3)) for each in (jacobian, jacobian * units))
    assert np.array_equal(first, second)


@pytest.mark.parametrize("index", list(SOURCES))
def test_each_index_is_larger_for_its_own_choice_than_for_random_ones(jacobian, index):
    jacobian = jacobian / np.abs(jacobian).mean(axis=(0, 1))
    mine = all_indices(jacobian[optimal(index, jacobian, 8, np.random.default_rng(0))])[index]
    by_d = all_indices(jacobian[d_optimal(jacobian, 8, np.random.default_rng(0))])[index]
    rng = np.random.default_rng(1)
    random = [all_indices(jacobian[rng.choice(40, 8, replace=False)])[index] for _ in range(200)]
    assert mine >= by_d * (1 - 1e-12)
    assert mine > max(random)


def test_the_updated_inverse_stays_that_of_the_sum():
    """Poses that show new and known directions at once, from a weak start: the Panda's geometry broke it once."""
    poses = np.random.default_rng(0).normal(size=(3, 30, 20))
    weak = 1e-6 * np.eye(20)
    information, total = _Information.of(poses, weak), weak
    for row in range(30):
        information, total = information.changed(row, 1.0), total + poses[:, row].T @ poses[:, row]
        exact = np.linalg.inv(total)
        assert np.abs(information.inverse - exact).max() < 1e-7 * np.abs(exact).max()


def test_each_pose_is_taken_once_and_impossible_requests_are_refused(jacobian):
    assert len(set(d_optimal(jacobian, 20, np.random.default_rng(0)).tolist())) == 20
    assert np.array_equal(d_optimal(jacobian, 40, np.random.default_rng(0)), np.arange(40))
    with pytest.raises(ValueError, match="41 poses from 40"):
        d_optimal(jacobian, 41, np.random.default_rng(0))
    with pytest.raises(ValueError, match="1 poses for 5 parameters: a pose gives 3 numbers, 2 at least"):
        d_optimal(jacobian, 1, np.random.default_rng(0))


def test_separating_poses_count_what_the_rival_can_adapt_to():
    """Pose 0 differs most, but the rival can take that up with its free parameter; pose 1 it cannot."""
    jacobian = np.zeros((2, 3, 1))
    jacobian[0, 0, 0] = 1.0
    apart = np.array([[5.0, 0, 0], [1.0, 0, 0]])
    rows, separation = separating(jacobian, apart, np.array([[1e6]]), 0.1, 5)
    assert rows.tolist() == [1, 0]
    assert separation == pytest.approx([1.0, 5.0])
    stiff, _ = separating(jacobian, apart, np.array([[1e-12]]), 0.1, 2)
    assert stiff.tolist() == [0, 1]
