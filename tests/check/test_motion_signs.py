"""Signs are judged of torques and currents; the size of torques alone, as a current's is its gain's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.check.motion_channels import Channels
from armscope.check.motion_readings import Samples
from armscope.check.motion_signs import signs_and_sizes
from tests.motion.moving import robot


def told(of: Channels, factors: tuple[float, ...], up: bool = False) -> list[str]:
    arm, rng = robot(), np.random.default_rng(0)
    if up:
        arm = robot(gravity_m_s2=[0, 0, 9.81])
    q, dq, ddq = (rng.normal(size=(200, 3)) for _ in range(3))
    torque = arm.torques(q, dq, ddq, arm.inertial) * np.array(factors)
    return [each.text() for each in signs_and_sizes(Samples(q, dq, ddq, torque), arm, of)]


TORQUES = Channels(("tau1_nm", "tau2_nm", "tau3_nm"), (1.0, 1.0, 1.0))


def test_sign_and_size_of_torques_are_told_with_their_columns() -> None:
    assert told(TORQUES, (1, 1, 1)) == []
    sign, size = told(TORQUES, (1, -1, 40))
    assert sign.startswith("tau2_nm has the sign opposite to what moves the stated masses. Is it the load's torque?")
    assert size.startswith("tau3_nm is 40 times what the stated masses ask for.")
    assert told(TORQUES, (1, -1, 1), up=True)[0].count("does the arm hang from a ceiling?") == 1


def test_of_currents_the_sign_alone_is_judged() -> None:
    currents = replace(TORQUES, names=("current1_a", "current2_a", "current3_a"), currents=True)
    (sign,) = told(currents, (1, -1, 40))
    assert sign.startswith("current2_a has the sign opposite to what moves the stated masses. Turn its sign, or that")
