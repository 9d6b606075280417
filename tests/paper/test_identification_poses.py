import itertools

import numpy as np
import pytest

from armscope.paper.identification_poses import candidate_poses, choose_identification_poses, joint_ranges


def index_by_singular_values(jacobian, rows):
    """Borm & Menq's O1 as printed: from the singular values of the stacked Jacobian."""
    stacked = jacobian[list(rows)].reshape(-1, jacobian.shape[2])
    singular = np.linalg.svd(stacked, compute_uv=False)
    return np.prod(singular) ** (1 / len(singular)) / np.sqrt(len(rows))


@pytest.fixture
def jacobian():
    return np.random.default_rng(0).normal(size=(60, 3, 4))


def test_the_index_is_that_of_borm_and_menq(jacobian):
    choice = choose_identification_poses(jacobian, 10, np.random.default_rng(1))
    assert choice.index == pytest.approx(index_by_singular_values(jacobian, choice.rows))
    assert len(set(choice.rows.tolist())) == 10
    assert choice.n_parameters == 4


def test_the_choice_beats_every_random_one(jacobian):
    choice = choose_identification_poses(jacobian, 10, np.random.default_rng(1))
    rng = np.random.default_rng(2)
    best_of_many = max(index_by_singular_values(jacobian, rng.choice(60, 10, replace=False)) for _ in range(500))
    assert choice.index > best_of_many
    assert choice.random_index < choice.index


def test_the_choice_is_close_to_the_best_of_all_subsets(jacobian):
    few = jacobian[:12]
    best = max(index_by_singular_values(few, rows) for rows in itertools.combinations(range(12), 4))
    assert choose_identification_poses(few, 4, np.random.default_rng(0)).index > 0.97 * best


def test_what_no_candidate_shows_does_not_count(jacobian):
    twin = np.concatenate([jacobian, 2 * jacobian[:, :, :1], np.zeros((60, 3, 1))], axis=2)
    assert choose_identification_poses(twin, 10, np.random.default_rng(1)).n_parameters == 4


def test_candidates_fill_the_ranges_and_leave_held_motors_alone():
    poses = candidate_poses([-1, 2, 0.5], [1, 4, 0.5], 500, seed=3)
    assert np.all(poses[:, 2] == 0.5)
    for motor, (low, high) in enumerate([(-1, 1), (2, 4)]):
        counts, _ = np.histogram(poses[:, motor], bins=10, range=(low, high))
        assert counts.sum() == 500
        assert counts.min() >= 45  # evenly, where chance alone would give about 36 somewhere
    assert np.array_equal(poses, candidate_poses([-1, 2, 0.5], [1, 4, 0.5], 500, seed=3))


def test_ranges_are_widened_where_a_motor_moves():
    low, high = joint_ranges([[0.0, 1.0], [0.5, 1.0]], 0.1)
    assert low == pytest.approx([-0.1, 1.0])
    assert high == pytest.approx([0.6, 1.0])


def test_too_few_candidates_or_poses_are_refused(jacobian):
    with pytest.raises(ValueError, match="61 poses from 60 candidates"):
        choose_identification_poses(jacobian, 61, np.random.default_rng(0))
    with pytest.raises(ValueError, match="1 poses for 4 parameters"):
        choose_identification_poses(jacobian, 1, np.random.default_rng(0))
