"""What a model leaves is looked at by many, and worked out once."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.motion.fitting.selected import coefficients_of
from armscope.motion.pipeline import diagnose_motion
from tests.motion.moving import moved, robot


@pytest.mark.long
def test_what_is_left_is_measured_less_modelled_and_worked_out_once() -> None:
    selected = diagnose_motion(robot(), moved(robot(), 3, seconds=10.0)).selected
    rows = selected.rows
    modelled = rows.nominal + rows.modelled(coefficients_of(selected.problem, selected.best))
    assert np.array_equal(selected.residuals, rows.torque - modelled)
    assert selected.residuals is selected.residuals
