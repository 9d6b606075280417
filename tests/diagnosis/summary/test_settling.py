"""Poses that are said to settle a question do, when they are measured; where they can't, that is said instead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.diagnosis import Diagnosis, NextPoses
from tests.diagnosis.planted import joined, one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
TWIST, NOISE_MM, SEED = [0.0, 1e-3], 0.02, 1


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("six-axis")


def narrow(arm: Arm) -> Recordings:
    """Poses over a seventh of what the joints can do, and nothing recorded beside them."""
    table = one_run(arm, 60, SEED)
    middle = table.motor_angles.mean(axis=0)
    return bare(table, middle + 0.15 * (table.motor_angles - middle))


def bare(table: Recordings, angles: np.ndarray) -> Recordings:
    nothing = dict.fromkeys(("payload", "approach", "speed", "torque", "time", "temperature"))
    return replace(table, motor_angles=angles, **nothing)


def before_and_after(arm: Arm, link: int) -> tuple[NextPoses, Diagnosis]:
    """What is asked for of an arm whose link is twisted, and what is said once that has been measured."""
    planted = {("link_geometry", f"link {link}"): TWIST}
    first = recorded(arm, narrow(arm), planted, NOISE_MM, SEED)
    asked = diagnose(arm, first, QUICK).next_poses
    assert asked is not None
    times = int(asked.repeats_needed) if asked.settle else 1
    angles = np.tile(asked.motor_angles, (times, 1))
    more = recorded(arm, bare(one_run(arm, len(angles), 9), angles), planted, NOISE_MM, SEED + 1)
    return asked, diagnose(arm, joined(first, more), QUICK)


def test_poses_that_are_said_to_settle_it_do(arm: Arm) -> None:
    asked, after = before_and_after(arm, 4)
    assert asked.settle
    assert [(e.effect, e.location, e.named_as) for e in after.effects] == [("link_geometry", "link 4", "effect")]


def test_a_twist_and_a_wobble_that_are_one_motion_are_said_to_stay_alike(arm: Arm) -> None:
    """Lengths that may be zero were what was to tell them apart: "measuring each of them once would settle it"."""
    asked, after = before_and_after(arm, 3)
    assert (asked.first, asked.second) == ("link_geometry at link 3", "axis_wobble at joint 3 (per_turn 1)")
    assert not asked.settle
    (found,) = after.effects
    assert found.named_as != "effect"
