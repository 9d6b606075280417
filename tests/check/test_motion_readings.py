"""Torques of another joint and zeros elsewhere are told where nothing else is meant; good tables are not accused."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from armscope.check.motions import check_moving
from armscope.core.inputs import InputError
from armscope.recordings.motions import Motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import MovingArm, build_moving_arm
from tests.motion.moving import path
from tests.seeds import seeds

DRY, VISCOUS = np.array([4.0, 5.0, 2.0, 0.8, 0.5]), np.array([3.0, 4.0, 1.5, 0.6, 0.4])
ROTOR = np.array([0.5, 0.6, 0.2, 0.05, 0.03])
LIGHT = {"mass_kg": 0.05, "com_mm": [0, 5, 10], "inertia_kg_m2": [1e-4, 1e-4, 1e-4, 0, 0, 0]}


def wristed() -> MovingArm:
    """An arm whose last two joints carry next to nothing: friction is most of their torque."""
    rows = [(0, -90, 300), (400, 0, 0), (0, 90, 0), (0, -90, 350), (0, 0, 80)]
    bodies = [(10, [0, 40, 0]), (8, [-180, 0, 20]), (3, [10, 0, 60])]
    of = [{"mass_kg": m, "com_mm": c, "inertia_kg_m2": [0.1, 0.1, 0.1, 0, 0, 0]} for m, c in bodies]
    joints = [dict(zip(("a_mm", "alpha_deg", "d_mm"), row, strict=True)) for row in rows]
    return build_moving_arm(
        RobotDescription.model_validate({"name": "wristed", "dh": {"joints": joints}, "links": [*of, LIGHT, LIGHT]})
    )


@pytest.fixture(scope="module", params=seeds(1, 2, 3))
def good(request: pytest.FixtureRequest) -> Motions:
    return recorded(request.param)


def recorded(seed: int, carried: float = 0.0) -> Motions:
    """One run of the arm with wrist, which carries so many kg at its tool point, not stated."""
    arm, rng = wristed(), np.random.default_rng(seed)
    time, q, dq, ddq = path(rng, arm.n_motors, 20.0, 200.0)
    torque = arm.torques(q, dq, ddq, arm.inertial + carried * arm.point_load())
    torque += DRY * np.sign(dq) + VISCOUS * dq + ROTOR * ddq
    torque += 0.02 * torque.std(axis=0) * rng.normal(size=torque.shape)
    run = np.full(len(time), "", dtype="<U1")
    return Motions(time, q, torque, "torque", np.zeros(5, dtype=np.bool_), run)


def said(motions: Motions) -> list[str]:
    return [f"{each.weight} {each.statement}" for each in check_moving(motions, wristed()).suspicions]


def test_a_good_table_is_not_accused(good: Motions) -> None:
    assert said(good) == []


def test_radians_in_columns_of_degrees_are_told_before_any_zero(good: Motions) -> None:
    """All angles within six degrees, which a zero a quarter turn off explained well enough to be blamed."""
    told = said(replace(good, q=np.radians(good.q)))
    assert told[0].startswith("problem masses explain ")
    assert "if what is read as degrees is radians" in told[0]
    assert not [each for each in told if "the stated masses leave" in each]


def test_currents_of_unknown_gains_are_refused_as_the_diagnosis_does(good: Motions) -> None:
    with pytest.raises(InputError, match="gain_nm_per_a"):
        check_moving(replace(good, kind="current"), wristed())
    assert check_moving(replace(good, kind="current")), "without an arm nobody asks for them"


def test_exchanged_torques_of_joints_that_carry_little_are_told_by_their_friction(good: Motions) -> None:
    told = said(replace(good, effort=good.effort[:, [0, 1, 2, 4, 3]]))
    assert len(told) == 2
    assert told[0].startswith("problem tau4_nm follows joint 5: ")
    assert told[1].startswith("problem tau5_nm follows joint 4: ")


def test_every_exchange_of_two_torques_is_a_problem_of_their_order_alone(good: Motions) -> None:
    for one, other in combinations(range(5), 2):
        order = list(range(5))
        order[one], order[other] = other, one
        told = said(replace(good, effort=good.effort[:, order]))
        in_order = f"with torques in the order {' '.join(str(j + 1) for j in order)}"
        assert in_order in told[0] or f"tau{one + 1}_nm follows joint {other + 1}:" in told[0]


def test_joints_that_move_alike_are_not_exchanged() -> None:
    """Where two joints always turn together, each torque follows the other's motion as well as its own."""
    motions = recorded(4)
    alike = replace(motions, q=motions.q.copy(), effort=motions.effort.copy())
    alike.q[:, 4], alike.effort[:, 4] = alike.q[:, 3] + 0.3, 0.6 * alike.effort[:, 3]
    assert not [each for each in said(alike) if "follows" in each]


@pytest.mark.parametrize("joint", [1, 2, 3, 4])
def test_one_joint_in_degrees_is_told_before_another_order(good: Motions, joint: int) -> None:
    degrees = np.where(np.arange(1, 6) == joint, 180 / np.pi, 1.0)
    told = [each for each in said(replace(good, q=good.q * degrees)) if each.startswith("problem masses explain ")]
    assert len(told) == 1
    assert told[0].endswith(f"if q{joint} alone is in degrees")
