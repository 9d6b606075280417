"""How each joint's friction changes sides, sharply, late, behind a low-pass or over a wide speed, has no name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.signal import butter, lfilter

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.friction_turns import how_friction_turns, plain_rows
from armscope.motion.library.dry_friction import ChangeOfSides
from armscope.motion.library.sides import sharp_width
from armscope.motion.model.file import load_motion_model, save_motion_model
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.predicting import torque_table
from armscope.motion.samples.timing import stretches
from armscope.recordings.motions import Motions
from tests.motion.moving import COULOMB, Plant, carrying, clinging, moved, presliding, robot

WIDE, JOINT, RATE = 0.04, 1, 200.0


def wide(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 comes to its size over a speed four times the usual one."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = COULOMB[JOINT] * (np.tanh(dq[:, JOINT] / WIDE) - np.sign(dq[:, JOINT]))
    return extra


def falling(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 is half as high again near rest."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = 0.5 * COULOMB[JOINT] * np.exp(-((dq[:, JOINT] / 0.15) ** 2)) * np.sign(dq[:, JOINT])
    return extra


def bending(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 grows with the root of the speed besides."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = 3 * np.sqrt(np.abs(dq[:, JOINT])) * np.sign(dq[:, JOINT])
    return extra


def turning(motions: Motions) -> ChangeOfSides:
    arm, every = robot(), list(stretches(motions))
    how = chosen_cutoff(arm, every, None)[0]
    return how_friction_turns(plain_rows(arm, every, how), how)


def widths(plant: Plant | None) -> Array | None:
    return turning(moved(robot(), 3, plant)).wide(robot())


def filtered(motions: Motions, order: int, hz: float) -> Motions:
    """Torques behind one causal low-pass of all joints."""
    b, a = butter(order, hz, fs=RATE)
    effort: Array = motions.effort.copy()
    for run in motions.runs:
        there = np.flatnonzero(motions.run == run)
        first = effort[there[0]].copy()
        effort[there] = lfilter(b, a, effort[there] - first, axis=0) + first
    return replace(motions, effort=effort)


def lag_of_slow(order: int, hz: float) -> float:
    """By how many s such a low-pass makes what is slow late, as it is at that rate (bilinear, its cut-off kept)."""
    return {1: 1.0, 2: 2**0.5}[order] / (2 * RATE * float(np.tan(np.pi * hz / RATE)))


def test_a_wide_change_of_sides_is_seen_at_its_joint_alone() -> None:
    found = widths(wide)
    assert found is not None
    assert found[JOINT] == WIDE
    others = np.arange(3) != JOINT
    np.testing.assert_array_equal(found[others], sharp_width(robot())[others])


@pytest.mark.parametrize("plant", [None, falling, bending], ids=["none", "falling", "bending"])
def test_nothing_else_of_friction_over_speed_is_a_wide_change(plant: Plant | None) -> None:
    assert widths(plant) is None


def test_a_load_that_one_run_has_and_nobody_stated_changes_nothing_of_how_friction_turns() -> None:
    """It was the largest of all that is left, and any width that follows it a little was the best."""
    load = carrying(3, 25.0).effort - carrying(3, 0.0).effort
    for plant in (None, wide):
        motions = moved(robot(), 3, plant, runs=3)
        without, loaded = turning(motions), turning(replace(motions, effort=motions.effort + load))
        np.testing.assert_array_equal(loaded.width, without.width)
        np.testing.assert_allclose(loaded.late, without.late, atol=1e-3)


@pytest.mark.parametrize(("order", "hz"), [(2, 25.0), (1, 15.0)])
def test_a_low_pass_of_all_torques_is_told_by_how_friction_turns(order: int, hz: float) -> None:
    found = turning(filtered(moved(robot(), 3), order, hz))
    np.testing.assert_array_equal(found.order, order)
    np.testing.assert_allclose(found.late, lag_of_slow(order, hz), rtol=0.2)


@pytest.mark.parametrize("plant", [None, presliding, clinging], ids=["sharp", "presliding", "clinging"])
def test_friction_that_clings_at_each_joint_as_it_does_is_no_low_pass(plant: Plant | None) -> None:
    found = turning(moved(robot(), 4, plant))
    np.testing.assert_array_equal(found.order, 0)
    np.testing.assert_allclose(found.late, 0.0, atol=0.001)


def test_a_low_pass_over_friction_that_clings_is_not_made_up_from_it() -> None:
    """Two premises at once: no one filter is as good as what suits each joint, so none is told."""
    np.testing.assert_array_equal(turning(filtered(moved(robot(), 3, presliding), 2, 25.0)).order, 0)


@pytest.mark.long
def test_a_low_pass_over_one_joint_that_clings_is_still_one_delay() -> None:
    first, *others = diagnose_motion(robot(), filtered(moved(robot(), 3, clinging), 2, 25.0)).verdict.effects
    assert (first.effect, first.location) == ("torque_delay", "all joints")
    assert first.parameters[0].value == pytest.approx(lag_of_slow(2, 25.0), rel=0.1)
    assert [each.location for each in others if not each.minor] == ["joint 2"]
    assert all(each.nameless for each in others)


@pytest.mark.long
def test_how_friction_turns_behind_a_low_pass_is_in_the_model_file(tmp_path: Path) -> None:
    found = diagnose_motion(robot(), filtered(moved(robot(), 3), 2, 25.0))
    save_motion_model(tmp_path / "model.yaml", found.model)
    again = load_motion_model(tmp_path / "model.yaml")
    np.testing.assert_array_equal(again.order_of_sides, [2, 2, 2])
    blind = filtered(moved(robot(), 5, runs=1), 2, 25.0)
    told = [torque_table(model, blind)[0] for model in (found.model, again)]
    pd.testing.assert_frame_equal(told[0], told[1])
    inside, names = slice(200, -200), ["tau1_nm", "tau2_nm", "tau3_nm"]
    left = told[1][names].to_numpy()[inside] - blind.effort[inside]
    assert np.all(left.std(axis=0) < 0.05 * blind.effort.std(axis=0))


@pytest.mark.long
def test_a_wide_change_of_sides_has_no_name_and_is_in_the_model_file(tmp_path: Path) -> None:
    found = diagnose_motion(robot(), moved(robot(), 3, wide))
    assert found.verdict.answer == "nothing missing"
    assert not found.verdict.effects
    save_motion_model(tmp_path / "model.yaml", found.model)
    again = load_motion_model(tmp_path / "model.yaml")
    assert again.width_of_sides == pytest.approx([0.002, WIDE, 0.002])


def test_friction_that_falls_near_rest_keeps_its_name() -> None:
    found = diagnose_motion(robot(), moved(robot(), 3, falling)).verdict
    assert [(each.effect, each.location) for each in found.effects] == [("stribeck_friction", "joint 2")]
