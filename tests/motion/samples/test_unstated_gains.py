"""Currents of motors whose torque per ampere nobody stated: what the stated masses ask for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.motion.check import refuse_unknown_gains
from armscope.motion.samples.gain_constants import GAINS
from armscope.motion.samples.unstated_gains import gains_asked_for, gains_in_words
from tests.motion.moving import moved, robot

STATED = np.array([12.0, 8.0, 5.0])


def test_joints_that_hold_weight_tell_their_gains() -> None:
    torques = moved(robot(), 4)
    currents = replace(torques, effort=torques.effort / STATED, kind="current")
    asked = gains_asked_for(robot(), currents)
    assert {1, 2} <= set(asked)
    for motor, gain in asked.items():
        assert gain == pytest.approx(STATED[motor], rel=0.05)
    with pytest.raises(InputError, match=r"ask for gains of .*\(motor 2\)"):
        refuse_unknown_gains(robot(), currents)


def test_friction_alone_asks_for_none() -> None:
    torques = moved(robot(), 4)
    noise = np.random.default_rng(1).normal(size=torques.effort.shape)
    assert gains_asked_for(robot(), replace(torques, effort=noise, kind="current")) == {}
    assert gains_in_words(robot(), replace(torques, effort=noise, kind="current")) == ""


@pytest.mark.parametrize(("explained", "told"), [(0.99, True), (0.5 * GAINS.told, False)])
def test_masses_that_explain_too_little_of_a_current_ask_for_nothing(explained: float, told: bool) -> None:
    torques = moved(robot(), 4)
    spread = torques.effort.std(axis=0) * np.sqrt((1 - explained) / explained)
    noisy = torques.effort + spread * np.random.default_rng(2).normal(size=torques.effort.shape)
    assert (2 in gains_asked_for(robot(), replace(torques, effort=noisy, kind="current"))) is told
