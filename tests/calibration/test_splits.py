"""Configurations are never parted, and a pose that several runs visit is one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.calibration.splits import random_split
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like
from tests.check.conftest import TOOL


def test_no_pose_is_learned_from_one_run_and_tested_in_another() -> None:
    arm, rng = ur_like(), np.random.default_rng(1)
    real, base, angles = planted(arm, rng), far_away(rng), poses(rng, 30, 6)
    once = measured(real, angles, base, TOOL, 5e-5, rng)
    twice = once.rows(np.arange(60) % 30)
    runs = replace(twice, run=np.repeat(["1", "2"], 30))
    for seed in range(5):
        train, test = random_split(runs, seed)
        assert len(train) == 42
        assert not set(train % 30) & set(test % 30)
        # runs at poses of their own are split by id, as they always were
        apart = replace(runs, motor_angles=runs.motor_angles + 0.01 * (np.arange(60) >= 30)[:, None])
        train, test = random_split(apart, seed)
        assert set(train % 30) & set(test % 30)
