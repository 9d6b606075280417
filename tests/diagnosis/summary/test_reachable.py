"""Poses to measure next keep to what the recordings show: room, loads, and no links in one another."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis.summary.constants import NEXT_POSES
from armscope.diagnosis.summary.reachable import checked_in_words, free_space, reachable
from armscope.poses.obstacles import Surroundings, lowest, refusals
from armscope.robot import load_arm
from tests.diagnosis.planted import one_run

ARMS = ("six-axis", "seven-axis", "ur3e", "irb120")


def recorded(name, count=30):
    from tests.physics.scenes import arm_named

    arm = load_arm(name) if name in ("ur3e", "irb120") else arm_named(name)
    return arm, one_run(arm, count, seed=4)


def asked(arm, table, floor=None, by_load=True):
    return reachable(arm, table, free_space(arm, table, floor), by_load, np.random.default_rng(0))


@pytest.mark.parametrize("name", ARMS)
def test_no_part_comes_lower_than_any_did_and_no_link_hits_another(name):
    arm, table = recorded(name)
    poses = asked(arm, table).motor_angles
    assert len(poses) == NEXT_POSES.tried
    anywhere = Surroundings()
    assert lowest(arm, poses, anywhere).min() >= lowest(arm, table.motor_angles, anywhere).min()
    assert set(refusals(arm, poses, anywhere)) == {""}


def test_a_stated_floor_counts_in_place_of_the_recordings():
    arm, table = recorded("six-axis")
    poses = asked(arm, table, 0.9).motor_angles
    assert len(poses)
    assert lowest(arm, poses, Surroundings()).min() >= 0.9


def test_an_arm_that_hangs_counts_heights_the_other_way():
    arm, table = recorded("six-axis")
    hanging = replace(arm, gravity=np.array([0, 0, 9.81]))
    poses = asked(hanging, table).motor_angles
    upside_down = Surroundings(up=np.array([0, 0, -1.0]))
    assert lowest(hanging, poses, upside_down).min() >= lowest(hanging, table.motor_angles, upside_down).min()
    told = checked_in_words(hanging, free_space(hanging, table), True, NEXT_POSES.asked)
    assert "against gravity" in told


def test_no_load_is_asked_for_that_was_not_carried_or_tells_nothing():
    arm, table = recorded("six-axis")
    assert asked(arm, replace(table, payload=None)).payload is None
    carried = replace(table, payload=np.repeat([np.nan, 2.0, 3.0], 10))
    assert set(asked(arm, carried).payload) == {0.0, 3.0}
    assert set(asked(arm, carried, by_load=False).payload) == {2.0}
    assert set(asked(arm, replace(table, payload=np.full(30, np.nan))).payload) == {0.0}


def test_where_no_pose_is_known_to_be_free_none_is_asked_for_and_that_is_told():
    arm, table = recorded("six-axis")
    assert len(asked(arm, table, floor=10.0)) == 0
    told = checked_in_words(arm, free_space(arm, table, 10.0), False, 0)
    assert "Only 0 of 12" in told
    assert "z = 10000 mm" in told
    assert "Only" not in checked_in_words(arm, free_space(arm, table), True, NEXT_POSES.asked)


def test_few_recorded_poses_in_a_corner_leave_those_within_their_range():
    """Straight up: within the whole limits hardly any pose is as high."""
    arm, table = recorded("six-axis")
    up = replace(table, motor_angles=table.motor_angles * 0.02)
    assert len(asked(arm, up)) == NEXT_POSES.tried
