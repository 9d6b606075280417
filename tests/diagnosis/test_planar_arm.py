"""An arm whose axes are all parallel: its base and tool take up no error of a link."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.recordings import Recordings
from armscope.robot import Arm, load_arm
from tests.diagnosis.planted import one_run, recorded

SCARA = """
name: planar arm
dh:
  convention: standard
  joints:
  - {a_mm: 325, alpha_deg: 0, d_mm: 400, theta_offset_deg: 0}
  - {a_mm: 275, alpha_deg: 180, d_mm: 0, theta_offset_deg: 0}
  - {a_mm: 0, alpha_deg: 0, d_mm: 100, theta_offset_deg: 0}
joint_limits_deg: [[-126, 126], [-126, 126], [-180, 180]]
tool_mm: [0, 30, 60]
links:
- {mass_kg: 4, com_mm: [-160, 0, 0]}
- {mass_kg: 3, com_mm: [-130, 0, 0]}
- {mass_kg: 1, com_mm: [0, 0, -50]}
"""
LONGER_MM = 0.4


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Arm:
    file: Path = tmp_path_factory.mktemp("planar") / "robot.yaml"
    file.write_text(SCARA)
    return load_arm(file)


def bare(arm: Arm, seed: int) -> Recordings:
    """Random poses, of which nothing but angles and points was recorded."""
    nothing = dict.fromkeys(("payload", "approach", "speed", "torque", "time", "temperature"))
    return replace(one_run(arm, 80, seed), **nothing)


@pytest.mark.parametrize("seed", [1, 2, 5])
def test_the_error_of_a_link_is_told_in_full(arm: Arm, seed: int) -> None:
    """It was 6 % of the squared error, and an error of 0.02 mm that poses which took no part had as 0.22."""
    wanted = {("link_geometry", "link 2"): [1e-3 * LONGER_MM]}
    verdict = diagnose(arm, recorded(arm, bare(arm, seed), wanted, 0.02, seed, far=True), Settings(resamples=0))
    assert verdict.residual_before_mm == pytest.approx(verdict.held_out.before, rel=0.1)
    assert verdict.residual_before_mm > 0.12  # 0.4 mm of link 2, of which frames take up what they can
    assert sum(effect.share for effect in verdict.effects) + verdict.background.share > 0.95


def test_noise_alone_is_no_error_of_a_planar_arm(arm: Arm) -> None:
    verdict = diagnose(arm, recorded(arm, bare(arm, 3), {}, 0.02, 3, far=True), Settings(resamples=0))
    assert verdict.answer == "nothing missing"
