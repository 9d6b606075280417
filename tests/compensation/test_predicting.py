"""A description predicts its own kinematics, in its base frame; a model where the arm is now."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.compensation.path import read_path
from armscope.compensation.physical import FILE, identified_on, save_identified
from armscope.compensation.predicting import predict_file
from armscope.core.inputs import InputError
from armscope.physics.carried_on import carried_on
from armscope.physics.drift import Pause, base_shift, drift_with_pauses
from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.model_file import save_model
from armscope.physics.registry import library
from armscope.physics.wander import wander
from armscope.recordings import read_recordings
from armscope.robot import forward_kinematics, load_arm

EXAMPLE = Path(__file__).parents[2] / "examples" / "five-effects"


def test_a_robot_yaml_predicts_its_kinematics():
    robot, poses = EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv"
    table, notes = predict_file(robot, poses)
    arm = load_arm(robot)
    points = forward_kinematics(arm, read_recordings(poses, arm.n_motors).motor_angles)
    np.testing.assert_allclose(table[["x_mm", "y_mm", "z_mm"]].to_numpy(), points * 1e3, atol=1e-9)
    assert notes == []


JUMP_MM = np.array([3.0, -2.0, 1.0])
JUMPED_AT = 30


@pytest.fixture
def jumped(tmp_path):
    """model.yaml of an arm whose base jumped at a row of a table without times; and the table."""
    rows = read_recordings(EXAMPLE / "recordings.csv")
    rows = rows.rows(rows.run == rows.run[0])
    table = rows.rows(slice(60))
    table = type(table)(table.motor_angles, table.positions, table.run, table.target, table.id, payload=table.payload)
    arm = load_arm(EXAMPLE / "robot.yaml")
    shift = base_shift(table, JUMPED_AT - 1, 1)
    values = np.zeros(len(shift.terms))
    values[:3] = JUMP_MM * 1e-3
    model = FittedModel(arm, {str(table.run[0]): Base(np.eye(3), np.zeros(3))}, parts=(Part(shift, values),))
    save_model(tmp_path / "model.yaml", model)
    return tmp_path / "model.yaml", table


def poses(path, table, ids):
    """A table of a model's poses as a user writes it."""
    columns = [f"q{motor}_rad" for motor in range(1, table.n_motors + 1)]
    lines = [",".join([*(["id"] if ids else []), "run", *columns])]
    for row in range(len(table)):
        cells = [*([table.id[row]] if ids else []), table.run[row], *map(repr, table.motor_angles[row].tolist())]
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n")
    return path


def test_poses_without_ids_are_of_now_after_every_jump(jumped, tmp_path):
    model, table = jumped
    nominal = forward_kinematics(load_arm(EXAMPLE / "robot.yaml"), table.motor_angles) * 1e3
    found, notes = predict_file(model, poses(tmp_path / "poses.csv", table, ids=False))
    np.testing.assert_allclose(found[["x_mm", "y_mm", "z_mm"]] - nominal, np.tile(JUMP_MM, (60, 1)), atol=1e-6)
    assert any("what jumped at a row of the recordings has jumped" in note for note in notes)


def test_poses_with_the_recordings_ids_are_of_their_rows(jumped, tmp_path):
    model, table = jumped
    nominal = forward_kinematics(load_arm(EXAMPLE / "robot.yaml"), table.motor_angles) * 1e3
    found, notes = predict_file(model, poses(tmp_path / "poses.csv", table, ids=True))
    moved = np.abs(found[["x_mm", "y_mm", "z_mm"]] - nominal).max(axis=1) > 1
    assert moved.tolist() == [row + 1 >= JUMPED_AT for row in range(60)]
    assert notes == ["ids are taken for rows of the recordings; without the column id, poses are of now"]


@pytest.mark.parametrize("name", [lambda n: f"P{n}", lambda n: str(61 - n), lambda n: "" if n == 1 else str(n)])
def test_ids_that_number_no_rows_are_told_to_be_counted(jumped, tmp_path, name):
    model, table = jumped
    named = replace(table, id=np.array([name(n) for n in range(1, 61)]))
    _, (note,) = predict_file(model, poses(tmp_path / "poses.csv", named, ids=True))
    assert "counted as the recordings' rows, from 1; without the column id, poses are of now" in note


def test_a_model_that_follows_no_rows_says_nothing_of_ids(jumped, tmp_path):
    _, table = jumped
    arm = load_arm(EXAMPLE / "robot.yaml")
    save_model(tmp_path / "still.yaml", FittedModel(arm, {str(table.run[0]): Base(np.eye(3), np.zeros(3))}))
    for ids in (True, False):
        assert predict_file(tmp_path / "still.yaml", poses(tmp_path / "poses.csv", table, ids))[1] == []


in_the_order_of_rows = pytest.mark.parametrize(
    "placed",
    [
        lambda table: drift_with_pauses([Pause(20.0, "a", 500.0)], 1),
        lambda table: wander(table, [])[1],
    ],
)


@in_the_order_of_rows
def test_what_wanders_in_the_order_of_rows_stays_as_the_last_row_of_a_run_found_it(jumped, tmp_path, placed):
    """With its pauses, and with the means that are taken from it run by run."""
    table = replace(jumped[1], run=np.repeat(["a", "b"], [20, 40]))
    arm = load_arm(EXAMPLE / "robot.yaml")
    effect = placed(table)
    part = Part(effect, np.full(len(effect.terms), 1e-2))
    base = Base(np.eye(3), np.zeros(3))
    model = carried_on(FittedModel(arm, {"a": base, "b": base}, parts=(part,)), table)
    save_model(tmp_path / "drift.yaml", model)
    found, notes = predict_file(tmp_path / "drift.yaml", poses(tmp_path / "poses.csv", table, ids=False))
    last = np.where(table.run == "a", table.number[19], table.number[59])
    then = 1e3 * predict(model, replace(table, number=last))
    np.testing.assert_allclose(found[["x_mm", "y_mm", "z_mm"]], then, atol=1e-6)
    assert np.abs(then - forward_kinematics(arm, table.motor_angles) * 1e3).max() > 1e-3
    assert notes[-1:] == ["no ids: what wanders in the order of rows stays as the last row found it"]


@in_the_order_of_rows
def test_a_file_that_does_not_say_where_a_wander_ended_leaves_it_out_of_now_as_a_whole(jumped, tmp_path, placed):
    """As files of earlier versions do."""
    table = replace(jumped[1], run=np.repeat(["a", "b"], [20, 40]))
    arm = load_arm(EXAMPLE / "robot.yaml")
    effect = placed(table)
    part = Part(effect, np.full(len(effect.terms), 1e-2))
    base = Base(np.eye(3), np.zeros(3))
    save_model(tmp_path / "drift.yaml", FittedModel(arm, {"a": base, "b": base}, parts=(part,)))
    nominal = forward_kinematics(arm, table.motor_angles) * 1e3
    for ids, moved in ((True, 1), (False, 0)):
        found, notes = predict_file(tmp_path / "drift.yaml", poses(tmp_path / "poses.csv", table, ids))
        assert (np.abs(found[["x_mm", "y_mm", "z_mm"]] - nominal).to_numpy().max() > 1e-6) == moved
    assert notes[-1:] == ["no ids: what wanders in the order of rows is left out"]


def test_poses_without_a_time_are_told_to_be_of_the_recordings_end(jumped, tmp_path):
    timed = replace(jumped[1], time=np.linspace(0.0, 7200.0, 60))
    arm, wave = load_arm(EXAMPLE / "robot.yaml"), wander(timed, [])[0]
    base = {str(timed.run[0]): Base(np.eye(3), np.zeros(3))}
    model = FittedModel(arm, base, parts=(Part(wave, np.full(len(wave.terms), 1e-3)),))
    save_model(tmp_path / "wave.yaml", model)
    found, notes = predict_file(tmp_path / "wave.yaml", poses(tmp_path / "poses.csv", timed, ids=False))
    at_the_end = predict(model, replace(timed, time=np.full(60, 7200.0)))
    np.testing.assert_allclose(found[["x_mm", "y_mm", "z_mm"]], 1e3 * at_the_end, atol=1e-6)
    assert notes == ["no time_s: what wanders in the course of time stays as at the end of the recordings"]


def test_a_path_is_of_now_whatever_its_ids_are(jumped, tmp_path):
    _, table = jumped
    arm = load_arm(EXAMPLE / "robot.yaml")
    path = read_path(poses(tmp_path / "path.csv", table, ids=True), arm)
    assert np.isnan(path.table.number).all()
    shift = Part(base_shift(table, JUMPED_AT - 1, 1), np.array([*JUMP_MM * 1e-3, 0, 0, 0]))
    model = FittedModel(arm, {str(table.run[0]): Base(np.eye(3), np.zeros(3))}, parts=(shift,))
    moved = predict(model, path.table) - forward_kinematics(arm, table.motor_angles)
    np.testing.assert_allclose(moved * 1e3, np.tile(JUMP_MM, (60, 1)), atol=1e-6)


def test_rows_without_a_payload_are_predicted_where_the_models_recordings_had_such_rows(tmp_path):
    rows = read_recordings(EXAMPLE / "recordings.csv")
    arm, payload = load_arm(EXAMPLE / "robot.yaml"), rows.payload.copy()
    payload[:60] = np.nan
    bare = replace(rows, payload=payload)
    placed = next(p for p in library(arm, rows) if p.key == ("joint_compliance", "joint 2"))
    values = np.full(len(placed.terms), 1e-7)
    model = FittedModel(arm, {str(rows.run[0]): Base(np.eye(3), np.zeros(3))}, parts=(Part(placed, values),))
    save_model(tmp_path / "model.yaml", model)
    path = poses(tmp_path / "poses.csv", bare.rows(slice(60)), ids=False)
    save_identified(tmp_path / FILE, identified_on(arm, rows))
    with pytest.raises(InputError, match="no column payload_kg"):
        predict_file(tmp_path / "model.yaml", path)
    save_identified(tmp_path / FILE, identified_on(arm, bare))
    found, notes = predict_file(tmp_path / "model.yaml", path)
    assert any("60 rows state no payload_kg: the arm carries nothing" in note for note in notes)
    empty = replace(rows, payload=np.zeros(len(rows))).rows(slice(60))
    expected = predict(model, empty) * 1e3
    np.testing.assert_allclose(found[["x_mm", "y_mm", "z_mm"]], expected, atol=1e-9)
