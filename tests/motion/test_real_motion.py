"""A real arm whose model has a hand that is not on it: the first thing that is told of the Panda, unprompted."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from armscope.motion.pipeline import diagnose_motion
from armscope.recordings.motions import read_motions
from armscope.robot.dynamics import load_moving_arm

ROOT = Path(__file__).parents[2]
PANDA = ROOT.parent / "shared" / "motions" / "panda-motion"


@pytest.mark.long
@pytest.mark.skipif(not PANDA.is_dir(), reason="../shared/motions, which is no part of this project, is not there")
def test_the_hand_that_is_not_on_the_panda_comes_first(tmp_path: Path) -> None:
    for file in (ROOT / "config" / "motions" / "panda-motion" / "robot.yaml", PANDA / "robot.urdf"):
        shutil.copy(file, tmp_path)
    arm = load_moving_arm(tmp_path / "robot.yaml")
    verdict = diagnose_motion(arm, read_motions(PANDA / "motions.csv.gz", arm.n_motors)).verdict
    first = verdict.effects[0]
    assert (first.effect, first.location) == ("attached_body", "panda_hand")
    assert not first.doubt
    assert first.parameters[0].value < -1.0
    assert verdict.held_out.model < 0.0121, "the reference's best, of the same motion"
