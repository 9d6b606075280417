"""Delays of all joints that agree are one: told once, in the headline, a notice and one step of the work order."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.motion.summary.one_clock import as_one, clock_together, of_one_clock, told_of_one_clock
from armscope.motion.verdict import FoundCause
from armscope.recordings.motions import Motions
from armscope.report.motion_subject import MotionSubject
from armscope.report.sections.motion_work import error_in_words, motion_work_order
from armscope.verdict.effects import Parameter
from tests.motion.moving import moved, robot

LATE_S = 0.02


def late(joint: int, by: float, error: float = 1e-3, share: float = 0.1) -> FoundCause:
    return FoundCause(
        effect="torque_delay",
        location=f"joint {joint}",
        family="drive",
        driver="torque",
        title=f"torque delay at joint {joint}",
        minor=share < 0.05,
        parameters=(Parameter("delay", "s", by, error),),
        rms=1.0,
        unit="N m",
        joint=f"joint {joint}",
        share=share,
        evidence_nats=50.0,
    )


OTHER = replace(late(2, 0.5, share=0.2), effect="torque_offset", title="torque offset at joint 2")
ALIKE = [OTHER, late(1, 0.0082), late(2, 0.0079, share=0.15), late(3, 0.008, share=0.02)]


def test_delays_of_all_joints_are_one_cause_with_the_share_of_all() -> None:
    in_order = clock_together(ALIKE, 3)
    assert [cause.effect for cause in in_order] == ["torque_delay"] * 3 + ["torque_offset"]
    one, other = as_one(in_order, 3)
    assert other is OTHER
    assert one.location == "all joints (one clock)"
    assert one.share == pytest.approx(0.27)
    assert not one.minor
    assert one.parameters[0].value == pytest.approx(0.00803, abs=1e-5)
    assert one.cure == "Shift the recorded torque of all joints 8.0 ± 2.0 ms earlier, or simulate that."
    (told,) = told_of_one_clock(ALIKE, 3)
    assert "recorded 8.0 ± 2.0 ms late at all 3 joints alike" in told.text


@pytest.mark.parametrize(
    ("causes", "moving"),
    [
        (ALIKE, 4),  # one joint is not late
        (ALIKE[:3], 2),  # two drives may be alike by chance
        ([late(1, 0.008), late(2, 0.008), late(3, 0.016)], 3),  # another delay
        ([late(1, 0.008), late(2, 0.008), late(3, 0.008, 0.02)], 3),  # a number that is not determined
    ],
)
def test_what_is_not_surely_one_clock_stays_as_it_is(causes: list[FoundCause], moving: int) -> None:
    assert of_one_clock(causes, moving) == []
    assert as_one(causes, moving) == causes
    assert clock_together(causes, moving) == sorted(causes, key=lambda cause: -cause.share)
    assert told_of_one_clock(causes, moving) == []


def recorded_late(seed: int) -> Motions:
    """All torques of every run by the same time too late."""
    motions = moved(robot(), seed, seconds=10.0)
    effort: Array = motions.effort.copy()
    for run in motions.runs:
        there = np.flatnonzero(motions.run == run)
        for j in range(3):
            time = motions.time[there]
            effort[there, j] = np.interp(time - LATE_S, time, motions.effort[there, j])
    return replace(motions, effort=effort)


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    return diagnose_motion(robot(), recorded_late(3))


def test_an_arm_whose_torque_has_another_clock_is_told_so_in_one_sentence(found: MotionDiagnosis) -> None:
    verdict = found.verdict
    assert [cause.effect for cause in verdict.effects[:3]] == ["torque_delay"] * 3
    assert verdict.headline.startswith("The torque of all joints (one clock) was recorded ")
    assert verdict.headline.count("too late") == 1
    assert "one clock" in {notice.kind for notice in verdict.notices}


def test_the_work_order_has_one_step_with_the_error_after_the_last_delay(found: MotionDiagnosis) -> None:
    told = motion_work_order(MotionSubject(copy.copy(found), "motions.csv"))
    assert "of all joints (one clock)" in told["tasks"][0].said
    assert not [task for task in (*told["tasks"][1:], *told["more"]) if "too late" in task.said]
    assert told["tasks"][0].expected == error_in_words(found.entered[4])
