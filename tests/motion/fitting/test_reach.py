"""Which runs others can foretell: those that go where others go."""

import numpy as np

from armscope.motion.fitting.reach import within_reach

RUN, BLOCK = np.repeat(["a", "b", "c"], 200), np.repeat([0, 1, 2], 200)


def told(swings, speeds, run=RUN, moving=True):
    rng = np.random.default_rng(1)
    q = np.concatenate([swing * rng.uniform(-1, 1, (200, 2)) for swing in swings])
    dq = np.concatenate([speed * rng.uniform(-1, 1, (200, 2)) for speed in speeds])
    return within_reach(run, BLOCK, np.full(q.shape, moving), (q, dq)).tolist()


def test_runs_over_the_same_ground_at_the_same_speeds_foretell_each_other():
    assert told([1, 1, 1], [1, 1, 1]) == [0, 1, 2]


def test_a_run_that_is_much_faster_or_goes_much_farther_is_foretold_by_none():
    assert told([1, 1, 1], [1, 0.15, 0.15]) == [1, 2]
    assert told([1, 6, 1], [1, 1, 1]) == [0, 2]


def test_a_little_farther_is_near_enough():
    assert told([1, 1.5, 1], [1, 1, 1]) == [0, 1, 2]


def test_one_joint_that_goes_elsewhere_is_enough():
    rng = np.random.default_rng(2)
    q = rng.uniform(-1, 1, (600, 2))
    q[BLOCK == 2, 1] += 3  # none of it within reach
    assert within_reach(RUN, BLOCK, np.full(q.shape, True), (q,)).tolist() == [0, 1]


def test_what_stands_asks_for_nothing_and_parts_of_one_run_are_all_foretold():
    assert told([1, 3, 1], [1, 1, 1], moving=False) == [0, 1, 2]
    assert told([1, 3, 1], [1, 1, 1], run=np.full(600, "a")) == [0, 1, 2]


def test_where_no_run_is_within_reach_of_others_all_are_held_out():
    rng = np.random.default_rng(2)
    two = BLOCK < 2
    q = rng.uniform(-1, 1, (400, 1)) + 5 * BLOCK[two, None]
    assert within_reach(RUN[two], BLOCK[two], np.full(q.shape, True), (q,)).tolist() == [0, 1]
