"""A load that is picked up or put down while the recording goes on: told with its moments, or not where none is."""

from __future__ import annotations

import re
from copy import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.motion_changing_load import World, said

from armscope.core.types import Array
from armscope.motion.library.changes_catalogue import LOAD_CHANGE
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.model.file import load_motion_model, save_motion_model
from armscope.motion.pipeline import MotionDiagnosis, diagnose_motion
from armscope.motion.predicting import torque_of_rows, torque_table
from armscope.motion.summary.tenable import tenable
from armscope.recordings.motions import Motions, as_motions
from armscope.robot.description import RobotDescription
from armscope.robot.dynamics import build_moving_arm
from tests.seeds import seeds


def rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def diagnosed(world: World) -> tuple[MotionDiagnosis, Motions]:
    arm = build_moving_arm(RobotDescription.model_validate(world.stated()))
    motions = as_motions(world.recorded(), "motions.csv", world.n)
    return diagnose_motion(arm, motions), motions


@pytest.fixture(scope="module")
def picked_up() -> tuple[World, MotionDiagnosis, Motions]:
    """In the last third of its only run."""
    world = World("from", 3, 28, by_points=True, wrong=0.05)
    world.moments = (12.4,)
    return world, *diagnosed(world)


@pytest.mark.long
def test_what_is_picked_up_is_told_with_its_moment_and_size(
    picked_up: tuple[World, MotionDiagnosis, Motions],
) -> None:
    world, found, _ = picked_up
    assert said(world, found.verdict)[0], said(world, found.verdict)[1]
    (cause,) = found.verdict.effects
    assert "from 12.4" in found.verdict.headline
    assert "more than stated" in found.verdict.headline
    assert "payload_kg" in cause.cure
    assert "12.4" in cause.cure
    assert found.verdict.held_out.what == "the first two fifths of the motion"
    assert found.verdict.held_out.model < 0.5 * found.verdict.held_out.background


@pytest.mark.long
def test_the_model_file_holds_it_and_a_prediction_elsewhere_says_that_it_does_not(
    picked_up: tuple[World, MotionDiagnosis, Motions], tmp_path: Path
) -> None:
    world, found, motions = picked_up
    save_motion_model(tmp_path / "model.yaml", found.model)
    model = load_motion_model(tmp_path / "model.yaml")
    whole, _ = torque_of_rows(model, motions)
    assert whole == pytest.approx(torque_of_rows(found.model, motions)[0])
    left = motions.effort - whole
    earlier, later = motions.time < world.moments[0] - 0.05, motions.time > world.moments[0] + 0.05
    assert rms(left[later]) < 1.3 * rms(left[earlier])
    table, notes = torque_table(model, motions)
    without = table[[f"tau{j + 1}_nm" for j in range(3)]].to_numpy()
    assert without[earlier] == pytest.approx(whole[earlier])
    missed, told = (np.median(np.abs(each[later, 1])) for each in (motions.effort - without, left))
    assert missed > 4 * told
    assert any("from 12.4" in note and "payload_kg" in note for note in notes)


@pytest.mark.long
def test_the_cure_done_as_worded_leaves_no_load_that_changes(picked_up: tuple[World, MotionDiagnosis, Motions]) -> None:
    """`payload_kg` from the moment on, and `tool_mm`, both read from the card's words."""
    world, found, motions = picked_up
    cure = found.verdict.effects[0].cure
    told = re.search(r"stated \+([0-9.]+) ± .* from ([0-9.]+) s on.*`tool_mm: \[(.+)\]`", cure)
    assert told, cure
    tool = [float(at) for at in told[3].replace("−", "-").split(",")]
    assert tool == pytest.approx(1e3 * world.at, abs=15)  # beside masses that are 5 % wrong
    arm = build_moving_arm(RobotDescription.model_validate({**world.stated(), "tool_mm": tool}))
    carried = np.where(motions.time >= float(told[2]), float(told[1]), 0.0)
    again = diagnose_motion(arm, replace(motions, payload=carried)).verdict
    assert not [each for each in again.effects if each.effect == "load_change"]
    never = copy(world)
    never.moments = ()
    assert again.held_out.background < 1.25 * diagnosed(never)[0].verdict.held_out.background


@pytest.mark.long
def test_no_mass_below_what_was_there_is_put_down(picked_up: tuple[World, MotionDiagnosis, Motions]) -> None:
    """The same selection on an arm whose last link, as it is stated, weighs less than what would have left it."""
    _, found, _ = picked_up
    layout = found.selected.rows.layout
    (number,) = found.selected.best.candidates
    assert layout.placed[number].cause is LOAD_CHANGE
    mass = found.selected.coefficients[layout.columns[number][0]]
    lighter = layout.arm.inertial.copy()
    lighter[20:30] *= 0.1 * mass / lighter[20]
    light = TorqueLayout(replace(layout.arm, inertial=lighter), layout.placed, layout.with_gains)
    down = replace(
        found.selected.rows, torque=2 * found.selected.rows.nominal - found.selected.rows.torque, layout=light
    )
    opposite = replace(found.selected, rows=down)
    opposite.__dict__["coefficients"] = -found.selected.coefficients
    assert number in tenable(found.selected, 250.0).best.candidates
    assert number not in tenable(opposite, 250.0).best.candidates


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(4, 5, 6))
def test_of_several_runs_the_one_in_which_it_changes_is_told(seed: int) -> None:
    world = World("between", 3 + seed % 4, seed, runs=3)
    found, _ = diagnosed(world)
    right, words = said(world, found.verdict)
    assert right, words
    assert "In run 3 from" in found.verdict.headline
    assert found.verdict.held_out.what.endswith("run 3, of whose own load no other run knows")


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(8, 2, 3, 5))
def test_a_load_that_comes_and_goes_is_one_cause_with_all_its_moments(seed: int) -> None:
    world = World("several", 3 + seed % 4, seed, runs=1 + 2 * (seed // 4 % 2))
    right, words = said(world, diagnosed(world)[0].verdict)
    assert right, words


@pytest.mark.parametrize("kind", seeds("none", "always"))
@pytest.mark.parametrize("seed", seeds(8, 1, 2, 3, 5))
def test_where_nothing_changes_nothing_is_said_to(kind: str, seed: int) -> None:
    world = World(kind, 3 + seed % 4, seed, by_points=seed % 2 == 0)
    right, words = said(world, diagnosed(world)[0].verdict)
    assert right, words
