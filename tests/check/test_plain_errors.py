"""What motors turn by beside a plain arm's errors is found with its size and its uncertainty."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.calibration.fit import placed
from armscope.calibration.model import set_up
from armscope.check.constants import TRIALS
from armscope.check.plain_constants import SETTLING
from armscope.check.plain_errors import PlainErrors, drive_columns
from armscope.robot import chain
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like


def test_a_turn_is_found_within_its_standard_errors_beside_errors_of_geometry() -> None:
    arm, apart = ur_like(), []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        angles = poses(rng, 150, 6)
        follows = rng.normal(size=(150, 2))
        turned = angles.copy()
        turned[:, [1, 3]] += follows * [3e-4, -2e-4]
        rows = measured(planted(arm, rng), turned, far_away(rng), {"": [0.0, 0.1, 0.1]}, 3e-5, rng)
        table = replace(rows, motor_angles=angles)
        state = placed(set_up(arm, table), TRIALS.steps)
        found = PlainErrors(arm, table, state).with_turns(np.array([1, 3]), follows)
        assert found is not None
        assert found.left < SETTLING.most * found.before, "a hint by what rows that had not come to rest must leave"
        apart.append((found.values - [3e-4, -2e-4]) / found.stderrs)
    # twelve standard normal numbers: their mean square is between 0.25 and 2.4 in all but one of a thousand cases
    assert 0.25 < np.mean(np.square(apart)) < 2.4


def test_what_a_drives_own_angle_does_is_no_turn_of_something_else() -> None:
    arm, rng = ur_like(), np.random.default_rng(1)
    angles = poses(rng, 60, 6)
    table = measured(arm, angles, far_away(rng), {"": [0.0, 0.1, 0.1]}, 3e-5, rng)
    state = placed(set_up(arm, table), TRIALS.steps)
    plain = PlainErrors(arm, table, state)
    assert plain.with_turns(np.array([2]), np.cos(angles[:, [2]])) is None
    assert plain.with_turns(np.empty(0, dtype=np.intp), np.empty((60, 0))) is None


@pytest.mark.parametrize("motor", [0, 4])
def test_a_ratios_column_is_the_slope_of_the_arms_points(motor: int) -> None:
    arm, rng = ur_like(), np.random.default_rng(2)
    angles, at_origin = poses(rng, 20, 6), (np.eye(3), np.zeros(3))
    table = measured(arm, angles, at_origin, {"": [0.0, 0.1, 0.1]})
    rows = set_up(arm, table)
    columns = drive_columns(arm, rows.posed(placed(rows, TRIALS.steps)), angles)
    further, step = angles.copy(), 1e-6
    further[:, motor] *= 1 + step
    there, here = (chain(replace(arm, tool=np.array([0.0, 0.1, 0.1])), q).tool for q in (further, angles))
    slope = ((there - here) / step).ravel()
    np.testing.assert_allclose(np.abs(columns[:, motor]), np.abs(slope), atol=1e-4)
