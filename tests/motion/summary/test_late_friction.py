"""Friction that turns over late is told although nothing has its name; what presliding and filters do is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.library.dry_friction import ChangeOfSides
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.samples.preparation import Signals
from armscope.motion.summary.late_friction import latest_in_words, told_late
from armscope.verdict.schema import Notice
from tests.motion.moving import COULOMB, moved, robot

JOINT, RATE = 2, 200.0


def diagnosed(late_s: float) -> MotionDiagnosis:
    """Of an arm whose third joint's dry friction changes sides so late."""
    arm = robot()

    def clinging(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        time = np.arange(len(q)) / RATE
        signals = Signals("", 0, time, q, dq, ddq, q[:0], None, None, np.arange(len(q)))
        late, now = (ChangeOfSides.of(arm, by).sides(signals)[:, JOINT] for by in (late_s, 0.0))
        extra = np.zeros_like(q)
        extra[:, JOINT] = COULOMB[JOINT] * (late - now)
        return extra

    return diagnose_motion(arm, moved(arm, 3, clinging, seconds=15.0), MotionSettings(cutoff=10.0))


def notices(late_s: float) -> list[Notice]:
    """What is said of it."""
    return [notice for notice in diagnosed(late_s).verdict.notices if notice.kind == "late friction"]


@pytest.mark.long
def test_friction_that_clings_is_told_where_and_by_how_much() -> None:
    (told,) = notices(0.012)
    assert "joint 3 12 ±" in told.text
    assert "joint 1" not in told.text
    assert "joint 2" not in told.text


@pytest.mark.long
def test_friction_in_time_with_its_speed_is_not() -> None:
    assert not notices(0.0)
    assert not notices(0.0015)


@pytest.mark.long
def test_a_joint_that_pauses_changes_no_sides_too_soon() -> None:
    """Before it moves again its motor builds up what breaks it loose: that is no time of its friction."""
    found = diagnosed(-0.012)
    (told,) = told_late(found.selected, found.sure)
    assert "joint 3 -1" in told.text
    still = found.selected.rows.still.copy()
    still[:3, JOINT] = True
    pausing = replace(found.selected, rows=replace(found.selected.rows, still=still))
    assert told_late(pausing, found.sure) == []


def test_a_joint_that_is_later_than_all_others_is_pointed_at() -> None:
    """A torque read 8 ms late at one joint was 20 ms in a list of 7 to 11."""
    told = [(0, 0.011, 0.0007), (3, 0.020, 0.0016), (4, 0.011, 0.0008)]
    assert latest_in_words(told).startswith(" By 9.0 ms joint 4 is later than any other")
    assert latest_in_words([*told, (5, 0.016, 0.001)]) == ""
    assert latest_in_words([told[0], (3, 0.020, 0.01)]) == ""
    assert latest_in_words([*told, (5, 0.106, 0.03)]) == ""  # no friction turns so late: it is no moment at all
    assert latest_in_words(told[:1]) == ""
