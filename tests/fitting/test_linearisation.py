"""What a table remembers between passes is what would be computed anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.fitting.linearisation import LinearisedTable, residuals
from armscope.physics.effect import Part
from armscope.physics.model import FittedModel, predict
from tests.physics.scenes import arm_named, full_table
from tests.physics.test_model import model_with_everything


def test_what_a_model_leaves_is_computed_once_and_anew_for_another(monkeypatch: pytest.MonkeyPatch) -> None:
    model = model_with_everything("six-axis", 5)
    rows = full_table(arm_named("six-axis"), 40, 5)
    table = LinearisedTable(replace(rows, positions=predict(model, rows)))
    made, computed = FittedModel.posture, []
    monkeypatch.setattr(FittedModel, "posture", lambda self, scene: computed.append(self) or made(self, scene))
    first, *others = model.parts
    larger = replace(model, parts=(Part(first.placed, 2 * first.values), *others))
    left = residuals(model, table)
    assert residuals(replace(model), table) is left
    assert len(computed) == 1
    other = residuals(larger, table)
    assert len(computed) == 2
    np.testing.assert_array_equal(other.points_mm, residuals(larger, LinearisedTable(table.recordings)).points_mm)
    assert np.abs(other.points_mm).max() > 1e-3 > np.abs(left.points_mm).max()
