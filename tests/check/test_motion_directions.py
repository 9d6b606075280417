"""Joints counted the other way round are told, with their torque or without; where masses do not say, nothing is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from armscope.check.motions import check_moving
from armscope.check.suspicion import Suspicion
from armscope.recordings.motions import Motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import MovingArm, build_moving_arm
from tests.check.test_motion_mistakes import slim
from tests.check.test_motion_readings import recorded, said, wristed
from tests.motion.moving import path
from tests.seeds import seeds


def counted(motions: Motions, joints: Sequence[int], torques: Sequence[int] = ()) -> Motions:
    """With positions of some joints, and torques of some, of the other sign; joints from 1."""
    signs, of_torque = (
        np.where(np.isin(np.arange(motions.n_motors) + 1, some), -1.0, 1.0) for some in (joints, torques)
    )
    return replace(motions, q=signs * motions.q, effort=of_torque * motions.effort)


def moved(arm: MovingArm, seed: int) -> Motions:
    """A run of an arm with friction of half and rotors of a tenth of what its masses ask for."""
    time, q, dq, ddq = path(np.random.default_rng(seed), arm.n_motors, 20.0, 200.0)
    torque = arm.torques(q, dq, ddq, arm.inertial)
    size = np.maximum(torque.std(axis=0), 0.05)
    torque += size * (0.5 * np.sign(dq) + 0.1 * ddq + 0.02 * np.random.default_rng(seed).normal(size=q.shape))
    run = np.full(len(time), "", dtype="<U1")
    return Motions(time, q, torque, "torque", np.zeros(arm.n_motors, dtype=np.bool_), run)


def built(rows: Sequence[tuple[float, float, float]], bodies: Sequence[tuple[float, list[float]]]) -> MovingArm:
    joints = [dict(zip(("a_mm", "alpha_deg", "d_mm"), row, strict=True)) for row in rows]
    links = [
        {"mass_kg": m, "com_mm": c, "inertia_kg_m2": [0.005 * m, 0.006 * m, 0.006 * m, 0, 0, 0]} for m, c in bodies
    ]
    return build_moving_arm(RobotDescription.model_validate({"name": "arm", "dh": {"joints": joints}, "links": links}))


def first(motions: Motions, arm: MovingArm) -> Suspicion:
    return check_moving(motions, arm).suspicions[0]


@pytest.fixture(scope="module", params=seeds(1, 2, 3))
def good(request: pytest.FixtureRequest) -> Motions:
    return recorded(request.param)


@pytest.mark.parametrize("joint", [2, 3])
def test_a_joint_that_is_counted_the_other_way_with_its_torque_is_told_alone(good: Motions, joint: int) -> None:
    (told,) = check_moving(counted(good, [joint], [joint]), wristed()).suspicions
    assert told.weight == "problem"
    assert told.statement.startswith(f"with joint {joint} counted the other way round the stated masses leave ")
    assert told.cure.startswith(f"Negate q{joint} and its speeds and tau{joint}_nm; or turn the axis of joint {joint} ")


@pytest.mark.parametrize("joint", [2, 3])
def test_a_position_alone_that_is_counted_the_other_way_is_no_turned_torque(good: Motions, joint: int) -> None:
    (told,) = check_moving(counted(good, [joint]), wristed()).suspicions
    assert told.weight == "problem"
    assert told.statement.startswith(f"with the position of joint {joint} alone counted the other way round ")
    assert told.cure.startswith(f"Negate q{joint} and its speeds, and leave tau{joint}_nm.")


def test_a_joint_without_gravity_is_told_by_how_it_couples_with_the_others() -> None:
    arm = slim()
    motions = moved(arm, 7)
    assert not check_moving(motions, arm).suspicions
    assert first(counted(motions, [1], [1]), arm).statement.startswith("with joint 1 counted the other way round ")
    alone = first(counted(motions, [1]), arm)
    assert alone.statement.startswith("with the position of joint 1 alone counted the other way round ")


def test_joints_that_are_counted_the_other_way_are_told_together(good: Motions) -> None:
    assert said(counted(good, [2, 3], [2, 3]))[0].startswith("problem with joints 2 and 3 counted the other way round ")
    mixed = said(counted(good, [2, 3], [3]))
    assert mixed[0].startswith("problem with joint 3 and the position of joint 2 alone counted the other way round ")


def test_two_joints_that_hide_each_other_are_found_as_a_pair() -> None:
    arm = slim()
    for pair in ((2, 4), (2, 6), (3, 5)):
        told = first(counted(moved(arm, 3), pair, pair), arm)
        assert told.statement.startswith(f"with joints {pair[0]} and {pair[1]} counted the other way round ")


def test_a_wrist_that_carries_next_to_nothing_may_be_counted_either_way(good: Motions) -> None:
    for joint in (4, 5):
        for each in said(counted(good, [joint], [joint])):  # on some paths a wrist tells even so, and tells no other
            assert each.startswith(f"hint with joint {joint} counted the other way round "), each
        told = first(counted(good, [joint]), wristed())
        either = f"tau{joint}_nm has the sign opposite", f"with the position of joint {joint} alone counted the other "
        assert told.statement.startswith(either)
        if told.statement.startswith(either[0]):
            assert f"Or q{joint}, with its speeds, is counted the other way round" in told.cure


def test_a_turned_torque_is_no_position_where_masses_say_so(good: Motions) -> None:
    for joint in (2, 3):
        told = first(counted(good, [], [joint]), wristed())
        assert told.statement.startswith(f"tau{joint}_nm has the sign opposite")
        assert "counted" not in told.statement + told.cure


@pytest.mark.long
def test_another_order_or_a_zero_elsewhere_is_no_direction(good: Motions) -> None:
    for order in [each for each in permutations(range(5)) if sum(np.array(each) != np.arange(5)) == 2]:
        both = replace(good, q=good.q[:, order], effort=good.effort[:, order])
        for motions in (both, replace(both, effort=good.effort), replace(both, q=good.q)):
            assert not [each for each in said(motions) if "other way round the stated" in each], order
    for joint, turn in ((1, np.pi), (2, np.pi / 2), (2, -np.pi / 2)):
        off = replace(good, q=good.q + turn * (np.arange(5) == joint))
        assert not [each for each in said(off) if "other way round the stated" in each]


def test_of_two_level_axes_one_or_the_other_is_counted_so() -> None:
    """Joint 1 the other way round is joint 2 so, seen in a mirror: a level arm of plain links is its mirror image."""
    level = built([(400, 0, 300), (300, 0, 0), (0, 0, 50)], [(8, [-200, 0, 0]), (5, [-150, 0, 0]), (0.001, [0, 0, 0])])
    good = moved(level, 4)
    assert not check_moving(good, level).suspicions
    told = {first(counted(good, [joint], [joint]), level).statement.split(" counted")[0] for joint in (1, 2)}
    assert told <= {"with joint 1 (or joint 2 in its place)", "with joint 2 (or joint 1 in its place)"}


def test_a_last_link_that_is_stated_on_the_other_side_is_no_problem() -> None:
    rows = [(0, -90, 300), (400, 0, 0), (300, 0, 0)]
    bodies = [(8, [0, 50, 0]), (6, [-180, 20, 10])]
    stated, real = (built(rows, [*bodies, (3, [-150, y, 0])]) for y in (60, -60))
    told = check_moving(moved(real, 5), stated).suspicions
    assert all(each.weight == "hint" for each in told)
    motions = moved(stated, 5)
    hint = first(counted(motions, [3], [3]), stated)
    assert (hint.weight, hint.statement.split(" counted")[0]) == ("hint", "with joint 3")
    assert "whose centre of mass is stated on the other side looks alike" in hint.cure
    assert first(counted(motions, [3]), stated).weight == "problem", "no mass turns the sign of friction"


@pytest.mark.parametrize("carried", [1.0, 2.0, 4.0])
def test_loads_that_are_not_stated_turn_no_joint_round(carried: float) -> None:
    assert not [each for seed in (1, 2, 3) for each in said(recorded(seed, carried)) if "other way round" in each]
