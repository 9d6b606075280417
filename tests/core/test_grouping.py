"""Rows of one configuration are found and stay together."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from armscope.core.grouping import by_label, random_parts, same_configuration, visited_by_others
from armscope.core.sampling import spread_evenly


def test_angles_that_agree_to_a_tenth_of_a_milliradian_are_one_configuration() -> None:
    angles = np.array([[0.1, 0.2], [0.10002, 0.2], [0.1, 0.2003], [0.1, 0.2]])
    number = same_configuration(angles)
    assert number[0] == number[1] == number[3] != number[2]
    # two rounding cells, whatever the order of rows
    assert sorted(np.bincount(number)) == [1, 3]


def test_what_else_must_agree_parts_configurations() -> None:
    angles = np.zeros((4, 2))
    run, payload = np.array(["a", "a", "b", "b"]), np.array([1.0, np.nan, np.nan, np.nan])
    assert len(np.unique(same_configuration(angles, run))) == 2
    assert len(np.unique(same_configuration(angles, run, payload))) == 3
    number = same_configuration(angles, np.column_stack([payload, payload]))
    assert number[1] == number[2] == number[3] != number[0]


def test_names_stand_in_the_order_of_their_first_row() -> None:
    names, number = by_label(np.array(["z", "a", "z", "m"]))
    assert names == ("z", "a", "m")
    assert number.tolist() == [0, 1, 0, 2]


@given(st.lists(st.integers(0, 9), min_size=1, max_size=60), st.integers(1, 7), st.integers(0, 100))
def test_whole_groups_are_dealt_evenly(groups: list[int], count: int, seed: int) -> None:
    number = np.unique(groups, return_inverse=True)[1]
    parts = random_parts(number, count, np.random.default_rng(seed))
    of_group = [set(parts[number == g].tolist()) for g in range(number.max() + 1)]
    assert all(len(each) == 1 for each in of_group)
    dealt = np.bincount([each.pop() for each in of_group], minlength=count)
    assert dealt.max() - dealt.min() <= 1


@given(st.integers(1, 500), st.integers(1, 500))
def test_rows_spread_evenly_are_few_enough_and_hold_both_ends(count: int, most: int) -> None:
    rows = spread_evenly(count, most)
    assert len(rows) == min(count, most)
    assert rows[0] == 0
    assert rows[-1] == count - 1 or most == 1
    assert np.ptp(np.diff(rows)) <= 1 if len(rows) > 1 else True


def test_poses_that_another_run_visits_are_known_whatever_the_order() -> None:
    pose, run = np.array([0, 1, 0, 2, 0, 1]), np.array([0, 0, 1, 1, 0, 0])
    assert visited_by_others(pose, run).tolist() == [True, False, True, False, True, False]
    assert visited_by_others(pose[:0], run[:0]).tolist() == []
