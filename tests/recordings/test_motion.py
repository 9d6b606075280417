"""A joint that never moves is one for the check, the effects and the report alike."""

from __future__ import annotations

import numpy as np

from armscope.check.report import check
from armscope.diagnosis import Settings, diagnose
from armscope.physics.placing import moving_joints
from armscope.recordings.constants import READING
from armscope.recordings.motion import moving
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
