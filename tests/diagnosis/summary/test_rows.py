"""What a verdict holds of the rows: bad shots, what is left of each, and a model that holds for other rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.measurement.constants import WEIGHTS
from armscope.physics.model import predict
from armscope.physics.wander import is_of_rows
from armscope.verdict.diagnosis import Diagnosis
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.02
BAD = {"7": 0.8, "31": 2.0, "90": 1.2}
"""Bad shots: by their row's id, how far away they were taken, mm."""


@pytest.fixture(scope="module")
def verdict() -> Diagnosis:
    """A base that wanders in the order of the rows (no time is recorded), and three bad shots."""
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 120, 5), {}, NOISE_MM, 5)
    positions = table.positions.copy()
    positions[:, 0] += 2e-4 * np.sin(np.linspace(0, 1.5 * np.pi, 120))
    for row, far in BAD.items():
        positions[list(table.id).index(row), 2] += far * 1e-3
    return diagnose(arm, replace(table, time=None, temperature=None, positions=positions), QUICK)


def test_bad_shots_are_listed_by_their_ids_the_farthest_first(verdict: Diagnosis) -> None:
    assert [row.id for row in verdict.suspects] == ["31", "90", "7"]
    assert [row.residual_mm for row in verdict.suspects] == pytest.approx([2.0, 1.2, 0.8], abs=5 * NOISE_MM)
    assert all(row.weight < WEIGHTS.inlier_weight for row in verdict.suspects)


def test_what_remains_is_that_of_the_trusted_rows(verdict: Diagnosis) -> None:
    trusted = verdict.residuals.weight > WEIGHTS.inlier_weight
    assert verdict.residual_after_mm == pytest.approx(np.sqrt(np.mean(verdict.residuals.after[trusted] ** 2)))
    assert verdict.residual_after_mm < 1.5 * NOISE_MM
    assert verdict.rows == 120
    assert verdict.runs == ("1",)
    assert verdict.orientations is None


def test_the_model_to_predict_with_holds_nothing_of_the_order_of_these_rows(verdict: Diagnosis) -> None:
    assert verdict.background.present
    assert not any(is_of_rows(part.placed) for part in (*verdict.model.background, *verdict.model.parts))
    there = replace(verdict.recordings, number=verdict.recordings.number + 1000)
    np.testing.assert_allclose(predict(verdict.model, there), predict(verdict.model, verdict.recordings))
