"""Nests are scanned where a tool turns over, and nowhere else."""

from dataclasses import replace

import numpy as np

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.scans import loose_nests as scanning
from tests.diagnosis.planted import planted


def test_nests_are_scanned_only_where_the_tool_turns_over(monkeypatch) -> None:
    """Upright, no pose shows a nest: none is tried, and a joint's zero keeps its name."""
    tried = []
    monkeypatch.setattr(scanning, "nests_anyhow", lambda: tried.append(1) or (_ for _ in ()).throw(AssertionError))
    scanning._blocks.cache_clear()
    arm, table = planted("six-axis", {("joint_offset", "joint 1"): [0.0]}, 40, 0.02, seed=5)
    upright = replace(table, motor_angles=table.motor_angles * np.array([1.0, 0, 0, 0, 0, 0]))
    verdict = diagnose(arm, upright, Settings(resamples=0, cross_validation=False))
    scanning._blocks.cache_clear()
    assert not tried
    assert "loose_target" not in {effect.effect for effect in verdict.effects}
