"""Frames as they are: anywhere in space, one per run, one tool per target."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.diagnosis.frames import fit_frames
from armscope.diagnosis.problem import residuals

from ..physics.scenes import arm_named, full_table
from .planted import one_run, recorded


def test_a_base_metres_away_is_found_from_nothing() -> None:
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 40, seed=2), {}, 0.0, seed=7, far=True)
    assert np.linalg.norm(table.positions.mean(axis=0)) > 3
    assert np.abs(residuals(fit_frames(arm, table), table)).max() < 1e-5


def test_every_run_has_its_base_and_every_target_its_tool() -> None:
    arm = arm_named("six-axis")
    table = recorded(arm, full_table(arm, 60, seed=2), {}, 0.0, seed=7)
    moved = table.positions.copy()
    moved[table.run == "2"] = moved[table.run == "2"] @ np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]]).T + 5.0
    table = replace(table, positions=moved)
    model = fit_frames(arm, table)
    assert np.abs(residuals(model, table)).max() < 1e-5
    assert len(model.bases) == 2
    assert len(model.tools) == 2


def test_a_few_wild_rows_do_not_drag_the_frames() -> None:
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 60, seed=2), {}, 0.01, seed=7)
    clean = residuals(fit_frames(arm, table), table)
    table.positions[5] += 0.02
    wild = residuals(fit_frames(arm, table), table)
    others = np.arange(60) != 5
    assert np.sqrt(np.mean(wild[others] ** 2)) < 1.3 * np.sqrt(np.mean(clean[others] ** 2))
