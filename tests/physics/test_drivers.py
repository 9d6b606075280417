"""What effects follow, against what it is by definition: virtual work, a closed linkage, a table's own columns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.physics.drift import base_shift
from armscope.physics.drivers import KINDS, follows
from armscope.physics.effect import Part
from armscope.physics.geometric import PARALLELOGRAM_GEOMETRY
from armscope.physics.linkage_drivers import BARS
from armscope.physics.load_drivers import LOADS
from armscope.physics.loaded_arm import Misstated
from armscope.physics.recorded_drivers import COLUMNS, RECORDED
from armscope.physics.scene import Scene
from armscope.physics.terms import Driver

from .scenes import ARMS, arm_named, full_table

STEP = 1e-6


def test_an_angle_beyond_the_range_of_a_curve_is_held_at_its_end_and_a_full_turn_away_is_the_same_place() -> None:
    arm = arm_named("six-axis")
    angles = np.array([1.5, 0.5, 3.0, 1.5 + 2 * np.pi, 1.2 - 2 * np.pi, 3.0 + 2 * np.pi])
    table = full_table(arm, len(angles), seed=6)
    table = replace(table, motor_angles=np.tile(angles[:, None], (1, arm.n_motors)))
    held = Scene(arm, table).driver(Driver("angle", (3, 1.0, 2.0)))
    np.testing.assert_allclose(held, [1.5, 1.0, 2.0, 1.5, 1.2, 2.0], atol=1e-12)
    np.testing.assert_array_equal(Scene(arm, table).driver(Driver("angle", (3,))), angles)


@pytest.mark.parametrize("name", ARMS)
def test_a_payloads_torque_is_the_work_that_gravity_does_on_it_per_turn_of_the_motor(name: str) -> None:
    arm = arm_named(name)
    table = full_table(arm, 20, seed=7)
    assert table.payload is not None
    loaded, empty = Scene(arm, table), Scene(arm, replace(table, payload=np.zeros(20)))
    torque = loaded.gravity_torques - empty.gravity_torques
    for j in range(arm.n_motors):
        turned = table.motor_angles + STEP * np.eye(arm.n_motors)[j]
        moved = Scene(arm, replace(table, motor_angles=turned)).nominal.tool - loaded.nominal.tool
        np.testing.assert_allclose(torque[:, j], table.payload * (moved @ arm.gravity) / STEP, atol=1e-3)


def test_a_payload_off_its_point_adds_its_weight_times_the_lever() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=8)
    off = np.array([0.1, -0.2, 0.05])
    stated, other = Scene(arm, table), Scene(arm, table, Misstated(payload_offset=off))
    assert table.payload is not None
    lever = stated.nominal.tool_rotation @ off
    last = np.cross(lever, table.payload[:, None] * arm.gravity)
    np.testing.assert_allclose(other.wrenches[1][:, -1] - stated.wrenches[1][:, -1], last, atol=1e-9)
    np.testing.assert_allclose(other.wrenches[0], stated.wrenches[0])


def test_a_load_grows_per_kilogram_as_it_does_when_the_table_says_one_kilogram_more() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=9)
    assert table.payload is not None
    torque = Driver("torque", (2,))
    more = Scene(arm, replace(table, payload=table.payload + 1.0)).driver(torque)
    scene = Scene(arm, table)
    np.testing.assert_allclose(scene.driver(Driver("heavier", (torque,))), more - scene.driver(torque), atol=1e-9)


def test_a_heavier_link_loads_as_one_of_that_mass_does() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=10)
    stated = Scene(arm, table)
    for link in (1, 3, 6):
        heavier = Scene(arm, table, Misstated(masses=0.2 * np.eye(6)[link - 1]))
        for found, expected in zip(stated.with_heavier_links((link,), 0.2).wrenches, heavier.wrenches, strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-9)


def test_a_heavier_payload_loads_as_one_of_that_weight_does_where_it_is_off_its_place_too() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=11)
    for offset in (None, np.array([0.1, -0.2, 0.05])):
        stated = Scene(arm, table, Misstated(payload_offset=offset))
        heavier = Scene(arm, table, Misstated(payload_kg=3.0, payload_share=0.2, payload_offset=offset))
        for found, expected in zip(stated.with_heavier_payload(3.0, 0.2).wrenches, heavier.wrenches, strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-9)


@pytest.mark.parametrize("axis", [0, 1])
def test_what_leaning_gravity_adds_to_a_load_is_what_it_does_to_an_arm_mounted_so(axis: int) -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=12)
    torque, scene = Driver("torque", (2,)), Scene(arm, table)
    leaning = scene.with_leaning_gravity(axis, 0.05)
    assert np.arccos(leaning.arm.gravity @ arm.gravity / 9.81**2) == pytest.approx(0.05)
    change = Scene(leaning.arm, table).driver(torque) - scene.driver(torque)
    np.testing.assert_allclose(leaning.driver(torque) - scene.driver(torque), change)
    np.testing.assert_allclose(
        0.05 * scene.driver(Driver("leaning", (torque, axis))), change, atol=0.05 * abs(change).max()
    )


def test_a_motor_without_load_is_on_no_side_of_its_gap() -> None:
    arm = arm_named("seven-axis")
    table = full_table(arm, 40, seed=5)
    scene = Scene(arm, table)
    unloaded = np.abs(scene.torques[:, 6]) < 1e-12  # nothing is off the last axis but a payload
    assert 0 < unloaded.sum() < len(table)
    side = scene.driver(Driver("load side", (7,)))
    assert not side[unloaded].any()
    np.testing.assert_array_equal(side[~unloaded], np.sign(scene.torques[~unloaded, 6]))


@pytest.mark.parametrize("bar", ["rod", "rocker"])
def test_a_bars_driver_is_the_slope_of_the_closed_linkage(bar: str) -> None:
    arm = arm_named("parallelogram-120kg")
    scene = Scene(arm, full_table(arm, 20, seed=10))
    (placed,) = PARALLELOGRAM_GEOMETRY.place(arm, scene.recordings)
    values = STEP * np.array([term.name == bar for term in placed.terms], dtype=float)
    assert PARALLELOGRAM_GEOMETRY.exact is not None
    ((_, turn),) = PARALLELOGRAM_GEOMETRY.exact(scene, Part(placed, values))
    slope = scene.driver(Driver(bar))
    np.testing.assert_allclose(slope, turn / STEP, rtol=1e-3)
    share = scene.driver(Driver(f"{bar} share", (scene.linkage.crank_angle,)))
    np.testing.assert_allclose(share, slope * scene.linkage.rocker)


def test_what_was_not_recorded_counts_nothing_and_a_missing_column_is_named() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=11)
    assert table.speed is not None
    table.speed[3] = np.nan
    speed = Scene(arm, table).driver(Driver("speed", (1,)))
    assert speed[3] == 0
    np.testing.assert_array_equal(np.delete(speed, 3), np.delete(table.speed[:, 0], 3))
    for column in COLUMNS:
        without = Scene(arm, replace(table, **{column: None}))
        kind = next((kind for kind, made in RECORDED.items() if made.needs == column), None)
        if kind is not None:
            arguments = {"approach": (1,), "speed": (1,), "hours": (0.0,), "after time": (0.0, "1")}.get(kind, ())
            with pytest.raises(InputError, match=COLUMNS[column].partition("_")[0]):
                without.driver(Driver(kind, arguments))


def test_loads_follow_loads_and_what_is_a_function_of_them_does_too() -> None:
    for kind in LOADS:
        assert follows("load", Driver(kind)) != (kind == "payload")
    assert not any(follows("load", Driver(kind)) for kind in (*BARS, *RECORDED))
    assert follows("load", Driver("spline", (Driver("torque", (1,)), 0.0, 1.0)))
    assert set(KINDS) > {*LOADS, *BARS, *RECORDED}


@pytest.mark.parametrize("ids", [[str(n) for n in range(1, 21)], ["a", *[str(100 * n) for n in range(2, 21)]]])
def test_a_jump_holds_from_its_row_on_though_only_some_ids_are_numbers(ids: list[str]) -> None:
    arm = arm_named("six-axis")
    table = replace(full_table(arm, 20, seed=12), id=np.array(ids), run=np.full(20, "1"), time=None)
    driver = base_shift(table, 7, 1).terms[0].products[0].driver
    np.testing.assert_array_equal(Scene(arm, table).driver(driver), np.arange(20) >= 7)
