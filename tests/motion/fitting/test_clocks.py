"""One delay of all torques competes with one of each joint: it is told where one number says it, and only there."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from armscope.core.types import Array
from armscope.inference.search import Search
from armscope.motion.fitting.clocks import parted_where_they_differ, rivals_at_hand
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.recordings.motions import Motions
from tests.motion.moving import COULOMB, moved, robot

RATE = 200.0
LATE_S = 0.008
FILTER_HZ = 25.0


def read_by(reads: Callable[[Array, int], Array], seed: int = 3) -> Motions:
    """Every run's torques, joint by joint, as something reads them; the first moments of a run are held."""
    motions = moved(robot(), seed, seconds=10.0)
    effort: Array = motions.effort.copy()
    for run in motions.runs:
        there = np.flatnonzero(motions.run == run)
        for j in range(effort.shape[1]):
            effort[there, j] = reads(motions.effort[there, j], j)
    return replace(motions, effort=effort)


def later(torque: Array, by: float) -> Array:
    """A torque read later by some seconds."""
    time = np.arange(len(torque)) / RATE
    return np.interp(time - by, time, torque)


def filtered(torque: Array, _: int) -> Array:
    """A torque behind a causal low-pass of the second order, as an instrument has one."""
    b, a = butter(2, FILTER_HZ, fs=RATE)
    return np.asarray(lfilter(b, a, torque - torque[0]) + torque[0])


@pytest.fixture(scope="module")
def shifted() -> MotionDiagnosis:
    return diagnose_motion(robot(), read_by(lambda torque, _: later(torque, LATE_S)))


def test_torques_of_another_clock_are_one_cause(shifted: MotionDiagnosis) -> None:
    (cause,) = (each for each in shifted.verdict.effects if not each.minor)
    assert (cause.effect, cause.location) == ("torque_delay", "all joints")
    low, high = cause.parameters[0].interval
    assert low < LATE_S < high < 1.5 * LATE_S
    assert shifted.verdict.headline.startswith("The torque of all joints was recorded ")
    assert "one clock or one filter" in shifted.verdict.headline
    assert cause.cure.startswith("Shift the recorded torque of all joints ")
    assert "one time stamp" in cause.confirm


@pytest.mark.long
def test_torques_behind_one_low_pass_are_one_cause_as_late_as_it_makes_them() -> None:
    found = diagnose_motion(robot(), read_by(filtered)).verdict
    (cause,) = (each for each in found.effects if not each.minor)
    assert (cause.effect, cause.location) == ("torque_delay", "all joints")
    assert cause.parameters[0].value == pytest.approx(2**0.5 / (2 * np.pi * FILTER_HZ), rel=0.15)


@pytest.mark.long
def test_joints_that_differ_have_a_delay_each() -> None:
    late = (0.004, 0.012, 0.02)
    found = diagnose_motion(robot(), read_by(lambda torque, j: later(torque, late[j]))).verdict
    told = {each.location: each.parameters[0] for each in found.effects if each.effect == "torque_delay"}
    assert sorted(told) == ["joint 1", "joint 2", "joint 3"]
    for number, by in enumerate(late, start=1):
        low, high = told[f"joint {number}"].interval
        assert low < by < high


@pytest.mark.long
def test_one_late_joint_is_no_clock() -> None:
    found = diagnose_motion(robot(), read_by(lambda torque, j: later(torque, LATE_S) if j == 1 else torque)).verdict
    assert [each.location for each in found.effects if each.effect == "torque_delay"] == ["joint 2"]


def test_each_joints_own_delay_is_at_hand_where_that_of_all_is_chosen(shifted: MotionDiagnosis) -> None:
    selected = shifted.selected
    placed = selected.rows.layout.placed
    near = [(placed[n].joints, rival.columns.numbers[-1]) for n, rival, _ in rivals_at_hand(selected)]  # type: ignore[union-attr]
    assert {joints for joints, _ in near} == {(0,), (1,), (2,)}
    assert all(number == pytest.approx(LATE_S, abs=2e-3) for _, number in near)


def test_what_is_alike_is_not_parted(shifted: MotionDiagnosis) -> None:
    selected = shifted.selected
    best = parted_where_they_differ(Search.on(selected.problem), selected.best, selected.rows.layout.placed)
    assert best.candidates == selected.best.candidates


def test_friction_that_changes_sides_sooner_is_no_clock() -> None:
    """As an engine's friction does that is a constraint on speed and acceleration."""

    def sooner(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return COULOMB * (np.sign(dq + 0.004 * ddq) - np.sign(dq))

    selected = diagnose_motion(robot(), moved(robot(), 3, sooner, seconds=10.0)).selected
    layout = selected.rows.layout
    assert not [n for n in selected.best.candidates if layout.placed[n].cause.name == "torque_delay"]
    np.testing.assert_allclose(selected.told[layout.reversals[:, -1]] / selected.dry, -0.004, atol=2e-3)


@pytest.mark.long
def test_who_shifts_all_torques_as_the_card_says_has_no_delay_left(shifted: MotionDiagnosis) -> None:
    (cause,) = (each for each in shifted.verdict.effects if not each.minor)
    said = re.match(r"Shift the recorded torque of all joints ([0-9.]+) ± \S+ ms (earlier|later)", cause.cure)
    assert said is not None
    by = float(said[1]) * 1e-3 * {"earlier": -1, "later": 1}[said[2]]
    cured = diagnose_motion(robot(), read_by(lambda torque, _: later(later(torque, LATE_S), by))).verdict
    assert not [each for each in cured.effects if each.effect == "torque_delay" and not each.minor]
    assert cured.held_out.model < 1.2 * shifted.verdict.held_out.model
