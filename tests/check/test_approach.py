"""A column of the side of approach whose sign is turned round is told; one that is right is not."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.preconditions import as_notices
from armscope.check.report import check, what_forbids
from armscope.check.suspicion import APPROACH
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like

GAP = 4e-4


@pytest.mark.parametrize("sign", [1, -1])
def test_play_that_leads_its_command_is_a_column_of_the_wrong_sign(sign: int) -> None:
    arm, rng = ur_like(), np.random.default_rng(4)
    angles = poses(rng, 120, 6)
    sides = rng.choice([-1.0, 1.0], angles.shape)
    behind = angles - 0.5 * GAP * sides * (np.arange(6) == 1)
    rows = measured(planted(arm, rng), behind, far_away(rng), {"": [0.0, 0.1, 0.1]}, 3e-5, rng)
    table = replace(rows, motor_angles=angles, approach=sign * sides)
    found = [each for each in check(table, arm).suspicions if each.kind == APPROACH]
    assert found == [each for each in what_forbids(table, arm) if each.kind == APPROACH]
    assert len(found) == (sign < 0)
    for notice in as_notices(found, None):
        assert notice.kind == APPROACH
        assert "approach2" in notice.text
        assert "Turn the sign" in notice.text


@pytest.mark.parametrize(("order", "told"), [((0, 1, 2), []), ((0, 2, 1), [2, 3]), ((1, 2, 0), [1, 2, 3])])
def test_a_column_that_is_another_joints_is_told(order: tuple[int, ...], told: list[int]) -> None:
    arm, rng = ur_like(), np.random.default_rng(4)
    angles = poses(rng, 60, 6)
    sides = np.sign(np.diff(angles, axis=0, prepend=0.0))[:, [*order, 3, 4, 5]]
    rows = measured(planted(arm, rng), angles, far_away(rng), {"": [0.0, 0.1, 0.1]}, 3e-5, rng)
    found = [each for each in check(replace(rows, approach=sides), arm).suspicions if each.kind == APPROACH]
    assert [each.statement.split()[0] for each in found] == [f"approach{joint}" for joint in told]


def test_sides_of_other_ways_than_from_row_to_row_are_nobody_elses() -> None:
    arm, rng = ur_like(), np.random.default_rng(4)
    angles = poses(rng, 60, 6)
    rows = measured(planted(arm, rng), angles, far_away(rng), {"": [0.0, 0.1, 0.1]}, 3e-5, rng)
    for sides in (rng.choice([-1.0, 1.0], angles.shape), np.ones_like(angles)):
        assert not [each for each in check(replace(rows, approach=sides), arm).suspicions if each.kind == APPROACH]
