"""What a diagnosis says of its table before anything is fitted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.motion.check import check_motions
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.recordings.motions import Motions
from tests.motion.moving import moved, robot


def cut_off(seed: int, share: float) -> Motions:
    """The torque of joint 2 beyond some quantiles is not recorded."""
    good = moved(robot(), seed, seconds=15.0)
    effort = good.effort.copy()
    effort[:, 1] = np.clip(effort[:, 1], *np.quantile(effort[:, 1], [share, 1 - share]))
    return replace(good, effort=effort)


@pytest.mark.long
def test_a_channel_that_was_cut_off_is_told_and_names_nothing() -> None:
    """What was not recorded is no torque: neither a law of it nor something unknown."""
    for seed in (3, 4, 5):
        verdict = diagnose_motion(robot(), cut_off(seed, 0.05), MotionSettings(cutoff=10.0)).verdict
        (told,) = [notice for notice in verdict.notices if notice.kind == "cut off"]
        assert told.text.startswith("tau2_nm stays at")
        assert "take no part in the fit of joint 2" in told.text
        assert verdict.answer == "nothing missing"
        assert not verdict.effects


def test_rows_beside_what_was_cut_off_count_for_no_joint_but_its_own() -> None:
    selected = diagnose_motion(robot(), cut_off(3, 0.05), MotionSettings(cutoff=10.0)).selected
    out = np.mean(selected.rows.still, axis=0)
    assert 0.1 < out[1] < 0.5
    assert np.all(out[[0, 2]] < 0.02)
    assert np.all(selected.weights.row[selected.rows.still[:, 1], 1] == 0)


def test_a_channel_that_peaks_is_not_cut_off() -> None:
    assert not [notice for notice in check_motions(robot(), moved(robot(), 3)) if notice.kind == "cut off"]
