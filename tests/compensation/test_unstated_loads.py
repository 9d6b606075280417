"""Loads that recorded runs carried and nobody stated are in no command: what an arm will carry is what is stated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.compensation.compensate import compensate_physical
from armscope.compensation.path import as_path
from armscope.compensation.physical import identified_on
from armscope.compensation.task import Options
from armscope.physics.effect import Part
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.payload_change import carrying_as_stated, payload_changes
from armscope.robot import chain

from ..physics.scenes import arm_named, full_table
from .keeping import table_of


def test_commands_are_for_the_stated_load_and_say_so() -> None:
    arm = arm_named("six-axis")
    table = replace(full_table(arm, 40, seed=3), run=np.repeat(["1", "2"], 20), payload=None, time=None)
    table = replace(table, temperature=None, approach=None, torque=None)
    soft = next(p for p in JOINT_COMPLIANCE.place(arm, table) if p.location == "joint 2" and not p.variant)
    drive = Part(soft, np.array([2e-6]))
    (carried,) = payload_changes(table, [drive])
    bases = dict.fromkeys(("1", "2"), Base(np.eye(3), np.zeros(3)))
    model = FittedModel(arm, bases, (), (drive, Part(carried, np.array([6.0]))))
    rows = replace(table, positions=predict(model, table))
    angles = table.motor_angles[:10]
    columns = {f"q{j + 1}_rad": angles[:, j] for j in range(6)} | {"run": np.full(10, "2")}
    path = as_path(table_of(chain(arm, angles).tool, **columns), "path", arm)
    settings = Options(separate_points=True, allowed_outside=1.0)
    result = compensate_physical(model, identified_on(arm, rows), path, settings)
    empty_handed = compensate_physical(carrying_as_stated(model), identified_on(arm, rows), path, settings)
    np.testing.assert_array_equal(result.commands, empty_handed.commands)
    assert np.isfinite(result.commands).any()
    (note,) = [note for note in result.notes if note not in empty_handed.notes]
    assert "+6 kg in run 2 alone" in note
    assert "payload_kg" in note
