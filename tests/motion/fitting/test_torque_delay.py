"""A delay is told by the slope of the torque where friction pulls one way, not by the height of friction's steps."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.model_estimate import stated_model
from armscope.motion.fitting.rows import build_rows
from armscope.motion.fitting.torque_delay import Between, columns_of, lag_step
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import stretches
from tests.motion.moving import COULOMB, ROTOR, VISCOUS, carrying, moved, robot
from tests.motion.test_parts import seen

LATE_S, JOINT, RATE = 0.02, 2, 200.0


def late(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """All torque of joint 3, which is mostly friction, 20 ms late."""
    more = 4 * COULOMB[JOINT] * np.sign(dq[:, JOINT])
    torque = rigid[:, JOINT] + COULOMB[JOINT] * np.sign(dq[:, JOINT]) + VISCOUS[JOINT] * dq[:, JOINT]
    torque = torque + ROTOR[JOINT] * ddq[:, JOINT] + more
    time = np.arange(len(q)) / RATE
    extra = np.zeros_like(q)
    extra[:, JOINT] = np.interp(time - LATE_S, time, torque) - torque + more
    return extra


@pytest.fixture(scope="module")
def found() -> MotionDiagnosis:
    arm = robot()
    return diagnose_motion(arm, moved(arm, 3, late), MotionSettings(cutoff=10.0))


@pytest.mark.long
def test_a_joint_that_is_mostly_friction_is_as_late_as_it_was_made(found: MotionDiagnosis) -> None:
    (cause,) = (each for each in found.verdict.effects if each.effect == "torque_delay" and not each.minor)
    (delay,) = cause.parameters
    assert cause.location == "joint 3"
    assert delay.value == pytest.approx(LATE_S, abs=2e-3)
    low, high = delay.interval
    assert low < LATE_S < high
    numbers = found.verdict.background[JOINT].parameters
    assert {each.name: each.value for each in numbers}["inertia"] == pytest.approx(ROTOR[JOINT], abs=0.02)


def test_it_rests_where_the_slope_asks_for_no_more(found: MotionDiagnosis) -> None:
    selected = found.selected
    (number,) = (n for n in selected.best.candidates if selected.rows.layout.placed[n].cause.name == "torque_delay")
    step, unsure = lag_step(selected, number)
    assert abs(step) < unsure < 5e-3


def test_the_interval_owns_how_little_the_slope_tells(found: MotionDiagnosis) -> None:
    """The height of friction's steps alone would have it ten times as narrow."""
    (cause,) = (each for each in found.verdict.effects if each.effect == "torque_delay" and not each.minor)
    selected = found.selected
    (number,) = (n for n in selected.best.candidates if selected.rows.layout.placed[n].cause.name == "torque_delay")
    step, unsure = lag_step(selected, number)
    assert cause.parameters[0].stderr >= np.hypot(step, unsure)


def test_steps_that_overshoot_both_ways_come_to_rest() -> None:
    """Each leads as far beyond the root as it began before it: steps alone would go to and fro for ever."""
    root, names, now = 0.02, frozenset({1}), 0.012
    between = Between()
    for _ in range(4):
        now = between.next(names, 1, now, 2 * root - now)
    assert now == pytest.approx(root, abs=1e-4)


def test_steps_that_stay_between_are_taken_as_they_are() -> None:
    between, names = Between(), frozenset({1})
    assert between.next(names, 1, 0.01, 0.03) == 0.03
    assert between.next(names, 1, 0.03, 0.021) == 0.021
    assert between.next(names, 1, 0.021, 0.0205) == 0.0205


def test_other_names_ask_for_other_steps() -> None:
    between = Between()
    between.next(frozenset({1}), 1, 0.01, 0.03)
    between.next(frozenset({1}), 1, 0.03, 0.01)
    assert between.next(frozenset({1, 2}), 1, 0.02, 0.05) == 0.05


def test_the_columns_of_a_joint_are_what_its_rows_are_modelled_by() -> None:
    """Of a load that one run has, too: it was put into the others."""
    motions, arm = carrying(3, 2.0), robot()
    layout = TorqueLayout(arm, tuple(place_causes(seen(motions))), False)
    assert layout.differs_by_run
    rows = build_rows(layout, list(stretches(motions)), preparation(200.0, 10.0, "test"), stated_model(arm))
    coefficients = np.random.default_rng(1).normal(size=layout.width)
    for joint, modelled in enumerate(rows.modelled(coefficients).T):
        whole = columns_of(rows, joint, np.arange(layout.width)) @ coefficients
        np.testing.assert_allclose(whole, modelled, rtol=1e-4, atol=1e-4 * float(np.abs(modelled).max()))
