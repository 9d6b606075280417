"""What a diagnosis says of its table before anything is fitted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.motion.check import check_motions
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from tests.motion.moving import moved, robot


def test_a_verdict_on_a_channel_that_was_cut_off_says_so() -> None:
    good = moved(robot(), 3)
    effort = good.effort.copy()
    effort[:, 1] = np.clip(effort[:, 1], *np.quantile(effort[:, 1], [0.05, 0.95]))
    verdict = diagnose_motion(robot(), replace(good, effort=effort), MotionSettings(cutoff=10.0)).verdict
    (told,) = [notice for notice in verdict.notices if notice.kind == "cut off"]
    assert told.text.startswith("tau2_nm stays at")
    assert verdict.answer != "nothing missing"


def test_a_channel_that_peaks_is_not_cut_off() -> None:
    assert not [notice for notice in check_motions(robot(), moved(robot(), 3)) if notice.kind == "cut off"]
