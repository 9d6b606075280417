"""Angles recorded within one turn are counted on, and nothing else is touched."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope.check.motions import check_moving
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.predicting import torque_table
from armscope.motion.samples.turns import counted_on, laid_about, leaps
from armscope.recordings.motions import Motions, as_motions
from tests.motion.moving import moved, robot, table
from tests.seeds import seeds

JOINT = 2


@pytest.fixture(scope="module")
def whole() -> pd.DataFrame:
    """A table whose third joint goes more than half a turn to one side."""
    motion = table(robot(), 7, seconds=10.0)
    return motion.assign(q3_rad=motion["q3_rad"] + 2.5)


def within(angle: np.ndarray, least: float = -np.pi) -> np.ndarray:
    """The same angle as an encoder of one turn says it."""
    return (angle - least) % (2 * np.pi) + least


def read(motion: pd.DataFrame) -> Motions:
    return as_motions(motion, "motions.csv", 3)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
@pytest.mark.parametrize("least", [-np.pi, 0.0])
def test_the_whole_angle_comes_back_but_for_turns_that_no_run_tells(seed: int, least: float) -> None:
    rng = np.random.default_rng(seed)
    motion = table(robot(), seed, seconds=6.0)
    motion["q3_rad"] = 1.5 * motion["q3_rad"] + least + rng.choice([-0.2, 2 * np.pi + 0.2])
    wrapped = read(motion.assign(q3_rad=within(motion["q3_rad"].to_numpy(), least)))
    assert np.abs(np.diff(wrapped.q[:, JOINT])).max() > 6
    found, told = counted_on(wrapped)
    for run in found.runs:
        turns = (found.q - read(motion).q)[found.run == run, JOINT] / (2 * np.pi)
        assert np.ptp(turns) < 1e-9
        assert turns[0] == pytest.approx(round(turns[0]))
    assert [notice.kind for notice in told] == ["within one turn"]
    assert np.array_equal(found.q[:, :JOINT], wrapped.q[:, :JOINT])


def test_joint_first_row_and_number_of_jumps_are_told(whole: pd.DataFrame) -> None:
    wrapped = read(whole.assign(q3_rad=within(whole["q3_rad"].to_numpy())))
    same_run = wrapped.run[1:] == wrapped.run[:-1]
    jumps = np.flatnonzero((np.abs(np.diff(wrapped.q[:, JOINT])) > 6) & same_run)
    text = counted_on(wrapped)[1][0].text
    assert f"q3 jumps by a whole turn {len(jumps)} times, first in line {jumps[0] + 3}" in text


@pytest.mark.long
def test_check_says_no_more_than_that_and_diagnose_the_same_as_of_the_whole_angle(whole: pd.DataFrame) -> None:
    wrapped = read(whole.assign(q3_rad=within(whole["q3_rad"].to_numpy())))
    told = check_moving(wrapped, robot()).suspicions
    assert [each.weight for each in told] == ["hint"]
    assert "Recorded within one turn: q3" in told[0].statement
    one, other = (diagnose_motion(robot(), each) for each in (read(whole), wrapped))
    assert one.verdict.effects == other.verdict.effects
    assert one.verdict.held_out.model == pytest.approx(other.verdict.held_out.model, rel=1e-6)
    assert "within one turn" in {notice.kind for notice in other.verdict.notices}
    forces, notes = torque_table(other.model, wrapped)
    assert np.allclose(forces["tau3_nm"], torque_table(one.model, read(whole))[0]["tau3_nm"], atol=0.01)
    assert any("Recorded within one turn" in note for note in notes)


def test_links_stay_beside_their_motors(whole: pd.DataFrame) -> None:
    angle = within(whole["q3_rad"].to_numpy())
    wrapped = replace(read(whole.assign(q3_rad=angle)), link=np.full((len(angle), 3), np.nan))
    assert wrapped.link is not None
    wrapped.link[:, JOINT] = within(whole["q3_rad"].to_numpy() - 0.01)
    found = counted_on(wrapped)[0]
    assert found.link is not None
    assert np.allclose(found.link[:, JOINT] - found.q[:, JOINT], -0.01)


def test_a_good_table_degrees_called_radians_and_a_joint_that_slides_are_left(whole: pd.DataFrame) -> None:
    good = read(whole)
    assert counted_on(good)[0] is good
    degrees = read(whole.iloc[::10].assign(q3_rad=np.degrees(whole["q3_rad"].iloc[::10])))
    assert np.abs(np.diff(degrees.q[:, JOINT])).max() > 6
    assert counted_on(degrees)[0] is degrees
    assert not leaps(degrees)
    slides = replace(good, sliding=np.ones(3, dtype=np.bool_), q=7 * good.q.round(0))
    assert counted_on(slides)[0] is slides


def test_an_angle_that_was_filtered_across_its_jumps_is_a_problem_and_no_wrong_sign(whole: pd.DataFrame) -> None:
    angle = within(whole["q3_rad"].to_numpy())
    filtered = read(whole.assign(q3_rad=np.r_[angle[0], (angle[1:] + angle[:-1]) / 2]))
    told = check_moving(filtered, robot()).suspicions
    first = int(np.flatnonzero(np.abs(np.diff(filtered.q[:, JOINT])) > 1)[0])
    problems = [each.statement for each in told if each.weight == "problem"]
    assert len(problems) == 1
    assert re.match(rf"q3 leaps by -?1[78]\d deg from line {first + 2} to line {first + 3}: ", problems[0])


def test_a_step_across_a_gap_in_time_is_no_jump() -> None:
    motions = moved(robot(), 3, seconds=6.0)
    later = np.flatnonzero(motions.run == "path 1")[600:]
    time, q = motions.time.copy(), motions.q.copy()
    time[later] += 3.0
    q[later, JOINT] += 5.5
    parted = replace(motions, time=time, q=q)
    assert counted_on(parted)[0] is parted
    assert not leaps(parted)


def test_other_motion_is_laid_in_the_turn_in_which_the_model_knows_the_joint(whole: pd.DataFrame) -> None:
    """A spring that was fitted where angles were counted on pulled by 6.3 rad too much where nothing jumped."""
    known = np.array([[-1.0, 1.0], [-3.0, 3.0], [-5.0, -1.0]])
    motions = read(whole.assign(q3_rad=2.5 + 0.3 * np.sin(whole["time_s"]), q1_rad=0.5))
    found, told = laid_about(motions, known)
    np.testing.assert_allclose(found.q[:, JOINT], motions.q[:, JOINT] - 2 * np.pi)
    np.testing.assert_array_equal(found.q[:, :JOINT], motions.q[:, :JOINT])
    assert "q3 of run path 1 by -1, q3 of run path 2 by -1" in told[0].text


def test_motion_that_the_model_knows_stays_where_it_is(whole: pd.DataFrame) -> None:
    """A joint of two turns, of which this motion has the first: its middle is a turn away, and right."""
    motions = read(whole.assign(q3_rad=0.2 * np.sin(whole["time_s"])))
    assert laid_about(motions, np.array([[-9.0, 9.0], [-9.0, 9.0], [-0.5, 13.0]])) == (motions, [])
    assert laid_about(motions, None) == (motions, [])
