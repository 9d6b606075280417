"""What is wrong with a table of motions is named before anything is fitted; a good one is not accused."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from armscope.check.motion_readings import Samples, explained, read_otherwise
from armscope.check.motions import check_moving, contents_of_motion, links_beside_motors
from armscope.check.suspicion import refuse_problems
from armscope.core.inputs import InputError
from armscope.motion.pipeline import diagnose_motion
from armscope.recordings.motions import Motions, as_motions
from tests.motion.moving import moved, robot, table


@pytest.fixture(scope="module")
def good() -> Motions:
    motions = moved(robot(), 5, seconds=8.0)
    speed = np.concatenate(
        [np.gradient(motions.q[motions.run == run], motions.time[motions.run == run], axis=0) for run in motions.runs]
    )
    return replace(motions, dq=speed)


def said(motions: Motions) -> str:
    return "; ".join(f"{each.weight} {each.statement}" for each in check_moving(motions, robot()).suspicions)


def test_a_good_table_is_not_accused_and_its_runs_are_listed(good: Motions) -> None:
    found = check_moving(good, robot())
    assert not found.suspicions
    assert not found.has_problems
    assert "run path 2: 1600 samples" in found.text()
    assert found.to_json()["problems"] is False


def test_what_a_sliding_joint_does_is_a_force(good: Motions) -> None:
    slides, turns, _ = list(contents_of_motion(replace(good, sliding=np.array([True, False, False]))))[-3:]
    assert re.search(r"q1: .* mm, force \S+ \.\.\. \S+ N$", slides)
    assert re.search(r"q2: .* deg, torque \S+ \.\.\. \S+ N m$", turns)


def test_a_late_speed_is_told_with_its_lag_and_degrees_with_their_factor(good: Motions) -> None:
    assert good.dq is not None
    late = replace(good, dq=np.roll(good.dq, 4, axis=0))
    assert "dq1 is 20 ms later than q1" in said(late)
    assert "dq2 is 57.3 times the derivative of q2" in said(replace(good, dq=np.degrees(good.dq)))
    assert "problem dq3 is -1 times" in said(replace(good, dq=good.dq * np.array([1, 1, -1])))


def test_a_torque_of_the_load_or_before_the_gear_is_a_problem(good: Motions) -> None:
    assert "problem tau2_nm has the sign opposite" in said(replace(good, effort=good.effort * np.array([1, -1, 1])))
    assert "problem tau2_nm is 0.00997 times" in said(replace(good, effort=good.effort * np.array([1, 0.01, 1])))


def test_one_wrist_that_carries_more_is_a_hint_and_all_joints_are_a_problem(good: Motions) -> None:
    assert "hint tau3_nm is" in said(replace(good, effort=good.effort * np.array([1, 1, 5.0])))
    assert "problem tau3_nm is" in said(replace(good, effort=5.0 * good.effort))


@pytest.mark.parametrize("what", ["joints", "positions", "torques"])
def test_another_order_of_the_joints_is_told_with_the_order_that_fits(good: Motions, what: str) -> None:
    q, effort = (each[:, ::-1] for each in (good.q, good.effort))
    mixed = replace(good, q=good.q if what == "torques" else q, effort=good.effort if what == "positions" else effort)
    words = said(replace(mixed, dq=None))
    assert f"{what} in the order 3 2 1" in words
    assert "problem masses explain" in words


def test_a_table_that_masses_explain_is_not_read_otherwise() -> None:
    arm, rng = robot(), np.random.default_rng(0)
    q, dq, ddq = (rng.normal(size=(200, 3)) for _ in range(3))
    torque = arm.torques(q, dq, ddq, arm.inertial)
    noisy = torque + 0.3 * torque.std(axis=0) * rng.normal(size=torque.shape)
    assert explained(Samples(q, dq, ddq, torque), arm) == pytest.approx(1.0)
    assert not list(read_otherwise(Samples(q, dq, ddq, noisy), arm))
    assert not list(read_otherwise(Samples(q, dq, ddq, rng.normal(size=torque.shape)), arm))


def test_degrees_in_a_column_of_radians_are_a_problem(good: Motions) -> None:
    words = said(replace(good, q=np.degrees(good.q), dq=None))
    assert "if positions are degrees" in words
    assert "problem q2_rad reaches" in words


def test_a_table_of_a_moment_is_looked_at_all_the_same(good: Motions) -> None:
    assert "tau" not in said(good.rows(slice(0, 60)))


def test_dead_and_saturated_channels_are_named(good: Motions) -> None:
    dead, cut = good.effort.copy(), good.effort.copy()
    dead[:, 2] = 0.5
    cut[:, 1] = np.clip(cut[:, 1], -20, 20)
    assert "problem tau3_nm is 0.5 in every row" in said(replace(good, effort=dead))
    dead[:, 2] = 0.0
    with np.errstate(all="raise"):
        assert "problem tau3_nm is 0 in every row" in said(replace(good, effort=dead))
    assert "hint tau2_nm stays at -20" in said(replace(good, effort=cut))
    for most in (20, 8):  # the less a channel shows, the longer it stays at that
        cut[:, 1] = np.clip(cut[:, 1], -most, most)
        assert "was not read" not in said(replace(good, effort=cut))


def test_samples_that_are_missing_are_told_with_their_place_and_what_is_left(good: Motions) -> None:
    there = (good.run != "path 2") | (good.time < 2.0) | (good.time >= 5.0)
    told = said(good.rows(there))
    assert "hint run path 2: samples are missing for 3 s from 1.995 s on. 4.99 s of motion are left" in told
    assert "missing" not in said(good)
    kinds = {notice.kind: notice.text for notice in diagnose_motion(robot(), good.rows(there)).verdict.notices}
    assert "3 s from 1.995 s on" in kinds["gap in time"]


def test_a_motion_that_is_too_short_is_told_in_the_words_of_the_diagnosis(good: Motions) -> None:
    short = good.rows((good.run == "path 1") & (good.time < 0.8))
    found = check_moving(short, robot())
    words = [each for each in found.suspicions if each.weight == "problem"]
    told = "no motion without gaps that is longer than 0.8 s"
    assert [each.statement.partition(":")[0] for each in words] == [told]
    with pytest.raises(InputError, match=told) as refused:
        diagnose_motion(robot(), short)
    assert words[0].statement == f"{refused.value.found}: {refused.value.rule}"
    with pytest.raises(InputError, match=r"From sample to sample it goes on by 0\.005\. Record ten seconds or more\.$"):
        refuse_problems(found.suspicions, "motions.csv")
    assert "longer than" not in said(good.rows(good.time < 2.5))


def test_a_run_that_repeats_another_is_no_test(good: Motions) -> None:
    half = good.rows(good.run == "path 1")
    rng = np.random.default_rng(1)
    again = good.rows(slice(None))
    twice = replace(again, q=np.vstack([half.q, half.q + 1e-4 * rng.normal(size=half.q.shape)]), dq=None)
    assert "run path 2 repeats the path of run path 1" in said(twice)


def test_milliseconds_and_far_angles_are_told(good: Motions) -> None:
    with pytest.raises(InputError, match="milliseconds"):
        check_moving(replace(good, time=good.time * 1e3))
    far = replace(good, q=good.q + np.array([0, 0, 200.0]))
    assert "q3_rad reaches" in said(far)


@pytest.mark.parametrize(
    ("factor", "words"),
    [(-1.0, "other way"), (180 / np.pi, "degrees"), (np.pi / 180, "radians"), (0.01, "own turns")],
)
def test_a_link_that_does_not_follow_its_motor_is_a_problem(factor: float, words: str) -> None:
    good = moved(robot(), 5, seconds=8.0)
    link = np.full(good.q.shape, np.nan)
    link[:, 1] = factor * good.q[:, 1]
    (found,) = links_beside_motors(replace(good, link=link))
    assert found.weight == "problem"
    assert words in found.cure
    assert check_moving(replace(good, link=link), robot()).has_problems


def test_a_link_that_winds_up_a_little_is_not_accused() -> None:
    good = moved(robot(), 5, seconds=8.0)
    assert not list(links_beside_motors(replace(good, link=1.001 * good.q + 0.2)))
    assert not list(links_beside_motors(good))


def test_links_of_other_joints_are_told_as_shifted() -> None:
    """They were asked to be the motor's own turns, by factors that nothing means."""
    good = moved(robot(), 5, seconds=8.0)
    shifted = np.column_stack([np.full(len(good.q), np.nan), good.q[:, :2] + 1e-4])
    found = list(links_beside_motors(replace(good, link=shifted)))
    assert [each.statement.split(",")[0] for each in found] == [
        "q2_link is the position of joint 1",
        "q3_link is the position of joint 2",
    ]
    assert [each.cure.split()[-1] for each in found] == ["q1_link.", "q2_link."]


def test_links_are_read_in_either_unit_joint_by_joint() -> None:
    rows = table(robot(), 5, seconds=2.0)
    rows["q2_link_deg"] = np.degrees(rows["q2_rad"]) + 1.0
    motions = as_motions(rows, "motions.csv", 3)
    assert motions.link is not None
    assert np.allclose(motions.link[:, 1], motions.q[:, 1] + np.radians(1.0))
    assert np.isnan(motions.link[:, [0, 2]]).all()
    assert not motions.notes
