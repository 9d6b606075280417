"""Rows whose points belong elsewhere are told by what happened to them."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.report import check
from armscope.robot import chain


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


TOOLS_M = np.array([[0.0, 0.0, 0.1], [0.03, -0.02, 0.12]])


def with_two_targets(arm, sound, wrong):
    """A table of two reflectors on the tool, in which some rows carry the other's name."""
    frames = chain(arm, sound.motor_angles)
    which = np.arange(len(sound)) % 2
    shift = np.einsum("nij,nj->ni", frames.tool_rotation, TOOLS_M[which] - arm.tool)
    points = frames.tool + shift + 3e-5 * np.random.default_rng(3).normal(size=shift.shape)
    label = which.copy()
    label[wrong] = 1 - label[wrong]
    return replace(sound, positions=points, orientation=None, target=np.array(["p1", "p2"])[label])


@pytest.mark.parametrize(("wrong", "weight"), [([7], "hint"), ([7, 20], "hint"), (list(range(3, 48, 5)), "problem")])
def test_rows_with_the_name_of_another_target_are_told_by_the_one_they_read_as(wrong, weight, arm, sound):
    """They were mistyped, or measured while the arm moved: 40.3 mm off, each by the way between two targets."""
    found = check(with_two_targets(arm, sound, wrong), arm).suspicions
    (told,) = [each for each in found if "reads as target" in each.text()]
    assert told.weight == weight
    for row in wrong[:10]:
        assert f"row a: {row + 1}: reads as target p{row % 2 + 1}" in told.text()
    assert "Correct the label" in told.text()
    assert not any("istyped" in each.text() or "exchanged" in each.text() for each in found)


def test_a_row_that_is_off_in_another_way_reads_as_no_other_target(arm, sound):
    table = with_two_targets(arm, sound, [])
    table.positions[7] += [0.0, 0.04, 0.0]
    told = " ".join(each.text() for each in check(table, arm).suspicions)
    assert "istyped" in told
    assert "reads as" not in told


def of_three_targets(arm, sound):
    """Forty poses at each of which three reflectors were measured under one id."""
    angles = np.repeat(sound.motor_angles[:40], 3, axis=0)
    which = np.arange(len(angles)) % 3
    frames = chain(arm, angles)
    tools = np.vstack([TOOLS_M, [-0.02, 0.04, 0.1]])
    points = frames.tool + np.einsum("nij,nj->ni", frames.tool_rotation, tools[which] - arm.tool)
    points += 3e-5 * np.random.default_rng(4).normal(size=points.shape)
    table = sound.rows(np.repeat(np.arange(40), 3))
    target, ids = np.array(["p1", "p2", "p3"])[which], np.repeat(np.arange(1, 41), 3).astype(str)
    return replace(table, positions=points, orientation=None, target=target, id=ids)


def test_targets_of_one_pose_that_changed_their_names_are_no_readings_of_the_row_before(arm, sound):
    table = of_three_targets(arm, sound)
    table.target[[22, 23]] = ["p3", "p2"]
    told = " ".join(each.text() for each in check(table, arm).suspicions)
    assert "row before" not in told
    assert "row a: 8 (p3): reads as target p2; row a: 8 (p2): reads as target p3" in told
    table = of_three_targets(arm, sound)
    table.target[[21, 22, 23]] = ["p2", "p3", "p1"]
    told = " ".join(each.text() for each in check(table, arm).suspicions)
    assert "row before" not in told
    assert "3 rows fit another target" in told


def test_of_several_targets_the_row_before_is_that_of_the_same_one(arm, sound):
    table = of_three_targets(arm, sound)
    table.positions[21:24] = table.positions[18:21]
    told = " ".join(each.text() for each in check(table, arm).suspicions)
    assert "3 rows hold the points of the row before: a: 8 (p1), a: 8 (p2), a: 8 (p3)" in told
