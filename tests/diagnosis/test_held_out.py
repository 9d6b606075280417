"""Held-out errors against brute force, and where rows scatter or whole runs are held out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.held_out import split_rows
from armscope.diagnosis.selection import select
from armscope.fitting.linearisation import LinearisedTable, point_residuals
from armscope.fitting.registration import fit_frames
from armscope.inference.normal_equations import total
from armscope.measurement.noise import Noise
from armscope.physics.frames import free_frames

from ..physics.scenes import arm_named
from .planted import one_run, planted, recorded

VALIDATED = Settings(resamples=0)


def test_held_out_errors_are_those_of_models_fitted_without_the_rows() -> None:
    """Without effects the folds' models are base and tool alone: fitted fold by fold, they predict as well."""
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [4e-7]}, 100, 0.02, seed=3)
    verdict = diagnose(arm, table, VALIDATED)
    layout = split_rows(table, np.random.default_rng(VALIDATED.seed))
    fold = layout.fold[layout.of_row]
    errors = [
        point_residuals(fit_frames(arm, table.rows(fold != k)), table.rows(np.flatnonzero(fold == k))) for k in range(5)
    ]
    assert verdict.held_out.before_all_rows == pytest.approx(np.sqrt(np.mean(np.concatenate(errors) ** 2)), rel=0.02)
    assert verdict.held_out.folds == 5
    assert 0.018 < verdict.held_out.after < 0.0225
    first, last = verdict.waterfall[0], verdict.waterfall[1]
    per_fold = [np.sqrt(np.mean(e**2)) for e in errors]
    assert first.spread_mm == pytest.approx(np.std(per_fold, ddof=1), rel=0.1)
    assert last.held_out_mm < 0.0225
    assert 0 < last.spread_mm < 0.006


@pytest.mark.long
def test_bad_shots_stand_in_the_error_of_all_rows_only() -> None:
    arm, table = planted("four-axis", {("joint_offset", "joint 3"): [3e-4]}, 100, 0.02, seed=8)
    table.positions[[4, 50, 77]] += np.array([3e-3, -4e-3, 2e-3])
    held_out = diagnose(arm, table, VALIDATED).held_out
    assert held_out.after < 0.023
    assert held_out.after_all_rows == pytest.approx(np.sqrt(3 * (9 + 16 + 4) / 300), rel=0.1)


def test_sums_by_block_are_those_of_the_round_in_which_the_selection_rests() -> None:
    arm, table = planted("four-axis", {("joint_offset", "joint 3"): [3e-4]}, 60, 0.02, seed=8)
    table.positions[7] += 6e-5  # half a bad shot: what it weighs changes from round to round
    frames, blocks = free_frames(table, False), np.arange(60) % 6
    found = select(
        fit_frames(arm, table), LinearisedTable(table), Noise(0.0, 0.0, ""), frames, blocks, lambda text, share: None
    )
    assert len(found.blocks) == 6
    together = found.problem.with_equations(total(found.blocks)).equations
    np.testing.assert_allclose(together.G, found.problem.equations.G, atol=1e-9 * together.n)
    np.testing.assert_allclose(together.b, found.problem.equations.b, atol=1e-9 * together.n)


def test_runs_at_the_same_poses_are_held_out_by_pose() -> None:
    """Whoever learned what is wrong with a pose from two reflectors foretells the third, and no other pose."""
    arm = arm_named("four-axis")
    once = one_run(arm, 50, 16)
    own = replace(once.rows(np.arange(150) % 50), run=np.repeat(["1", "2", "3"], 50))
    assert split_rows(own, np.random.default_rng(0)).grouped_by == "configuration"
    angles = own.motor_angles + 1e-2 * np.random.default_rng(1).normal(size=own.motor_angles.shape)
    assert split_rows(replace(own, motor_angles=angles), np.random.default_rng(0)).grouped_by == "run"


def test_folds_within_runs_hold_a_part_of_each_and_part_no_configuration() -> None:
    """Of runs between which the base jumped, the error now was one without the jumps: 0.44 in place of 1.19 mm."""
    arm = arm_named("four-axis")
    table = replace(one_run(arm, 160, 16), run=np.repeat(["1", "2", "3", "4"], 40))
    whole = split_rows(table, np.random.default_rng(0))
    parts = whole.within_runs()
    assert (whole.grouped_by, parts.grouped_by) == ("run", "configuration")
    np.testing.assert_array_equal(parts.of_row, whole.of_row)
    for fold in np.unique(parts.fold):
        assert set(table.run[parts.fold[parts.of_row] == fold]) == {"1", "2", "3", "4"}
    assert parts.within_runs() is parts


@pytest.mark.long
def test_a_run_held_out_whole_gets_a_base_of_its_own() -> None:
    """The bases of the runs lie metres apart: only a base fitted to the held-out rows can meet them."""
    arm = arm_named("four-axis")
    table = replace(one_run(arm, 150, 16), run=np.repeat(["1", "2", "3"], 50))
    table = recorded(arm, table, {("joint_compliance", "joint 2"): [5e-7]}, 0.02, seed=17)
    table.positions[50:100] += [1.0, 2.0, -0.5]
    verdict = diagnose(arm, table, VALIDATED)
    assert verdict.held_out.grouped_by == "run"
    assert verdict.held_out.after < 0.0215
    assert verdict.held_out.before > 3 * verdict.held_out.after
