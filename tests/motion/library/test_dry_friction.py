"""Dry friction some milliseconds ago: changes sides between samples where the motion did, and is rounded off there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.library.dry_friction import ChangeOfSides, DryFriction, own_columns, passed
from armscope.motion.samples.low_pass import without_lag
from armscope.motion.samples.preparation import Signals
from tests.motion.moving import robot

RATE, LATE_S, DRY, VISCOUS, HZ = 100.0, 0.0337, 5.0, 2.0, 10.0
ARM = robot()


def motion(rate: float) -> Signals:
    time = np.arange(int(8 * rate)) / rate
    q, dq, ddq = (np.column_stack([each] * 3) for each in (time * 0, np.sin(2 * time), 2 * np.cos(2 * time)))
    return Signals("", 0, time, q, dq, ddq, q[:0], None, None, np.arange(len(time)))


def dry_friction(late: float = 0.0) -> DryFriction:
    return DryFriction(np.full(3, DRY), ChangeOfSides.of(ARM, late))


def torque(signals: Signals) -> np.ndarray:
    return dry_friction().of_joint(signals, 0) + VISCOUS * signals.dq[:, 0]


def torques(signals: Signals) -> np.ndarray:
    return np.column_stack([torque(signals)] * 3)


def low(values: np.ndarray, rate: float, every: int = 1) -> np.ndarray:
    return without_lag(values, 15.0, rate, 200)[::every]


def test_friction_that_turns_late_is_that_of_a_hundred_times_finer_samples() -> None:
    coarse, fine = motion(RATE), motion(100 * RATE)
    dry = [dry_friction().of_joint(signals, 0) for signals in (coarse, fine)]
    true = low(np.interp(fine.time - LATE_S, fine.time, dry[1]), 100 * RATE, 100)
    found = low(dry_friction(LATE_S).of_joint(coarse, 0), RATE)
    inside = slice(50, -50)
    assert np.abs(found - true)[inside].max() < 0.02 * DRY
    # a straight line between samples is off by more than twice that, and more near reversals asks for a law
    straight = low(np.interp(coarse.time - LATE_S, coarse.time, dry[0]), RATE)
    assert np.abs(straight - true)[inside].max() > 0.04 * DRY


def test_a_torque_without_its_dry_friction_is_smooth() -> None:
    signals = motion(RATE)
    left = dry_friction().without(signals, torques(signals))
    assert left == pytest.approx(VISCOUS * signals.dq)


def test_what_is_rounded_off_of_a_late_torque_is_late() -> None:
    signals = motion(RATE)
    dry, both = dry_friction(), torques(signals)
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
    signals, sides, others = motion(RATE), [1, 4, 5, 6], [0, 2, 3]
    columns = own_columns(signals, ChangeOfSides.of(ARM, np.array([0.0, 3 / RATE, 0.0])))
    assert np.array_equal(columns[:, 0][:, others], columns[:, 1][:, others])
    later, now = columns[20:-20, 1][:, sides], columns[17:-23, 0][:, sides]
    assert later == pytest.approx(now, abs=1e-6 * np.abs(columns).max())


def test_friction_that_turns_later_than_its_speed_does() -> None:
    signals = motion(RATE)
    later, now = (ChangeOfSides.of(ARM, by).sides(signals)[:, 0] for by in (2 / RATE, 0.0))
    assert later[20:-20] == pytest.approx(now[18:-22], abs=1e-4)


def test_dry_friction_has_no_part_in_what_drives_round_off() -> None:
    signals, none = motion(RATE), np.zeros(3)
    dry = dry_friction(0.01)
    both = dry.torque * dry.turning.sides(signals) + VISCOUS * signals.dq
    smooth = DryFriction(none, ChangeOfSides.of(ARM)).rounded(signals, VISCOUS * signals.dq, none, HZ)
    assert dry.rounded(signals, both, none, HZ) == pytest.approx(smooth, abs=1e-6)


@pytest.mark.parametrize("order", [1, 2])
def test_what_passes_a_filter_rises_as_its_step_response_says(order: int) -> None:
    """First order: 1 - exp(-t / T); Butterworth's second: 1 - sqrt(2) exp(-w t / sqrt 2) sin(w t / sqrt 2 + pi / 4)."""
    rate, late = 20_000.0, 0.01
    time = np.arange(4000) / rate
    rises = {
        1: 1 - np.exp(-time / late),
        2: 1 - 2**0.5 * np.exp(-time / late) * np.sin(time / late + np.pi / 4),
    }
    step = np.ones(len(time))
    step[0] = 0.0
    np.testing.assert_allclose(passed(step, order, late, rate), rises[order], atol=0.005)
    ramp = passed(time, order, late, rate)
    np.testing.assert_allclose((time - ramp)[-100:], late, rtol=1e-5)


def test_friction_behind_a_filter_is_that_of_its_joint_alone_and_starts_at_rest() -> None:
    signals, late = motion(RATE), 2 / RATE
    sharp = ChangeOfSides.of(ARM).sides(signals)
    found = ChangeOfSides.of(ARM, late, order=np.array([0, 2, 1])).sides(signals)
    assert np.array_equal(found[:, 0], ChangeOfSides.of(ARM, late).sides(signals)[:, 0])
    for joint, order in ((1, 2), (2, 1)):
        np.testing.assert_array_equal(found[:, joint], passed(sharp[:, joint], order, late, RATE))
        assert found[0, joint] == pytest.approx(sharp[0, joint])


def test_a_filter_that_samples_do_not_show_is_a_shift() -> None:
    signals, late = motion(RATE), 0.2 / RATE
    found = ChangeOfSides.of(ARM, late, order=np.array([1, 2, 0])).sides(signals)
    assert np.array_equal(found, ChangeOfSides.of(ARM, late).sides(signals))
