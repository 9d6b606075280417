"""What is promised of numbers in a controller is what its motors can do."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from armscope.core.averages import rms
from armscope.diagnosis import Settings, diagnose
from armscope.robot import load_arm
from armscope.verdict.contributions import contributions
from armscope.verdict.out_of_reach import out_of_reach
from armscope.verdict.work_order import work_order
from tests.diagnosis.planted import recorded
from tests.diagnosis.test_planar_arm import SCARA, bare
from tests.verdict.test_contributions import verdict, world  # noqa: F401  (fixtures)


def test_a_planar_arm_cannot_command_its_tool_back_to_its_plane(tmp_path: Path) -> None:
    """A twist lifts its tool: 0.0095 mm were promised of commands that left 0.091."""
    (tmp_path / "robot.yaml").write_text(SCARA)
    arm = load_arm(tmp_path / "robot.yaml")
    table = recorded(arm, bare(arm, 1), {("link_geometry", "link 1"): [0.0, 1.5e-3]}, 0.01, 1, far=True)
    found = diagnose(arm, table, Settings(resamples=0, cross_validation=False))
    worth = contributions(found)
    order = work_order(found, worth)
    (stays,) = re.findall(r"leave ([0-9.]+) mm RMS", order.caution)
    lifted = np.column_stack([worth.left[:, :2], worth.before[:, 2]])
    assert float(stays) == pytest.approx(rms(lifted), rel=0.02)
    assert float(stays) > 3 * rms(worth.left)


def test_an_arm_that_moves_its_tool_every_way_is_told_nothing_of_it(verdict) -> None:  # noqa: F811
    assert out_of_reach(verdict, contributions(verdict)) == ""
