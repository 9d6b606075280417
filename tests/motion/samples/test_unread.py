"""Channels that nobody read: told, and left out of the fit; what stands, turns evenly or is coarse is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.check import check_motions
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.samples.unread import unread
from armscope.recordings.motions import Motions
from tests.motion.moving import moved, robot

TIME = np.arange(0, 6, 0.01)
RUN = np.full(len(TIME), "a")
NOISE = 0.01 * np.random.default_rng(4).normal(size=(len(TIME), 1))
HELD = (TIME > 2) & (TIME < 4)


def motions(run: np.ndarray, q: np.ndarray, effort: np.ndarray) -> Motions:
    return Motions(TIME, q[:, None], effort, "torque", np.array([False]), run)


def held(q: np.ndarray, effort: np.ndarray) -> np.ndarray:
    effort = effort.copy()
    effort[HELD] = effort[HELD][0]
    return unread(motions(RUN, q, effort))[:, 0]


def test_a_value_that_stays_while_a_joint_turns_back_was_not_read() -> None:
    assert np.array_equal(held(np.sin(3 * TIME), NOISE), HELD)


def test_joints_that_stand_or_turn_evenly_may_need_the_same_all_the_time() -> None:
    assert not held(np.zeros_like(TIME), NOISE).any()
    assert not held(0.4 * TIME, NOISE).any()


def test_a_coarse_channel_repeats_itself() -> None:
    assert not held(np.sin(3 * TIME), np.round(100 * NOISE) / 100).any()


def test_another_run_is_no_more_of_the_same() -> None:
    effort = NOISE.copy()
    effort[HELD] = 0.0
    run = np.where(TIME < 3, "a", "b")
    short = (TIME > 2.6) & (TIME < 3.4)
    effort[HELD & ~short] = NOISE[HELD & ~short]
    assert not unread(motions(run, np.sin(3 * TIME), effort)).any()


def test_rows_of_two_runs_that_alternate_hide_nothing() -> None:
    """A table sorted by time: no two rows of a run stood together, and nothing lasted."""
    effort = NOISE.copy()
    effort[HELD] = effort[HELD][0]
    one, q = np.arange(len(TIME)), np.sin(3 * TIME)
    both = motions(RUN, q, effort).rows(np.repeat(one, 2))
    found = unread(replace(both, run=np.tile(["a", "b"], len(TIME))))[:, 0]
    assert np.array_equal(found, np.repeat(HELD, 2))


@pytest.mark.long
def test_a_channel_that_fell_out_takes_nothing_else_along() -> None:
    motions = moved(robot(), 3, seconds=10.0)
    fell = motions.effort.copy()
    late = motions.time > np.quantile(motions.time, 0.7)
    fell[late, 1] = 0.0
    broken = replace(motions, effort=fell)
    (told,) = [notice.text for notice in check_motions(robot(), broken) if notice.kind == "not read"]
    assert "tau2_nm says 0 from row" in told
    found = diagnose_motion(robot(), broken)
    assert not [cause for cause in found.verdict.effects if not cause.minor]
    assert not [notice for notice in check_motions(robot(), motions) if notice.kind == "not read"]
