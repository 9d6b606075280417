"""A channel that can't be its joint's is a problem with its joint and its cure, where masses alone don't show it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.motions import check_moving
from armscope.recordings.motions import Motions
from tests.motion.moving import COULOMB, VISCOUS, moved, robot


@pytest.fixture(scope="module")
def good() -> Motions:
    return moved(robot(), 5, seconds=8.0)


def problems(motions: Motions) -> list[tuple[str, str]]:
    return [(each.statement, each.cure) for each in check_moving(motions, robot()).suspicions]


def test_a_torque_against_its_friction_has_the_wrong_sign(good: Motions) -> None:
    """What masses ask of the first joint is too little, beside its cables, to show a sign."""
    pulled = moved(robot(), 5, lambda q, dq, ddq, rigid: 8 * np.sin(2 * q) * np.array([1, 0, 0]), seconds=8.0)
    assert problems(pulled) == []
    ((statement, cure),) = problems(replace(pulled, effort=pulled.effort * np.array([-1, 1, 1])))
    assert statement == "tau1_nm has the sign opposite to the motion: friction of joint 1 would drive it"
    assert cure.startswith("Turn its sign")


def test_a_channel_that_shows_noise_alone_is_not_connected(good: Motions) -> None:
    effort = good.effort.copy()
    effort[:, 1] = np.random.default_rng(2).normal(0, 0.02, len(effort))
    ((statement, cure),) = problems(replace(good, effort=effort))
    assert statement.startswith("tau2_nm shows noise alone: the stated masses ask for ")
    assert cure == "Is the channel of joint 2 connected?"


def test_nothing_is_said_of_joints_without_friction_or_of_a_good_table(good: Motions) -> None:
    assert problems(good) == []
    speed = np.concatenate(
        [np.gradient(good.q[good.run == run], good.time[good.run == run], axis=0) for run in good.runs]
    )
    behind_the_gear = good.effort - COULOMB * np.sign(speed) - VISCOUS * speed
    assert problems(replace(good, effort=behind_the_gear)) == []
