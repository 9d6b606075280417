"""Angles that were rounded when they were written down are no fault of the arm; poses in round numbers are no noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.verdict.diagnosis import Diagnosis
from tests.diagnosis.planted import one_run, planted, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.03
STEP_DEG = 0.1


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("four-axis")


def rounded(table: Recordings) -> Recordings:
    return replace(table, motor_angles=np.radians(np.round(np.degrees(table.motor_angles) / STEP_DEG) * STEP_DEG))


def said_of_rounding(verdict: Diagnosis) -> list[str]:
    return [notice.text for notice in verdict.notices if notice.kind == "rounded angles"]


@pytest.mark.long
def test_rounding_is_noise_of_known_size_and_no_scatter_of_a_joint(arm: Arm) -> None:
    _, table = planted("four-axis", {}, 150, NOISE_MM, seed=8)
    verdict = diagnose(arm, rounded(table), QUICK)
    assert verdict.answer == "nothing missing"
    (said,) = said_of_rounding(verdict)
    assert "steps of 0.1 degrees" in said
    assert verdict.noise_mm == pytest.approx(verdict.residual_after_mm, rel=0.15)
    assert verdict.noise_mm > 3 * NOISE_MM
    assert "rounded angles" in verdict.noise_source
    assert "record more digits" in verdict.headline


@pytest.mark.long
def test_poses_commanded_in_round_numbers_have_no_such_noise(arm: Arm) -> None:
    table = recorded(arm, rounded(one_run(arm, 150, 8)), {}, NOISE_MM, seed=8)
    verdict = diagnose(arm, table, QUICK)
    assert verdict.answer == "nothing missing"
    assert said_of_rounding(verdict) == []
    assert "digits" not in verdict.headline
    assert verdict.noise_mm == pytest.approx(NOISE_MM, rel=0.15)


@pytest.mark.long
def test_a_cause_is_named_behind_rounding_and_a_joint_that_scatters_beside_it(arm: Arm) -> None:
    _, table = planted("four-axis", {("joint_offset", "joint 3"): [3e-3]}, 150, NOISE_MM, seed=9)
    assert [(e.effect, e.location) for e in diagnose(arm, rounded(table), QUICK).effects] == [
        ("joint_offset", "joint 3")
    ]
    loose = one_run(arm, 150, 9)
    stands = loose.motor_angles.copy()
    stands[:, 1] += 4e-3 * np.random.default_rng(3).normal(size=150)
    measured = recorded(arm, replace(loose, motor_angles=stands), {}, NOISE_MM, seed=9)
    verdict = diagnose(arm, rounded(replace(measured, motor_angles=loose.motor_angles)), QUICK)
    assert [(e.effect, e.location) for e in verdict.effects] == [("unknown", "joint 2")]
    assert said_of_rounding(verdict)
