"""A tool exchanged between runs: the check, the calibration and the diagnosis give one answer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.calibration.calibrate import calibrate
from armscope.check.report import check
from armscope.fitting.exchanged_tool import exchanged_tool
from armscope.fitting.registration import fit_frames

from .test_registration import two_runs


@pytest.mark.parametrize(
    ("shift_mm", "exchanged"), [([0.0, 0.0, 0.0], False), ([0.0, 0.1, -0.1], False), ([4.0, -5.0, 6.0], True)]
)
def test_whoever_asks_hears_the_same(shift_mm: list[float], exchanged: bool) -> None:
    arm, table = two_runs(shift_mm)
    found = exchanged_tool(fit_frames(arm, table), table)
    assert (found is not None) == exchanged
    assert ("tool seems to have moved between runs" in check(table, arm).text()) == exchanged
    assert any("it was exchanged" in note for note in calibrate(arm, table, "nominal").notes) == exchanged
    if found is not None:
        assert found.point_mm == pytest.approx(np.linalg.norm(shift_mm), abs=0.3)
        assert found.turn_rad is None
        assert found.shared_mm > 2 * found.own_mm


def test_frames_for_so_few_rows_tell_of_no_exchange() -> None:
    arm, table = two_runs([4.0, -5.0, 6.0])
    few = table.rows(np.concatenate([np.arange(4), np.arange(60, 64)]))
    assert exchanged_tool(fit_frames(arm, few), few) is None


def test_points_of_their_own_names_are_not_exchanged() -> None:
    arm, table = two_runs([4.0, -5.0, 6.0])
    named = replace(table, target=np.where(table.run == "2", "p2", "p1"))
    assert exchanged_tool(fit_frames(arm, named), named) is None
