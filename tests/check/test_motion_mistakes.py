"""Of turned signs and another order the simplest that explains the torques comes first, and alone if it is enough."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from armscope.check.motion_channels import Channels
from armscope.check.motion_mistakes import signs_and_sizes
from armscope.check.motion_readings import Samples
from armscope.check.motions import check_moving
from armscope.recordings.motions import Motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import MovingArm, build_moving_arm
from tests.check.test_motion_readings import recorded, said, wristed
from tests.motion.moving import path, robot


def slim() -> MovingArm:
    """Seven joints whose axes turn one across the other: each carries little more than the next."""
    rows = [(0, -90, 300), (0, 90, 0), (0, 90, 400), (0, -90, 0), (0, -90, 400), (0, 90, 0), (0, 0, 100)]
    bodies = [(6, (0, -30, 0)), (6, (0, 60, 40)), (5, (0, 30, -100)), (3, (0, 60, 30)), (2, (0, 20, -80))]
    bodies += [(2, (0, 0, 0)), (0.3, (0, 0, 20))]
    links = [{"mass_kg": m, "com_mm": list(c), "inertia_kg_m2": [0.02, 0.02, 0.02, 0, 0, 0]} for m, c in bodies]
    joints = [dict(zip(("a_mm", "alpha_deg", "d_mm"), row, strict=True)) for row in rows]
    return build_moving_arm(RobotDescription.model_validate({"name": "slim", "dh": {"joints": joints}, "links": links}))


def turned(motions: Motions, *joints: int) -> Motions:
    """With the sign of some joints' torque turned, counted from 1."""
    signs = np.where(np.isin(np.arange(motions.n_motors) + 1, joints), -1.0, 1.0)
    return replace(motions, effort=motions.effort * signs)


@pytest.mark.parametrize("seed", [7, 8])
def test_one_turned_sign_is_told_alone_where_another_order_would_explain_the_torques_nearly_as_well(seed: int) -> None:
    arm, rng = slim(), np.random.default_rng(seed)
    time, q, dq, ddq = path(rng, 7, 20.0, 200.0)
    friction = np.array([3, 3.5, 2.5, 2, 1.5, 1, 0.8])
    torque = arm.torques(q, dq, ddq, arm.inertial) + friction * (np.sign(dq) + 1.5 * dq + 0.2 * ddq)
    torque += 0.02 * torque.std(axis=0) * rng.normal(size=torque.shape)
    good = Motions(time, q, torque, "torque", np.zeros(7, dtype=np.bool_), np.full(len(time), "", dtype="<U1"))
    assert not check_moving(good, arm).suspicions
    (told,) = check_moving(turned(good, 2), arm).suspicions
    assert told.weight == "problem"
    assert told.statement.startswith("tau2_nm has the sign opposite")
    assert "Turn its sign" in told.cure


@pytest.fixture(scope="module")
def good() -> Motions:
    return recorded(1)


def test_every_sign_that_is_turned_is_told_and_no_order(good: Motions) -> None:
    for count in (1, 2, 3):
        for joints in combinations(range(1, 6), count):
            told = said(turned(good, *joints))
            assert [each.split(" has the sign")[0] for each in told] == [f"problem tau{j}_nm" for j in joints]


@pytest.mark.long
def test_an_exchange_and_a_turned_sign_are_told_one_after_the_other_with_the_column_of_the_table(good: Motions) -> None:
    for one, other in combinations(range(5), 2):
        order = list(range(5))
        order[one], order[other] = other, one
        for sign in range(5):
            mixed = turned(replace(good, effort=good.effort[:, order]), sign + 1)
            told = said(mixed)
            signs = [each for each in told if "has the sign opposite" in each]
            assert [each.split(" has")[0].split()[-1] for each in signs] == [f"tau{sign + 1}_nm"]
            in_order = f"torques in the order {' '.join(str(j + 1) for j in order)}"
            assert any(in_order in each or f"tau{one + 1}_nm follows joint {other + 1}:" in each for each in told)
            later = told[-1] if told[0] not in signs else next(each for each in told if each not in signs)
            assert later.startswith(("problem in that order or unit, ", "problem with turned signs put right, "))


@pytest.mark.parametrize("joint", [1, 2, 3, 4, 5])
def test_a_turned_current_is_told_as_a_torque_is(good: Motions, joint: int) -> None:
    gains = np.array([20.0, -20.0, 15.0, 8.0, 5.0])  # one is stated with the sign in which its current was recorded
    arm = replace(wristed(), gains=gains)
    currents = replace(good, kind="current", effort=good.effort / gains)
    assert not check_moving(currents, arm).suspicions
    (told,) = check_moving(turned(currents, joint), arm).suspicions
    assert told.weight == "problem"
    assert told.statement.startswith(f"current{joint}_a has the sign opposite")
    assert told.cure.startswith("Turn its sign, or that of its gain_nm_per_a")


def test_a_turned_sign_is_told_where_masses_and_friction_say_so_together_and_neither_alone() -> None:
    """A load that is not stated: half of the torque is not what the stated masses ask for, and friction is less."""
    loaded = recorded(3, carried=4.0)
    assert not [each for each in said(loaded) if "sign" in each]
    for joint in range(1, 6):
        assert any(
            each.startswith(f"problem tau{joint}_nm has the sign opposite") for each in said(turned(loaded, joint))
        )


def told(of: Channels, factors: tuple[float, ...], up: bool = False) -> list[str]:
    arm, rng = robot(), np.random.default_rng(0)
    if up:
        arm = robot(gravity_m_s2=[0, 0, 9.81])
    q, dq, ddq = (rng.normal(size=(200, 3)) for _ in range(3))
    torque = arm.torques(q, dq, ddq, arm.inertial) * np.array(factors)
    return [each.text() for each in signs_and_sizes(Samples(q, dq, ddq, torque), arm, of)]


TORQUES = Channels(("tau1_nm", "tau2_nm", "tau3_nm"), (1.0, 1.0, 1.0))


def test_sign_and_size_of_torques_are_told_with_their_columns() -> None:
    assert told(TORQUES, (1, 1, 1)) == []
    sign, size = told(TORQUES, (1, -1, 40))
    assert sign.startswith("tau2_nm has the sign opposite to what moves the stated masses. Is it the load's torque?")
    assert size.startswith("tau3_nm is 40 times what the stated masses ask for.")
    assert told(TORQUES, (1, -1, 1), up=True)[0].count("does the arm hang from a ceiling?") == 1


def test_of_currents_the_sign_alone_is_judged() -> None:
    currents = replace(TORQUES, names=("current1_a", "current2_a", "current3_a"), currents=True)
    (sign,) = told(currents, (1, -1, 40))
    assert sign.startswith("current2_a has the sign opposite to what moves the stated masses. Turn its sign, or that")
