"""A load that is there for some of a run: its torque is that of an arm with it, by another inverse dynamics."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.motion_changing_load import carrying
from benchmarks.motion_own_arms import arm_of, waves

from armscope.motion.library.causes import Moment
from armscope.motion.library.clauses_of_changes import spells
from armscope.motion.library.for_a_while import there
from armscope.motion.library.laws import Law
from armscope.motion.samples.preparation import Signals
from armscope.robot.bodies import Bodies
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm

MASS, PLACE = 2.3, np.array([0.05, -0.04, 0.08])
"""kg, and m in the last D-H frame."""


def test_it_comes_and_goes_at_its_moments() -> None:
    time = np.arange(6.0)
    assert there(time, 0.0, [2.0, 4.0]).tolist() == [0, 0, 1, 1, 0, 0]
    assert there(time, 1.0, [2.0, 4.0]).tolist() == [1, 1, 0, 0, 1, 1]
    assert there(time, 1.0, []).tolist() == [1] * 6


@pytest.mark.parametrize("n", [3, 6])
def test_a_loads_torque_is_what_an_arm_that_carries_it_asks_for(n: int) -> None:
    own = arm_of(n, np.random.default_rng(5))
    arm = build_moving_arm(RobotDescription.model_validate(own.robot(stated=True)))
    motion = tuple(each[::400] for each in waves(n, np.random.default_rng(6)))
    added = carrying(own, MASS, PLACE).torques(motion) - own.torques(motion)
    _, alpha, d = own.rows[-1]
    assert alpha == 0, "the place below holds for rows without a twist"
    at = PLACE + np.array([own.rows[-1][0], 0, d])  # the joint's frame stands before a and d of the row
    time = np.linspace(0, 16, len(added))
    signals = Signals("", 0, time, *motion, motion[0], None, None, np.arange(len(added)))
    moment = Moment(signals, motion[0], motion[0], 1.0, Bodies(arm, arm.inertial, None))
    values = MASS * np.r_[1.0, at]
    law = Law("load for a while", tuple(range(n)), (0.0, *values.tolist(), 15.0, 0.0, 4.0, 11.0))
    while_there = (time >= 4) & (time < 11)
    assert law(moment) @ values == pytest.approx(added * while_there[:, None], abs=1e-6 * np.abs(added).max())
    fewer = Law("load for a while", (0, n - 1), (0.0, *values.tolist(), 3.0, 0.0, 4.0, 11.0))
    assert fewer(moment) == pytest.approx(law(moment)[:, [0, n - 1], :2])


@pytest.mark.parametrize(
    ("moments", "unsure", "told"),
    [
        ([("from", 12.314)], 0.01, "from 12.31 s on"),
        ([("until", 3.2)], 0.3, "until 3.2 s (± 0.30 s)"),
        ([("from", 1.0), ("until", 2.0), ("from_2", 5.0)], 0.01, "from 1.00 s until 2.00 s and from 5.00 s on"),
        ([("until", 1.0), ("from", 2.0), ("until_2", 5.0)], 0.01, "until 1.00 s and from 2.00 s until 5.00 s"),
        (
            [(f"{word}{n}", float(n)) for n in range(5) for word in ("from_", "until_")],
            0.01,
            "from 0.00 s until 0.00 s, from 1.00 s until 1.00 s and 3 more times",
        ),
    ],
)
def test_when_is_said_by_the_runs_own_time(moments: list[tuple[str, float]], unsure: float, told: str) -> None:
    assert spells([*((name, "s", at) for name, at in moments), ("unsure", "s", unsure)]) == told
