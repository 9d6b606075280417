"""A drift stands by itself or is no drift: what a wander takes back, nobody would measure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.model import FittedModel, predict
from armscope.recordings import Recordings
from armscope.robot import Arm
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, NOISE_MM = 150, 0.05
ALONG = np.linspace(0, 1, ROWS)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("four-axis")


def moving_base(arm: Arm, course: Array) -> Recordings:
    """(N,) how far the base stands off, m, in the order of rows; no time was recorded."""
    table = recorded(arm, one_run(arm, ROWS, 21), {}, NOISE_MM, 21)
    moved = table.positions + course[:, None] * [0.8, 0.0, 0.6]
    return replace(table, time=None, temperature=None, positions=moved)


def worst_later_mm(model: FittedModel, table: Recordings) -> float:
    """How far the model and the nominal arm in its place are apart in the next rows, mm."""
    later = replace(table, number=table.number + ROWS)
    nominal = replace(model, parts=(), background=())
    return 1e3 * float(np.abs(predict(model, later) - predict(nominal, later)).max())


@pytest.mark.long
@pytest.mark.parametrize("phase", [pytest.param(0.0, marks=pytest.mark.long), 0.7])
def test_a_base_that_goes_to_and_fro_is_no_drift_of_centimetres(arm: Arm, phase: float) -> None:
    table = moving_base(arm, 1.8e-4 * np.sin(6 * np.pi * ALONG + phase))
    verdict = diagnose(arm, table, QUICK)
    assert "base_drift" not in {effect.effect for effect in verdict.effects}
    assert verdict.background.present
    assert worst_later_mm(verdict.model, table) < 0.2


@pytest.mark.long
def test_a_base_that_drifts_is_told_beside_its_wander(arm: Arm) -> None:
    table = moving_base(arm, 1.5e-3 * ALONG + 5e-5 * np.sin(6 * np.pi * ALONG))
    verdict = diagnose(arm, table, QUICK)
    assert "base_drift" in {effect.effect for effect in verdict.effects}
