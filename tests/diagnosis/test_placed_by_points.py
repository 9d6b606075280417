"""The error before anything is mended, of an arm placed as anybody would place it: by its points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.held_out import split_rows
from armscope.fitting.linearisation import point_residuals
from armscope.fitting.registration import fit_frames

from ..physics.scenes import arm_named
from .planted import one_run, recorded

VALIDATED = Settings(resamples=0)


@pytest.mark.long
def test_the_nominal_arm_is_placed_by_its_points_where_orientations_were_measured_too() -> None:
    """A zero that turns the tool by 20 mrad drags a base that orientations place, too, millimetres away."""
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 90, 3), {("joint_offset", "joint 5"): [2e-2]}, 0.02, 4, turn_noise_mrad=0.1)
    verdict = diagnose(arm, table, VALIDATED)
    points = replace(table, orientation=None)
    layout = split_rows(table, np.random.default_rng(VALIDATED.seed))
    fold = layout.fold[layout.of_row]
    errors = [
        point_residuals(fit_frames(arm, points.rows(fold != k)), points.rows(np.flatnonzero(fold == k)))
        for k in range(5)
    ]
    alone = np.sqrt(np.mean(np.concatenate(errors) ** 2))
    assert verdict.held_out.before_all_rows == pytest.approx(alone, rel=0.02)
    assert verdict.waterfall[0].held_out_mm == pytest.approx(alone, rel=0.02)
    assert verdict.waterfall[0].fitted_mm == pytest.approx(verdict.residual_before_mm, rel=0.02)
