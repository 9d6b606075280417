"""What a joint's torque leaves is what was planted there, and nothing that is free anyway."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.left_at_joint import LeftAtJoint, follows_angle
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm
from tests.motion.moving import moved, robot

ONE = {
    "name": "one joint", "gravity_m_s2": [0, -9.81, 0], "dh": {"joints": [{"a_mm": 500, "alpha_deg": 0, "d_mm": 0}]},
    "links": [{"mass_kg": 10, "com_mm": [-250, 0, 0], "inertia_kg_m2": [0.1, 0.2, 0.2, 0, 0, 0]}],
}  # fmt: skip


def pulled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """A cable at joint 3."""
    extra = np.zeros_like(q)
    extra[:, 2] = np.exp(1.2 * q[:, 2]) - 1
    return extra


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    return diagnose_motion(robot(), moved(robot(), 8, pulled), MotionSettings(cutoff=15.0)).selected


@pytest.fixture(scope="module")
def left(selected: SelectedCauses) -> LeftAtJoint:
    return LeftAtJoint(selected, 2, cables(selected))


def cables(selected: SelectedCauses) -> list[int]:
    return [n for n in selected.best.candidates if follows_angle(selected.rows.layout.placed[n], (2,))]


def test_a_cable_of_another_joint_does_not_follow_its_angle(selected: SelectedCauses) -> None:
    (number,) = cables(selected)
    assert not follows_angle(selected.rows.layout.placed[number], (1,))


def test_what_is_left_is_the_cable(left: LeftAtJoint) -> None:
    """With all else, masses among it, fitted anew: its size is one."""
    cable = left.root * (np.exp(1.2 * left.angle) - 1)
    absorbed = left.absorbed @ cable
    assert cable @ left.left / (cable @ cable - absorbed @ absorbed) == pytest.approx(1.0, abs=0.1)


def test_what_a_rotor_asks_for_is_said_by_its_column_already(left: LeftAtJoint, selected: SelectedCauses) -> None:
    """Of a column that is free nothing is left to say; of the cable most."""
    rows = selected.rows
    own = rows.columns[2][:, [list(rows.at[2]).index(6 * 2 + 3)]].astype(float)
    at = np.searchsorted(rows.q[:, 2][np.argsort(rows.q[:, 2])], left.angle)
    column = left.root * own[np.argsort(rows.q[:, 2])[at], 0]
    cable = left.root * (np.exp(1.2 * left.angle) - 1)
    for values, least, most in ((column, 0.0, 0.02), (cable, 0.3, 1.0)):
        absorbed = left.absorbed @ values
        assert least < 1 - float(absorbed @ absorbed) / float(values @ values) < most


def test_an_arm_of_one_joint_has_no_others_and_its_spring_is_told() -> None:
    """Of no joint's sums there was no total."""
    arm = build_moving_arm(RobotDescription.model_validate(ONE))
    motions = moved(arm, 3, lambda q, dq, ddq, rigid: 30 * (q - 0.2))
    (spring,) = diagnose_motion(arm, motions, MotionSettings(cutoff=15.0)).verdict.effects
    assert (spring.effect, spring.location) == ("gravity_balance", "joint 1")
    assert spring.parameters[0].value == pytest.approx(30.0, rel=0.03)
