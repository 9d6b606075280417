"""Which tilts keep their size as the joint turns, and which way they go."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.rotations import turned_by
from armscope.diagnosis.summary.turning_tilts import runs_round, sense_of_round

TILT = 1e-3
SURE = 1e-12 * np.eye(4)


@pytest.mark.parametrize("direction", [0.0, 0.7, 2.5])
def test_a_twist_of_the_turned_link_is_a_tilt_that_turns_with_the_joint(direction: float) -> None:
    """By rotation matrices: after the joint's turn a constant tilt, before it (cosine, sine) about x and about y."""
    twist = TILT * np.array([np.cos(direction), np.sin(direction), 0.0])
    angles = np.linspace(-3, 3, 50)
    before = []
    for angle in angles:
        turn = turned_by(np.array([0.0, 0.0, angle]))
        moved = turn @ turned_by(twist) @ turn.T
        before.append([moved[2, 1] - moved[1, 2], moved[0, 2] - moved[2, 0]])
    waves = np.column_stack([np.cos(angles), np.sin(angles)])
    about_x, about_y = np.linalg.lstsq(waves, np.array(before) / 2, rcond=None)[0].T
    values = np.array([*about_x, *about_y])
    assert np.hypot(*values[:2]) == pytest.approx(TILT, rel=1e-3)
    assert sense_of_round(values) == 0
    assert runs_round(values, SURE)


def test_a_tilt_in_one_plane_does_not_run_round_and_one_against_the_joint_is_no_twist() -> None:
    assert not runs_round(np.array([TILT, 0.0, 0.0, 0.0]), SURE)
    against = np.array([TILT, 0.0, 0.0, -TILT])
    assert runs_round(against, SURE)
    assert sense_of_round(against) == 1
