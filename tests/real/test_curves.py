"""A joint's curve is the same on two runs where both have been, whatever geometry imitates of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.real.curves import curve_table, shared, turned_by_curves
from armscope.real.transfer import GEOMETRY_HERE, WITH_CURVES, curves_transfer
from armscope.recordings import as_recordings
from tests.real.recorded import arm, table

NOISE_MM = 0.02


def ripple(angles, rng):
    """Joint 3 turns by a wave that no single gear makes, over its own angle; rad."""
    return np.column_stack([np.zeros((len(angles), 2)), wave(angles[:, 2]), np.zeros((len(angles), 3))])


def wave(angle):
    return 4e-4 * np.sin(9 * angle + 2 * np.sin(2 * angle))


@pytest.fixture(scope="module")
def learned():
    rows = as_recordings(table(400, NOISE_MM, error_rad=ripple), "made up", 6)
    return diagnose(arm(), rows, Settings(resamples=0, cross_validation=False))


@pytest.mark.long
def test_what_a_curve_turns_is_the_wave_that_was_planted(learned):
    rows = as_recordings(table(200, NOISE_MM, seed=1, error_rad=ripple), "made up", 6)
    turned = turned_by_curves(learned.model, rows).motor_angles - rows.motor_angles
    assert np.abs(np.delete(turned, 2, axis=1)).max() == 0
    # what is linear in the angle may stand in the geometry instead
    planted, found = (
        values - np.polyval(np.polyfit(rows.motor_angles[:, 2], values, 1), rows.motor_angles[:, 2])
        for values in (wave(rows.motor_angles[:, 2]), turned[:, 2])
    )
    assert np.std(found - planted) < 0.2 * np.std(planted)


def test_curves_learned_elsewhere_improve_a_run_with_its_own_geometry(learned):
    rows = as_recordings(table(200, NOISE_MM, seed=1, error_rad=ripple), "made up", 6)
    found = curves_transfer(arm(), learned, rows)
    assert found[WITH_CURVES] < 0.5 * found[GEOMETRY_HERE]


def test_an_arm_without_curves_has_nothing_to_carry_over(learned):
    rows = as_recordings(table(100, NOISE_MM), "made up", 6)
    assert turned_by_curves(replace(learned.model, parts=()), rows) is None
    assert curves_transfer(arm(), replace(learned, model=replace(learned.model, parts=())), rows) == {}


def test_a_curve_of_a_joint_that_the_other_run_does_not_turn_is_not_carried_over(learned):
    rows = as_recordings(table(100, NOISE_MM, seed=2), "made up", 6)
    rng = np.random.default_rng(3)
    held = rows.motor_angles.copy()
    held[:, 2] = 0.4 + rng.normal(0, 5e-4, len(rows))  # servo noise
    beyond = rows.motor_angles.copy()
    beyond[:, 2] = rng.uniform(4.0, 5.0, len(rows))  # moves, but where nothing was learned: the curve's end for all
    assert turned_by_curves(learned.model, rows) is not None
    for angles in (held, beyond):
        still = replace(rows, motor_angles=angles)
        assert turned_by_curves(learned.model, still) is None
        assert curves_transfer(arm(), learned, still) == {}


def test_curves_are_compared_only_where_both_runs_have_been(learned):
    one = curve_table({"one": learned})
    assert set(one["joint"]) == {"joint 3"}
    (same,) = shared(pd.concat([one, one.assign(run="two")]))
    assert same.correlation == pytest.approx(1.0)
    other = one.assign(run="two", turn_rad=np.random.default_rng(0).normal(size=len(one)))
    (unlike,) = shared(pd.concat([one, other]))
    assert abs(unlike.correlation) < 0.5
    assert shared(pd.concat([one, one.assign(run="two", angle_rad=one["angle_rad"] + 2.2)])) == []
