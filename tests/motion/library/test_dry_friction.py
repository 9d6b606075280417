"""Dry friction some milliseconds ago: changes sides between samples where the motion did, and is rounded off there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.library.dry_friction import DryFriction, own_columns
from armscope.motion.samples.preparation import Signals, without_lag
from tests.motion.moving import robot

RATE, LATE_S, DRY, VISCOUS, HZ = 100.0, 0.0337, 5.0, 2.0, 10.0
ARM = robot()


def motion(rate: float) -> Signals:
    time = np.arange(int(8 * rate)) / rate
    q, dq, ddq = (np.column_stack([each] * 3) for each in (time * 0, np.sin(2 * time), 2 * np.cos(2 * time)))
    return Signals("", 0, time, q, dq, ddq, q[:0], None, None, np.arange(len(time)))


def torque(signals: Signals) -> np.ndarray:
    return DRY * DryFriction.of(ARM, np.full(3, DRY)).side(signals, 0) + VISCOUS * signals.dq[:, 0]


def torques(signals: Signals) -> np.ndarray:
    return np.column_stack([torque(signals)] * 3)


def low(values: np.ndarray, rate: float, every: int = 1) -> np.ndarray:
    return without_lag(values, 15.0, rate, 200)[::every]


def test_friction_that_turns_late_is_that_of_a_hundred_times_finer_samples() -> None:
    coarse, fine = motion(RATE), motion(100 * RATE)
    sides = [DryFriction.of(ARM, np.full(3, DRY)).side(signals, 0) for signals in (coarse, fine)]
    true = low(np.interp(fine.time - LATE_S, fine.time, DRY * sides[1]), 100 * RATE, 100)
    found = low(DRY * DryFriction.of(ARM, np.full(3, DRY), LATE_S).side(coarse, 0), RATE)
    inside = slice(50, -50)
    assert np.abs(found - true)[inside].max() < 0.02 * DRY
    # a straight line between samples is off by more than twice that, and more near reversals asks for a law
    straight = low(np.interp(coarse.time - LATE_S, coarse.time, DRY * sides[0]), RATE)
    assert np.abs(straight - true)[inside].max() > 0.04 * DRY


def test_a_torque_without_its_dry_friction_is_smooth() -> None:
    signals = motion(RATE)
    left = DryFriction.of(ARM, np.full(3, DRY)).without(signals, torques(signals))
    assert left == pytest.approx(VISCOUS * signals.dq)


def test_what_is_rounded_off_of_a_late_torque_is_late() -> None:
    signals = motion(RATE)
    dry, both = DryFriction.of(ARM, np.full(3, DRY)), torques(signals)
    late = 5 / RATE
    rounded = dry.rounded(signals, both, np.array([0.0, late, 0.0]), HZ)
    assert rounded[20:-20, 1] == pytest.approx(rounded[15:-25, 0], abs=0.02 * np.abs(rounded).max())
    assert np.array_equal(rounded[:, 0], rounded[:, 2])


def test_a_motion_of_some_time_ago_is_its_own_whatever_was_asked_of_another() -> None:
    signals, inside = motion(RATE), slice(20, -20)
    signals.some_time_ago(0, LATE_S)
    faster = replace(signals, dq=2 * signals.dq, ddq=2 * signals.ddq)
    speed, acceleration = faster.some_time_ago(0, LATE_S)
    before = signals.time - LATE_S
    np.testing.assert_allclose(speed[inside], 2 * np.sin(2 * before)[inside], atol=1e-5)
    np.testing.assert_allclose(acceleration[inside], 4 * np.cos(2 * before)[inside], atol=1e-5)


def test_all_that_changes_sides_with_friction_is_later_where_it_turns_later_and_nothing_else() -> None:
    signals, sides, others = motion(RATE), [1, 4, 5], [0, 2, 3]
    columns = own_columns(ARM, signals, np.array([0.0, 3 / RATE, 0.0]))
    assert np.array_equal(columns[:, 0][:, others], columns[:, 1][:, others])
    later, now = columns[20:-20, 1][:, sides], columns[17:-23, 0][:, sides]
    assert later == pytest.approx(now, abs=1e-5 * np.abs(columns).max())


def test_friction_that_turns_later_than_its_speed_does() -> None:
    signals = motion(RATE)
    later, now = (DryFriction.of(ARM, np.ones(3), by).side(signals, 0) for by in (2 / RATE, 0.0))
    assert later[20:-20] == pytest.approx(now[18:-22], abs=1e-4)


def test_dry_friction_has_no_part_in_what_drives_round_off() -> None:
    signals, none = motion(RATE), np.zeros(3)
    dry = DryFriction.of(ARM, np.full(3, DRY), 0.01)
    both = DRY * np.column_stack([dry.side(signals, joint) for joint in range(3)]) + VISCOUS * signals.dq
    smooth = DryFriction.of(ARM, none).rounded(signals, VISCOUS * signals.dq, none, HZ)
    assert dry.rounded(signals, both, none, HZ) == pytest.approx(smooth, abs=1e-6)
