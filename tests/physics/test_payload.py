"""A gripper that nobody counted is in all rows that carry something, and in no other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Driver, Part
from armscope.physics.payload import PAYLOAD_ERROR, payload_errors
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, GRIPPER_KG, NOISE_MM = 120, 6.0, 0.02
LOADS = np.tile([0.0, 5.0, 12.0], ROWS // 3)
GIVES = {("joint_compliance", "joint 2"): [6e-6], ("joint_compliance", "joint 3"): [9e-6]}


@pytest.fixture(scope="module")
def arm() -> Arm:
    return arm_named("six-axis")


def carrying(arm: Arm, stated: Array, true: Array) -> Recordings:
    """Rows of an arm that gives way under its true load, with the load that somebody wrote down."""
    table = replace(one_run(arm, ROWS, 7), approach=None, speed=None, torque=None, time=None, temperature=None)
    measured = recorded(arm, replace(table, payload=true), GIVES, NOISE_MM, 3)
    return replace(measured, payload=stated)


def drive(arm: Arm, table: Recordings) -> Part:
    (placed,) = [p for p in library(arm, table) if p.key == ("joint_compliance", "joint 2") and p.variant == ""]
    return Part(placed, np.array([6e-6]))


def test_a_gripper_that_nobody_counted_is_told_as_carried_with_everything(arm: Arm) -> None:
    verdict = diagnose(arm, carrying(arm, LOADS, LOADS + GRIPPER_KG * (LOADS > 0)), QUICK)
    assert sorted((e.effect, e.location) for e in verdict.effects) == sorted([*GIVES, ("payload_error", "payload")])
    (mass,) = next(e for e in verdict.effects if e.effect == "payload_error").parameters
    assert (mass.name, mass.unit) == ("mass_carried", "kg")
    assert abs(mass.value - GRIPPER_KG) < 3 * mass.stderr
    assert "whatever is carried is" in verdict.headline
    assert "kg heavier than stated" in verdict.headline.replace("\u00a0", " ")


def test_loads_as_stated_are_not_told(arm: Arm) -> None:
    verdict = diagnose(arm, carrying(arm, LOADS, LOADS), QUICK)
    assert sorted((e.effect, e.location) for e in verdict.effects) == sorted(GIVES)


@pytest.mark.parametrize(
    ("stated", "sought"),
    [([0.0, 5.0, 12.0], True), ([0.0, 5.0, 5.0], False), ([1.0, 5.0, 12.0], False), ([0.0, 0.0, 0.0], False)],
)
def test_it_is_sought_where_a_mass_or_a_share_would_say_something_else(
    arm: Arm, stated: list[float], sought: bool
) -> None:
    loads = np.tile(stated, ROWS // 3)
    table = carrying(arm, loads, loads)
    assert ("carried" in {p.variant for p in payload_errors(table, [drive(arm, table)])}) == sought


def test_its_statement_loads_the_arm_as_it_says(arm: Arm) -> None:
    table = carrying(arm, LOADS, LOADS)
    (placed,) = [p for p in payload_errors(table, [drive(arm, table)]) if p.variant == "carried"]
    assert PAYLOAD_ERROR.cure.statement is not None
    wrong = PAYLOAD_ERROR.cure.statement(Part(placed, np.array([GRIPPER_KG])))
    loaded = Scene(arm, table).loaded_as(wrong)
    np.testing.assert_allclose(loaded.payload, LOADS + GRIPPER_KG * (LOADS > 0))
    torque = Driver("torque", (2,))
    more = Scene(arm, table).driver(Driver("both", (Driver("heavier", (torque,)), Driver("carrying"))))
    np.testing.assert_allclose(GRIPPER_KG * more, loaded.driver(torque) - Scene(arm, table).driver(torque), atol=1e-9)
