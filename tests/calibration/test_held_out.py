"""Configurations are never parted, and a pose that several runs visit is one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.calibration.held_out import parts_to_test, random_split
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


def test_of_a_short_table_each_configuration_is_held_out_by_itself() -> None:
    """Of twelve poses eight were to tell 27 parameters: 4.2 mm was promised of what foretold others to 0.22."""
    arm, rng = ur_like(), np.random.default_rng(2)
    table = measured(planted(arm, rng), poses(rng, 12, 6), far_away(rng), TOOL, 5e-5, rng)
    parts = list(parts_to_test(table, 5, 27))
    assert len(parts) == 5
    assert sorted(row for pairs in parts for _, test in pairs for row in test.tolist()) == list(range(12))
    assert all(len(train) == 11 for pairs in parts for train, _ in pairs)
    long = list(parts_to_test(table.rows(np.arange(120) % 12), 5, 5))
    assert [len(pairs) for pairs in long] == [1] * 5
