"""Rows that carry the name of another target are told by the one that they read as, in an arm that stands in NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.diagnosis import diagnose
from armscope.diagnosis.summary.mislabelled import told_of_labels
from armscope.recordings import Recordings
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.verdict.schema import MISLABELLED, SuspectRow

from ..numpy_arms import QUICK, TOOL_M, UR5E, reached

ROWS, NOISE_M = 100, 3e-5
SECOND_M = np.array([0.04, -0.01, 0.01])
"""From the first target to the second, along the last frame's axes."""


def table_with(wrong: list[int], off_m: float = 0.0) -> Recordings:
    """Rows of two targets in turn, some with the other's name; row 50 is off by something else."""
    rng = np.random.default_rng(8)
    angles, second = rng.uniform(-2, 2, (ROWS, 6)), np.arange(ROWS) % 2
    nothing = np.zeros((6, 4))
    points = reached(UR5E, nothing, angles)
    turned = [
        reached([*UR5E[:5], (UR5E[5][0] + step[0], UR5E[5][1], UR5E[5][2] + step[2])], nothing, angles)
        for step in np.eye(3)[[0, 2]] * 1.0
    ]
    x, z = (each - points for each in turned)
    along = np.stack([x, np.cross(z, x), z], axis=2)
    points = points + second[:, None] * (along @ SECOND_M) + NOISE_M * rng.normal(size=(ROWS, 3))
    points[50, 1] += off_m
    label = second.copy()
    label[wrong] = 1 - label[wrong]
    name, ids = np.array(["p1", "p2"])[label], np.arange(1, ROWS + 1).astype(str)
    return Recordings(angles, points, run=np.full(ROWS, ""), target=name, id=ids)


def test_suspect_rows_say_which_target_they_read_as_and_what_to_do() -> None:
    joints = [{"a_mm": 1e3 * a, "alpha_deg": alpha, "d_mm": 1e3 * d} for a, alpha, d in UR5E]
    arm = build_arm(RobotDescription.model_validate({"name": "arm", "dh": {"joints": joints}, "tool_mm": TOOL_M * 1e3}))
    verdict = diagnose(arm, table_with([6, 31, 70], off_m=0.03), QUICK)
    told = {each.id: each.reads_as for each in verdict.suspects}
    assert told == {"7": "p1", "32": "p2", "71": "p1", "51": ""}
    (notice,) = [each for each in verdict.notices if each.kind == MISLABELLED]
    assert "row 7 reads as target p1" in notice.text
    assert "row 51" not in notice.text
    assert "Correct them, and diagnose again" in notice.text
    sound = diagnose(arm, table_with([], off_m=0.03), QUICK)
    assert [each.reads_as for each in sound.suspects] == [""]
    assert not [each for each in sound.notices if each.kind == MISLABELLED]


@pytest.mark.parametrize(("count", "more"), [(1, False), (10, False), (14, True)])
def test_a_notice_names_ten_rows_and_counts_the_others(count: int, more: bool) -> None:
    (notice,) = told_of_labels([SuspectRow(str(n), "a", 40.0, 0.0, "p2") for n in range(count)])
    assert notice.text.count("reads as target p2") == min(count, 10)
    assert ("4 more (suspects.csv)" in notice.text) == more
    assert told_of_labels([SuspectRow("1", "a", 40.0, 0.0)]) == []
