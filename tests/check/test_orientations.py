"""Orientations that are another frame's than the tool's."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import armscope
from armscope.check.preconditions import as_notices
from armscope.check.report import check, what_forbids
from tests.check.test_check import problems


@pytest.mark.parametrize(
    "sequence", ["ZYX", "xyz", *(pytest.param(each, marks=pytest.mark.long) for each in ("ZXZ", "YXZ"))]
)
@pytest.mark.parametrize("small", [False, True])
def test_orientations_that_are_not_the_tools_are_said_and_left_alone(sequence, small, arm, sound):
    # the tool of poses about one direction turns little, so that another reading may be less wrong by chance
    table = sound.rows(np.abs(sound.motor_angles[:, 0]) < 1.5) if small else sound
    euler = Rotation.from_quat(table.orientation, scalar_first=True).as_euler("XYZ")
    wrong = Rotation.from_euler(sequence, euler).as_quat(scalar_first=True)
    report = check(replace(table, orientation=wrong), arm)
    assert [each.weight for each in report.suspicions] == ["hint"]
    assert "the orientations scatter by" in report.text()
    assert not report.consistency.orientations
    assert check(sound, arm).consistency.orientations


def test_each_target_may_be_turned_in_its_own_way(arm, sound):
    turned = Rotation.from_quat(sound.orientation, scalar_first=True)
    turned[40:] = turned[40:] * Rotation.from_rotvec([0, 0, 2.0])
    target = np.repeat(["p", "q"], 40)
    table = replace(sound, target=target, orientation=turned.as_quat(scalar_first=True))
    assert problems(table, arm) == []
    assert check(table, arm).consistency.orientations
    assert "order x, y, z, w" in problems(replace(table, orientation=np.roll(table.orientation, -1, axis=1)), arm)[0]


def test_a_wrong_order_is_a_mistake_with_its_cure_and_spoils_no_points(arm, sound):
    wrong = replace(sound, orientation=np.roll(sound.orientation, -1, axis=1))
    (notice,) = as_notices(what_forbids(wrong, arm), None)
    assert notice.kind == "orientations"
    assert "Declare order: xyzw, or exchange the columns. Until then positions are used alone." in notice.text
    quick = {"resamples": 0, "cross_validation": False}
    alone = armscope.diagnose(replace(sound, orientation=None), arm, **quick)
    told, asked = (armscope.diagnose(wrong, arm, orientation=each, **quick) for each in (True, False))
    assert told.headline == asked.headline == alone.headline
    assert "cannot be relied on" not in alone.headline
    assert notice in told.notices
    assert asked.notices == alone.notices
