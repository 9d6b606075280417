"""Rows whose points belong elsewhere are told by what happened to them."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.report import check


def again(table, rows):
    """The table with the reading of the row before in some rows: the arm had not moved yet."""
    positions, orientation = table.positions.copy(), table.orientation.copy()
    positions[rows], orientation[rows] = table.positions[np.array(rows) - 1], table.orientation[np.array(rows) - 1]
    return replace(table, positions=positions, orientation=orientation)


@pytest.mark.parametrize(
    ("rows", "weight", "told"),
    [
        ([12], "hint", "1 row holds the point of the row before: a: 13."),
        ([5, 6, 40], "hint", "3 rows hold the points of the row before: a: 6, a: 7, a: 41."),
        (list(range(3, 63, 5)), "problem", "12 rows hold the points of the row before: a: 4, a: 9"),
    ],
)
def test_the_reading_of_the_row_before_is_told_as_that(rows, weight, told, arm, sound):
    found = [each for each in check(again(sound, rows), arm).suspicions if "row before" in each.text()]
    assert [each.weight for each in found] == [weight]
    assert found[0].text().startswith(told)
    assert not any("exchanged" in each.text() for each in check(again(sound, rows), arm).suspicions)


def test_what_is_wrong_with_a_row_in_another_way_is_no_reading_of_the_row_before(arm, sound):
    moved = sound.positions + np.where(np.arange(len(sound)) == 10, 0.12, 0)[:, None] * [0, 1, 0]
    assert "row before" not in " ".join(each.text() for each in check(replace(sound, positions=moved), arm).suspicions)


def test_the_first_row_of_a_run_has_none_before_it(arm, sound):
    run = np.where(np.arange(len(sound)) < 40, "a", "b")
    table = again(replace(sound, run=run), [40])
    assert "row before" not in " ".join(each.text() for each in check(table, arm).suspicions)


def test_neighbours_that_exchanged_their_points_are_told_as_that(arm, sound):
    order = np.arange(len(sound))
    order[[20, 21]] = [21, 20]
    table = replace(sound, positions=sound.positions[order], orientation=sound.orientation[order])
    told = " ".join(each.text() for each in check(table, arm).suspicions)
    assert "2 rows seem to have exchanged their points: a: 21, a: 22" in told
    assert "row before" not in told
