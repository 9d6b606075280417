"""Orientations that are another frame's than the tool's."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.check.report import check
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
