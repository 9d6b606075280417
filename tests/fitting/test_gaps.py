"""Gaps of joints beside a fit: as large as planted, beside everything, and once more where a part stands for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.fitting.gaps import gaps, is_play_by_approach, rows_of_unknown_side
from armscope.fitting.linearisation import residuals
from armscope.fitting.refit import Refit, refit
from armscope.fitting.registration import fit_frames
from armscope.measurement.channel import nuisances, supported
from armscope.measurement.row_weights import RowNoise
from armscope.physics.effect import Part, Placed
from armscope.physics.frames import sharing_bases
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..diagnosis.planted import planted

GAP = 6e-4


@pytest.fixture(scope="module")
def recorded() -> tuple[Arm, Recordings]:
    return planted("six-axis", {("backlash", "joint 2"): [GAP]}, 120, 0.02, 7)


def fitted(arm: Arm, table: Recordings, effects: list[tuple[Placed, float]]) -> Refit:
    start = fit_frames(arm, table, False)
    frames = sharing_bases(nuisances(supported(table), table, False), (("1",),))
    noise = RowNoise(np.ones(len(table)), np.ones(len(table)))
    return refit(start, table, frames, (), effects, noise, 0.01)


def play(arm: Arm, table: Recordings) -> Placed:
    return next(p for p in library(arm, table) if is_play_by_approach(p) and p.location == "joint 2")


def test_a_gap_beside_base_and_tool_is_as_large_as_planted_whatever_is_a_bad_shot(recorded) -> None:
    arm, table = recorded
    fit = fitted(arm, table, [])
    everyone = fit.weights.trusting(np.ones(len(table), dtype=bool))
    found = gaps(fit, table, everyone, float("nan"))
    assert abs(found[2].size - GAP) < 0.1 * GAP
    assert found[2].clearly > 10
    there = Part(play(arm, table), np.array([found[2].size]))
    scene = Scene(arm, table)
    moved = 1e3 * (scene.posture([there]).tool - scene.posture().tool)
    assert found[2].rms_mm == pytest.approx(np.sqrt(np.mean(moved**2)), rel=0.02), "by the exact model"
    assert max(gap.clearly for motor, gap in found.items() if motor != 2) < 4


def test_what_stands_for_it_can_be_taken_out(recorded) -> None:
    arm, table = recorded
    gear = next(p for p in library(arm, table) if p.key == ("gear_eccentricity", "joint 2"))
    fit = fitted(arm, table, [(gear, 1.0)])
    one, other = (gaps(fit, table, fit.weights, fit.noise, out)[2] for out in ((), fit.model.parts))
    assert one.size == pytest.approx(GAP, rel=0.05)
    assert other.size == pytest.approx(GAP, rel=0.05)
    assert other.stderr < one.stderr, "what else follows the angle leaves it more open"


def test_no_sides_no_gaps(recorded) -> None:
    arm, table = recorded
    fit = fitted(arm, table, [])
    assert gaps(fit, replace(table, approach=None), fit.weights, fit.noise) == {}
    assert residuals(fit.model, table).points_mm.shape == (len(table), 3)


def test_rows_whose_side_is_not_known_are_those_of_the_joints_with_play(recorded) -> None:
    arm, table = recorded
    sides = np.ones(table.motor_angles.shape)
    sides[3, 1], sides[5, 0] = np.nan, np.nan
    unknown = rows_of_unknown_side(replace(table, approach=sides), [play(arm, table)])
    assert np.flatnonzero(unknown).tolist() == [3]
