"""A joint that never moves is one for the check, the effects and the report alike."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.check.report import check
from armscope.diagnosis import Settings, diagnose
from armscope.physics.placing import moving_joints
from armscope.recordings.constants import READING
from armscope.recordings.motion import moving, sides_of_last_moves
from armscope.report.sections.assumptions import assumptions

from ..diagnosis.planted import planted


def test_a_joint_of_half_a_hundredth_never_moves_whoever_is_asked() -> None:
    arm, table = planted("six-axis", {}, 60, 0.03, seed=60)
    table.motor_angles[:, 4] = np.linspace(0.3, 0.3 + READING.still_rad / 2, 60)
    assert moving(table.motor_angles).tolist() == [True] * 4 + [False, True]
    assert moving_joints(table) == [1, 2, 3, 4, 6]
    assert [motor.moved for motor in check(table).contents.motors] == [True] * 4 + [False, True]
    verdict = diagnose(arm, table, Settings(resamples=0, cross_validation=False))
    (told,) = (notice.text for notice in verdict.notices if notice.kind == "joints that never move")
    assert told.startswith("joint 5:")
    assert any("joint 5" in text and "Never moved" in text for text in assumptions(verdict, arm, table))


def test_a_side_is_kept_until_a_motor_moves_again_in_the_same_run() -> None:
    _, table = planted("six-axis", {}, 60, 0.03, seed=60)
    table = table.rows(np.arange(8))
    angles = np.zeros(table.motor_angles.shape)
    angles[:, 1] = [0.3, 0.3, 0.5, 0.5 + READING.still_rad / 2, 0.1, 0.1, 0.2, 0.2]
    table = replace(table, motor_angles=angles, time=None, run=np.repeat(["1", "2"], [5, 3]))
    now, kept = (sides_of_last_moves(table, keep)[:, 1].tolist() for keep in (False, True))
    np.testing.assert_equal(now, [np.nan, 0, 1, 1, -1, np.nan, 1, 0])
    np.testing.assert_equal(kept, [np.nan, np.nan, 1, 1, -1, np.nan, 1, 1])
