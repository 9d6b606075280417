"""What tilts under what it carries: bearings softer about one axis, and bases that gravity does not pull upright."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Part, Placed
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.scene import Scene
from armscope.physics.tilting import (
    ABOUT_ITS_FOOT,
    BASE_COMPLIANCE,
    BEARING_COMPLIANCE,
    THREE_AXES,
    TWO_AXES,
    leans,
    stiffest_of_two,
)
from armscope.physics.uneven_bearing import uneven_bearings
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.robot.arm import build_arm
from tests.diagnosis.planted import Wanted, one_run, recorded
from tests.world.by_hand import HandArm

from .scenes import arm_named, full_table

ROWS = 20
ABOUT_X, ABOUT_Y, ACROSS = 3e-9, 1e-9, 0.4e-9


def moved(arm: Arm, table: Recordings, *parts: Part) -> Array:
    bases = {"1": Base(np.eye(3), np.zeros(3))}
    return predict(FittedModel(arm, bases, (), parts), table) - predict(FittedModel(arm, bases), table)


def of_one_run(arm: Arm) -> Recordings:
    return replace(full_table(arm, ROWS, seed=3), run=np.full(ROWS, "1"))


def on_a_wall(arm: Arm, gravity: tuple[float, float, float]) -> Arm:
    return build_arm(arm.description.model_copy(update={"gravity_m_s2": gravity}))


def of_variant(effects: list[Placed], variant: str, location: str) -> Placed:
    (one,) = [placed for placed in effects if placed.variant == variant and placed.location == location]
    return one


def test_a_bearing_about_two_axes_is_its_mean_and_by_how_much_it_is_uneven() -> None:
    arm = arm_named("six-axis")
    table = of_one_run(arm)
    bearings = list(BEARING_COMPLIANCE.place(arm, table))
    by_axes, even = (of_variant(bearings, variant, "joint 3") for variant in (TWO_AXES, ""))
    uneven = next(placed for placed in uneven_bearings(arm, table) if placed.location == "joint 3")
    assert [term.name for term in by_axes.terms] == ["compliance_x", "compliance_y", "compliance_xy"]
    one = moved(arm, table, Part(by_axes, np.array([ABOUT_X, ABOUT_Y, ACROSS])))
    mean, apart = np.array([(ABOUT_X + ABOUT_Y) / 2]), np.array([(ABOUT_X - ABOUT_Y) / 2, ACROSS])
    np.testing.assert_allclose(one, moved(arm, table, Part(even, mean), Part(uneven, apart)), rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("gravity", "names"),
    [
        ((9.81, 0.0, 0.0), ["y", "z", "xy", "xz", "yz"]),
        ((0.0, -6.94, -6.94), ["x", "y", "z", "xy", "xz", "yz"]),
    ],
)
def test_a_base_on_a_wall_turns_about_its_own_axis_too(gravity: tuple[float, float, float], names: list[str]) -> None:
    arm, by_hand = on_a_wall(arm_named("six-axis"), gravity), HandArm.named("six-axis")
    by_hand.gravity = np.array(gravity)
    table = of_one_run(arm)
    base = of_variant(list(BASE_COMPLIANCE.place(arm, table)), THREE_AXES, "base")
    assert [term.name for term in base.terms] == [f"compliance_{name}" for name in names]
    values = 1e-9 * np.arange(1, len(names) + 1)
    compliance = np.zeros((3, 3))
    for name, value in zip(names, values, strict=True):
        one, two = "xyz".index(name[0]), "xyz".index(name[-1])
        compliance[one, two] = compliance[two, one] = value
    points = forward_kinematics(arm, table.motor_angles)
    expected = [
        np.cross(compliance @ by_hand.moment(q, payload, np.zeros(3), 0), point)
        for q, payload, point in zip(table.motor_angles, table.payload, points, strict=True)
    ]
    np.testing.assert_allclose(moved(arm, table, Part(base, values)), expected, rtol=0, atol=1e-3 * np.ptp(expected))


def test_a_base_that_stands_upright_has_no_moment_about_its_axis() -> None:
    arm = arm_named("six-axis")
    table = of_one_run(arm)
    assert not leans(Scene(arm, table))
    assert {placed.variant for placed in BASE_COMPLIANCE.place(arm, table)} == {
        "",
        TWO_AXES,
        ABOUT_ITS_FOOT,
        f"{TWO_AXES}, {ABOUT_ITS_FOOT}",
    }


def test_the_stiffest_axis_is_the_smaller_principal_value_with_its_error() -> None:
    value, error = stiffest_of_two(np.array([3.0, 1.0, 0.0]), np.diag([0.1, 0.2, 0.3]) ** 2)
    assert (value, error) == pytest.approx((1.0, 0.2))


@pytest.mark.parametrize(("variant", "soft"), [("", [2e-9]), (TWO_AXES, [ABOUT_X, ABOUT_Y, ACROSS])])
def test_a_base_that_tilts_about_its_foot_moves_the_base_across_by_height_and_tilt(
    variant: str, soft: list[float]
) -> None:
    height = 0.8
    arm = arm_named("six-axis")
    table = of_one_run(arm)
    bases = list(BASE_COMPLIANCE.place(arm, table))
    about_origin = of_variant(bases, variant, "base")
    about_foot = of_variant(bases, f"{variant}, {ABOUT_ITS_FOOT}" if variant else ABOUT_ITS_FOOT, "base")
    assert about_foot.terms[: len(soft)] == about_origin.terms
    tilted = moved(arm, table, Part(about_origin, np.array(soft)))
    matrix = np.diag([*soft, *soft][:2])
    matrix += np.array([[0, 1], [1, 0]]) * (soft[2] if len(soft) > 2 else 0.0)
    moment = Scene(arm, table).moment("base")[:, :2]
    tilts = np.concatenate([moment @ matrix, np.zeros((ROWS, 1))], axis=1)
    across = moved(arm, table, Part(about_foot, np.array([*soft, *(height * np.array(soft))]))) - tilted
    np.testing.assert_allclose(across, np.cross(tilts, [0.0, 0.0, height]), atol=1e-3 * np.abs(across).max())


def test_a_pedestal_is_found_with_the_height_of_its_foot() -> None:
    arm = arm_named("six-axis")
    softness, height = 1e-8, 0.8
    wanted: Wanted = {("base_compliance", "base"): [softness, softness * height]}
    table = recorded(arm, one_run(arm, 250, 6), wanted, 0.02, 6)
    (found,) = diagnose(arm, table, Settings(resamples=0, cross_validation=False)).effects
    assert found.effect == "base_compliance"
    told = {p.name: p.interval for p in found.parameters}
    assert told["compliance"][0] < softness < told["compliance"][1]
    assert told["shift"][0] < softness * height < told["shift"][1]
