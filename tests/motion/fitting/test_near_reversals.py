"""A late torque and a soft drive are there far from reversals, too; friction that clings is not."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from armscope.motion.fitting.constants import SETTLED
from armscope.motion.fitting.near_reversals import AT_ALL_TIMES, settled_rows, told_by_reversals_alone
from armscope.motion.library import catalogue
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.recordings.motions import as_motions
from tests.motion.moving import behind_its_drive, moved, presliding, robot


@functools.cache
def clings() -> MotionDiagnosis:
    return diagnose_motion(robot(), moved(robot(), 3, presliding, noise=0.004))


def test_rows_near_a_reversal_are_not_settled() -> None:
    rows = clings().selected.rows
    settled = settled_rows(rows)
    assert 0.2 < settled.mean() < 0.9
    for samples in rows.samples:
        signals = samples.signals
        own = (rows.run == signals.run) & (rows.stretch == signals.stretch)
        for j in range(3):
            turned = np.flatnonzero(signals.dq[:-1, j] * signals.dq[1:, j] < 0)
            before, after = signals.time[turned], signals.time[turned + 1]
            for row in np.flatnonzero(own):
                if np.any((before < rows.time[row]) & (rows.time[row] < after)):
                    assert not settled[row, j]
            far = np.min(np.abs(rows.time[own][:, None] - before), axis=1) > 3 * SETTLED.seconds
            away = np.abs(rows.q[own, j][:, None] - signals.q[turned, j]).min(axis=1) > 0.02 * np.ptp(rows.q[:, j])
            assert settled[own, j][far & away].all()


def test_friction_that_clings_is_neither_late_torque_nor_a_soft_drive() -> None:
    found = clings()
    assert {effect.effect for effect in found.verdict.effects if not effect.minor} <= {"unknown"}
    chosen = [found.selected.rows.layout.placed[n].cause for n in found.selected.best.candidates]
    assert not set(chosen) & set(AT_ALL_TIMES)


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 2])
def test_a_soft_drive_is_told_where_no_joint_turns_back(seed: int) -> None:
    motions = as_motions(behind_its_drive(robot(), 1, 2e-4, seed, noise=0.005), "motions.csv", 3)
    selected = diagnose_motion(robot(), motions).selected
    names = {selected.rows.layout.placed[n].cause for n in selected.best.candidates}
    assert catalogue.COMPLIANCE in names
    assert not told_by_reversals_alone(selected)
