"""Readings that stand alone are laid between their neighbours and told; blows, steps and turns are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.check.motions import check_moving
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.samples.spikes import SPIKES, without_spikes
from armscope.recordings.motions import Motions
from tests.motion.moving import moved, robot

SOUND = moved(robot(), 2, seconds=6.0)
AT = 700


def with_reading(column: str, joint: int, value: float, rows: slice = slice(AT, AT + 1)) -> Motions:
    """The sound motion with some readings of a channel replaced."""
    values = getattr(SOUND, column).copy()
    values[rows, joint] = value
    return replace(SOUND, **{column: values})


def test_a_sound_motion_is_left_as_it_is() -> None:
    assert without_spikes(SOUND) == (SOUND, [])


@pytest.mark.parametrize(("column", "name"), [("q", "q2_rad"), ("effort", "tau2_nm")])
@pytest.mark.parametrize("samples", [1, 3])
def test_a_lost_reading_is_told_by_row_and_laid_between_its_neighbours(column: str, name: str, samples: int) -> None:
    value = float(getattr(SOUND, column)[AT, 1]) + 900.0
    rows = slice(AT, AT + samples)
    found, (notice,) = without_spikes(with_reading(column, 1, value, rows))
    assert notice.kind == SPIKES
    assert f"{name} in line {AT + 2} ({value:.4g})" in notice.text
    between, own = getattr(found, column), getattr(SOUND, column)
    assert np.allclose(between[rows], own[rows], atol=0.2 * np.ptp(own[:, 1]))
    kept = np.ones(len(own), dtype=bool)
    kept[rows] = False
    assert np.array_equal(between[kept], own[kept])


@settings(max_examples=30, deadline=None)
@given(turns=st.sampled_from([-1, 1]), first=st.integers(20, 1100), samples=st.integers(1, 3))
def test_an_angle_within_one_turn_is_no_lost_reading(turns: int, first: int, samples: int) -> None:
    values = SOUND.q.copy()
    values[first : first + samples, 0] += turns * 2 * np.pi
    assert without_spikes(replace(SOUND, q=values))[1] == []


def test_a_step_and_a_blow_that_rings_on_are_the_motions_own() -> None:
    since = np.arange(len(SOUND)) - AT
    for on_top in (50.0 * (since >= 0), 300.0 * np.exp(-since / 20) * (since >= 0)):
        assert without_spikes(replace(SOUND, effort=SOUND.effort + on_top[:, None]))[1] == []


@pytest.mark.parametrize(("column", "value"), [("q", 1.5), pytest.param("effort", 5000.0, marks=pytest.mark.long)])
def test_one_lost_reading_changes_no_verdict(column: str, value: float) -> None:
    """It outweighed the motion: "met to 76 % instead of 76 %", and check said that nothing looks wrong."""
    how = MotionSettings(cutoff=10.0)
    table = with_reading(column, 1, value)
    verdict, sound = diagnose_motion(robot(), table, how).verdict, diagnose_motion(robot(), SOUND, how).verdict
    assert [each.effect for each in verdict.effects] == [each.effect for each in sound.effects]
    assert verdict.held_out.model < 1.1 * sound.held_out.model
    assert [each.kind for each in verdict.notices].count(SPIKES) == 1
    assert any(f"in line {AT + 2}" in each.text() for each in check_moving(table, robot()).suspicions)
