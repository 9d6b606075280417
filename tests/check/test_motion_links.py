"""A link that does not follow its motor is told before anything is fitted."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.motion_links import links_beside_motors
from armscope.check.motions import check_moving
from armscope.recordings.motions import as_motions
from tests.motion.moving import moved, robot, table


@pytest.mark.parametrize(
    ("factor", "words"),
    [(-1.0, "other way"), (180 / np.pi, "degrees"), (np.pi / 180, "radians"), (0.01, "own turns")],
)
def test_a_link_that_does_not_follow_its_motor_is_a_problem(factor: float, words: str) -> None:
    good = moved(robot(), 5, seconds=8.0)
    link = np.full(good.q.shape, np.nan)
    link[:, 1] = factor * good.q[:, 1]
    (found,) = links_beside_motors(replace(good, link=link))
    assert found.weight == "problem"
    assert words in found.cure
    assert check_moving(replace(good, link=link), robot()).has_problems


def test_a_link_that_winds_up_a_little_is_not_accused() -> None:
    good = moved(robot(), 5, seconds=8.0)
    assert not list(links_beside_motors(replace(good, link=1.001 * good.q + 0.2)))
    assert not list(links_beside_motors(good))


def test_links_of_other_joints_are_told_as_shifted() -> None:
    """They were asked to be the motor's own turns, by factors that nothing means."""
    good = moved(robot(), 5, seconds=8.0)
    shifted = np.column_stack([np.full(len(good.q), np.nan), good.q[:, :2] + 1e-4])
    found = list(links_beside_motors(replace(good, link=shifted)))
    assert [each.statement.split(",")[0] for each in found] == [
        "q2_link is the position of joint 1",
        "q3_link is the position of joint 2",
    ]
    assert [each.cure.split()[-1] for each in found] == ["q1_link.", "q2_link."]


def test_links_are_read_in_either_unit_joint_by_joint() -> None:
    rows = table(robot(), 5, seconds=2.0)
    rows["q2_link_deg"] = np.degrees(rows["q2_rad"]) + 1.0
    motions = as_motions(rows, "motions.csv", 3)
    assert motions.link is not None
    assert np.allclose(motions.link[:, 1], motions.q[:, 1] + np.radians(1.0))
    assert np.isnan(motions.link[:, [0, 2]]).all()
    assert not motions.notes
