"""What a model does at times and temperatures that its recordings do not hold."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.compensation.known_range import beyond_recorded, beyond_time, held_in_time, over_time
from armscope.compensation.physical import FILE, Identified, identified_on, save_identified
from armscope.compensation.predicting import predict_file
from armscope.physics.drift import BASE_DRIFT
from armscope.physics.effect import Part
from armscope.physics.freeform import UNKNOWN, held
from armscope.physics.model import Base, FittedModel
from armscope.physics.model_file import save_model
from armscope.recordings import Recordings
from armscope.robot import Arm

from ..physics.scenes import arm_named, full_table

LAST_S, ROWS, DAY_S = 3600.0, 60, 86_400.0
MM_PER_HOUR = 0.3


def recorded() -> tuple[Arm, Recordings]:
    """An hour of rows."""
    arm = arm_named("six-axis")
    table = full_table(arm, ROWS, seed=2)
    warm = np.linspace(20, 30, ROWS)
    return arm, replace(table, time=np.linspace(0, LAST_S, ROWS), temperature=warm, run=np.full(ROWS, "1"))


def model_of(kind: str) -> tuple[FittedModel, Identified, Recordings]:
    """A base that drifts along x, or a joint's zero that goes up all the time, as a curve."""
    arm, table = recorded()
    effect = BASE_DRIFT if kind == "drift" else UNKNOWN
    placed = next(
        p
        for p in effect.place(arm, table)
        if p.location == ("base" if kind == "drift" else "joint 3") and p.variant == ("" if kind == "drift" else kind)
    )
    values = np.zeros(len(placed.terms))
    names = [each.name for each in placed.terms]
    values[names.index("x" if kind == "drift" else "trend")] = 1e-3 * MM_PER_HOUR
    model = FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, parts=(Part(held(placed, table), values),))
    return model, identified_on(arm, table), table


def predicted(tmp_path: Path, model: FittedModel, identified: Identified, rows: Recordings) -> tuple[np.ndarray, str]:
    """Points (N, 3), mm, as `armscope predict` writes them for a table, and its notes."""
    save_model(tmp_path / "model.yaml", model)
    save_identified(tmp_path / FILE, identified)
    assert rows.time is not None
    assert rows.temperature is not None
    columns = np.column_stack([rows.motor_angles, rows.time, rows.temperature])
    head = ",".join([*(f"q{j}_rad" for j in range(1, 7)), "time_s", "temperature_c"])
    lines = [head, *(",".join(map(repr, row)) for row in columns.tolist())]
    (tmp_path / "poses.csv").write_text("\n".join(lines) + "\n")
    table, notes = predict_file(tmp_path / "model.yaml", tmp_path / "poses.csv")
    return table[["x_mm", "y_mm", "z_mm"]].to_numpy(), " ".join(notes)


@pytest.mark.parametrize(("kind", "name"), [("drift", "base drift at base"), ("time", "unknown at joint 3")])
def test_what_moves_with_the_time_stands_still_after_the_recordings_and_that_is_said(
    tmp_path: Path, kind: str, name: str
) -> None:
    """It was continued without a word: five millimetres on the day after, where a third of one had been seen."""
    model, identified, table = model_of(kind)
    at_the_end = replace(table, time=np.full(ROWS, LAST_S))
    points, notes = predicted(tmp_path, model, identified, at_the_end)
    assert "time_s" not in notes
    at_the_start, _ = predicted(tmp_path, model, identified, replace(table, time=np.zeros(ROWS)))
    assert np.abs(points - at_the_start).max() > 0.2 * MM_PER_HOUR
    later = replace(table, time=np.where(np.arange(ROWS) < 20, LAST_S, LAST_S + DAY_S))
    points_later, notes = predicted(tmp_path, model, identified, later)
    np.testing.assert_allclose(points_later, points, atol=1e-9)
    assert "40 of 60 rows are at time_s 90000 to 90000" in notes
    assert name in notes
    assert "held as at the nearest end of the recordings (time_s 0 to 3600)" in notes


def test_a_drift_may_go_on_by_a_tenth_of_its_recordings_and_a_curve_may_not() -> None:
    """Commands by a curve of the time made rows just after the recordings three times as wrong."""
    for kind, allowed in (("drift", True), ("time", False)):
        model, identified, table = model_of(kind)
        soon = replace(table, time=np.full(ROWS, 1.05 * LAST_S))
        assert bool(beyond_time(model, identified, soon).any()) != allowed
        assert beyond_time(model, identified, replace(table, time=np.full(ROWS, 1.2 * LAST_S))).all()
        assert not beyond_time(model, identified, table).any()
        assert held_in_time(model, identified, table) == (table, [])


def test_what_follows_no_time_is_known_at_all_times() -> None:
    model, identified, table = model_of("temperature")
    assert over_time(model) == []
    assert not beyond_time(model, identified, replace(table, time=np.full(ROWS, DAY_S))).any()


def test_a_curve_of_the_temperature_is_held_beyond_what_was_recorded_and_that_is_said(tmp_path: Path) -> None:
    model, identified, table = model_of("temperature")
    warmest, notes = predicted(tmp_path, model, identified, replace(table, temperature=np.full(ROWS, 30.0)))
    assert "range" not in notes
    hot, notes = predicted(tmp_path, model, identified, replace(table, temperature=np.full(ROWS, 60.0)))
    np.testing.assert_allclose(hot, warmest, atol=1e-9)
    assert "60 of 60 rows are outside the range of the model's recordings (most of all by temperature_c)" in notes
    assert "unknown at joint 3 held" in notes


def test_poses_beyond_the_recorded_angles_are_told() -> None:
    model, identified, table = model_of("drift")
    assert beyond_recorded(model, identified, table) == []
    far = replace(table, motor_angles=table.motor_angles * np.where(np.arange(6) == 0, 4.0, 1.0))
    (note,) = beyond_recorded(model, identified, far)
    assert "by q1" in note
    assert "the model is continued" in note
