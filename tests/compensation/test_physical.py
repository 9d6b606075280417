"""What physics needs beside its parameters: joint torques where they were recorded, and speed on long paths."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope.compensation.compensate import compensate_black_box, compensate_physical
from armscope.compensation.path import as_path
from armscope.compensation.physical import (
    drivers_of,
    identified_on,
    load_identified,
    missing_context,
    save_identified,
    with_torques,
)
from armscope.compensation.task import Options
from armscope.physics.effect import Driver, Part
from armscope.physics.model import Base, FittedModel
from armscope.physics.registry import library
from armscope.robot import chain
from armscope.robot.gravity import gravity_torques
from tests.physics.scenes import arm_named, full_table

from .arms import CONTEXT, MIDDLE, black_box, physical, physical_path, sk120, table_of, wanted_points


def test_torques_of_a_path_come_from_those_recorded_not_from_wrong_masses():
    arm = arm_named("six-axis")
    rows = full_table(arm, 150, 2)

    def true_torque(table):
        """The arm is really heavier than its description says, by half."""
        heavier = replace(arm, masses=1.5 * arm.masses)
        return gravity_torques(heavier, chain(arm, table.motor_angles), table.payload)

    recorded = replace(rows, torque=true_torque(rows))
    placed = next(p for p in library(arm, recorded) if p.key == ("joint_compliance", "joint 2") and p.driver)
    model = FittedModel(arm, {"": Base(np.eye(3), np.zeros(3))}, (), (Part(placed, np.array([1e-6])),))
    assert "torque" in drivers_of(model)
    fresh = full_table(arm, 40, 9)
    filled, note = with_torques(model, identified_on(arm, recorded), fresh, fresh.motor_angles)
    assert "fitted to the recorded ones" in note
    np.testing.assert_allclose(filled.torque, true_torque(fresh), atol=1e-6 * np.abs(filled.torque).max())
    none_recorded, silent = with_torques(model, identified_on(arm, rows), fresh, fresh.motor_angles)
    assert (none_recorded.torque, silent) == (None, "")


def test_what_gives_way_without_a_name_asks_for_its_load_too():
    model, identified = physical()
    loaded = next(part for part in model.parts if part.placed.effect.name == "joint_compliance")
    unnamed = replace(model, parts=(), tools=(), background=(loaded,))
    assert "torque" in drivers_of(unnamed)
    bare = as_path(table_of(physical_path(6)[0]), "path", model.arm).table
    assert list(missing_context(unnamed, identified, bare)) == ["payload_kg"]


@pytest.mark.parametrize(
    ("kind", "column"),
    [("warmth", "temperature_c"), ("approach", "approach"), ("speed", "dq_rad_s"), ("hours", "time_s"),
     ("moment", "payload_kg")],
)  # fmt: skip
def test_every_kind_of_context_is_asked_for_by_the_effects_that_follow_it(kind, column):
    model, identified = physical()
    part = model.parts[0]
    term = part.placed.terms[0]
    driver = Driver("spline", (Driver(kind, ("joint 2", 0)[: 1 + (kind == "moment")]), 0.0, 1.0))
    terms = (replace(term, products=(replace(term.products[0], driver=driver),)),)
    only = replace(model, parts=(Part(replace(part.placed, terms=terms), part.values[:1]),), tools=())
    bare = as_path(table_of(physical_path(6)[0]), "path", model.arm).table
    assert list(missing_context(only, identified, bare)) == [column]


@pytest.mark.long
def test_ten_thousand_points_are_reached_every_one():
    model, identified = physical()
    points, middle = physical_path(10_000)
    path = as_path(table_of(points, **CONTEXT), "path", model.arm)
    ours = as_path(table_of(wanted_points(10_000)), "path", sk120())
    assert compensate_physical(model, identified, path, Options(start_rad=middle)).reached.all()
    assert compensate_black_box(black_box(), ours, Options(start_rad=MIDDLE)).reached.all()


def test_where_on_the_tool_one_measured_is_no_error_of_the_arm():
    """A robot.yaml without tool_mm, a reflector 0.2 m beside the flange: an arm without errors keeps its commands."""
    model, identified = physical()
    (tool,) = model.tools
    without = replace(model, parts=(), tools=(replace(tool, values=np.array([0.15, -0.1, 0.1])),))
    angles = identified.domain.mean[:6] + np.linspace(-0.05, 0.05, 9)[:, None]
    table = pd.DataFrame({f"q{j}_rad": angle for j, angle in enumerate(angles.T, start=1)}).assign(**CONTEXT)
    result = compensate_physical(without, identified, as_path(table, "path", model.arm), Options())
    np.testing.assert_allclose(result.commands, angles, atol=1e-8)
    np.testing.assert_allclose(result.false_targets, chain(model.arm, angles).tool, atol=1e-8)


def test_context_that_no_row_holds_was_never_recorded():
    arm = arm_named("six-axis")
    rows = full_table(arm, 60, 2)
    empty = np.full(60, np.nan)
    none = identified_on(arm, replace(rows, payload=empty, time=empty))
    assert none.to_dict() == identified_on(arm, replace(rows, payload=None, time=None)).to_dict()


def test_how_well_rows_that_took_no_part_were_met_travels_with_the_model(tmp_path):
    _, known = physical()
    assert known.held_out_mm is None
    save_identified(tmp_path / "domain.json", replace(known, held_out_mm=0.05))
    assert load_identified(tmp_path / "domain.json").held_out_mm == 0.05
    save_identified(tmp_path / "domain.json", known)
    assert load_identified(tmp_path / "domain.json").held_out_mm is None


def test_that_many_rows_fit_nothing_travels_with_the_model_and_is_told_of_its_commands(tmp_path):
    """Play of an unknown side: 0.14 mm were told, those of the other branch left out, and 0.98 mm reached."""
    model, known = physical()
    save_identified(tmp_path / "domain.json", replace(known, held_out_mm=0.58, many_fit_nothing=True))
    many = load_identified(tmp_path / "domain.json")
    assert many.many_fit_nothing
    path = as_path(table_of(physical_path(6)[0], **CONTEXT), "path", model.arm)
    for identified, doubted in ((many, True), (replace(many, many_fit_nothing=False), False)):
        notes = " ".join(compensate_physical(model, identified, path).notes)
        assert "were missed by 0.58 mm" in notes
        assert ("fit nothing of this model" in notes) == doubted


def test_a_drift_is_not_continued_into_another_day():
    model, identified = physical()
    part = model.parts[0]
    term = part.placed.terms[0]
    drift = (replace(term, products=(replace(term.products[0], driver=Driver("hours", (0.0,))),)),)
    drifting = replace(model, parts=(Part(replace(part.placed, terms=drift), part.values[:1]),))
    points, middle = physical_path(4)
    first, last = identified.time_s
    table = table_of(points, **CONTEXT, time_s=[first, last, last + 0.05 * (last - first), last + 86400])
    path = as_path(table, "path", model.arm)
    said = compensate_physical(drifting, identified, path, Options(start_rad=middle)).reasons
    assert said[:3].tolist() == [""] * 3
    assert "time_s" in said[3]
    assert set(compensate_physical(model, identified, path, Options(start_rad=middle)).reasons) == {""}
