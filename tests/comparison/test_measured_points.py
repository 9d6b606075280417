"""A target that sits elsewhere on the flange is told with its distance, and is no cause of the arm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.comparison import compare
from armscope.comparison.measured_points import MeasuredPoint, told_of_points
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.robot import chain
from tests.comparison.test_changes import ARM, OWN, session
from tests.report.test_changes_page import FOUND, words_of

STEP_MM = np.array([3.0, -2.0, 5.0])


def with_target_at(table: Recordings, step_mm: Array) -> Recordings:
    """The same rows, seen without a turned base, of a point that sits elsewhere on the flange."""
    turned = chain(ARM, table.motor_angles + OWN)
    points = turned.tool + turned.tool_rotation @ (1e-3 * step_mm)
    noise = np.random.default_rng(len(table)).normal(0, 3e-5, points.shape)
    return replace(table, positions=points + noise)


def test_a_target_that_was_moved_is_told_with_an_interval_that_holds_its_distance() -> None:
    before, after = (with_target_at(session(seed), step) for seed, step in ((61, 0 * STEP_MM), (62, STEP_MM)))
    found = compare(ARM, {"before": before, "after": after})
    assert not found.changes
    first, second = found.points
    assert (first.recording, first.than, first.is_moved) == ("before", "", False)
    assert second.is_moved
    low, high = second.interval_95
    assert low < np.linalg.norm(STEP_MM) < high
    assert high - low < 0.2
    np.testing.assert_allclose(np.subtract(second.point_mm, first.point_mm), STEP_MM, atol=0.1)
    assert "Nothing of the arm changed" in found.headline
    assert not second.may_be_zero
    assert 'elsewhere on the flange in "after" than in "before": another target, or a bent tool' in found.headline
    assert found.to_json()["points"][1]["moved_mm"] == pytest.approx(second.moved_mm)


def test_a_point_that_moved_about_the_last_axis_may_be_that_joints_zero() -> None:
    """Base and tool take that zero up, so that no change is named; it is a cause of the arm all the same."""
    aside = np.array([80.0, -30.0, 50.0])
    before, slipped = (with_target_at(session(seed), aside) for seed in (65, 66))
    turned = chain(ARM, slipped.motor_angles + OWN + np.array([0, 0, 0, 0, 0, 0.02]))
    points = turned.tool + turned.tool_rotation @ (1e-3 * aside)
    noise = np.random.default_rng(66).normal(0, 3e-5, points.shape)
    found = compare(ARM, {"before": before, "after": replace(slipped, positions=points + noise)})
    assert not found.changes
    assert found.points[1].is_moved
    assert found.points[1].may_be_zero
    assert found.headline.startswith("No cause differs that these recordings show")
    assert found.headline.endswith("another target, a bent tool, or the zero of the last joint, which moves it so.")
    assert "no cause of the arm" not in found.headline


def test_a_target_that_sits_where_it_sat_is_not_told() -> None:
    found = compare(ARM, {"before": session(63), "after": session(64)})
    assert [each.is_moved for each in found.points] == [False, False]
    assert "flange" not in found.headline


def test_of_many_moves_the_first_are_told_and_the_others_counted() -> None:
    moved = [
        MeasuredPoint(f"r{n}", "", (0.0,) * 3, (0.1,) * 3, f"r{n - 1}", 6.17, (6.12, 6.22), is_moved=True)
        for n in range(1, 6)
    ]
    assert told_of_points(moved) == (
        'The measured point lies 6.17 mm (6.12 … 6.22) elsewhere on the flange in "r1" than in "r0", 6.17 mm '
        '(6.12 … 6.22) in "r2" than in "r1", 6.17 mm (6.12 … 6.22) in "r3" than in "r2" and 2 more: another target, '
        "or a bent tool. That is no cause of the arm."
    )
    assert told_of_points([]) == ""


def test_where_each_measured_point_sits_and_what_was_not_looked_at_stand_on_the_page(tmp_path: Path) -> None:
    points = (
        MeasuredPoint("before", "", (20.0, 10.0, 120.0), (0.1,) * 3),
        MeasuredPoint("after", "", (23.0, 8.0, 125.0), (0.1,) * 3, "before", 6.164, (6.12, 6.21), is_moved=True),
    )
    unchanged = replace(FOUND, changes=(), points=points, p_nothing_changed=1.0)
    assert "the measured point moved" in words_of(unchanged, tmp_path)
    assert "no change seen" in words_of(replace(unchanged, points=points[:1]), tmp_path)
    said = words_of(replace(FOUND, points=points, left_out="Left out: approach1 …."), tmp_path)
    assert "6.16 mm (6.12 … 6.21) elsewhere on the flange" in said
    assert "Where the measured point sits on the flange" in said
    assert "6.16 mm than in before" in said
    assert "Left out: approach1 …." in said
