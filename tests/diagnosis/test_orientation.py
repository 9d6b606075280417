"""Measured orientations: the same arm must explain how the tool is turned, weighed by its own noise."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.diagnosis import Settings, diagnose
from armscope.fitting.linearisation import residuals
from armscope.fitting.registration import fit_frames
from armscope.physics.model_file import load_model, save_model
from armscope.recordings import Recordings, read_recordings
from armscope.robot import Arm, load_arm
from armscope.robot.arm import build_arm
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.schema import Verdict
from tests.seeds import seeds

from ..physics.scenes import arm_named
from .planted import Wanted, joined, one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
IIWA = Path(__file__).parents[3] / "shared" / "recordings" / "iiwa7-payload"
POINT_MM, TURN_MRAD = 0.02, 0.1


def oriented(
    name: str, wanted: Wanted, rows: int = 90, seed: int = 3, held: tuple[int, ...] = ()
) -> tuple[Arm, Recordings]:
    """An arm whose points and orientations were measured; motors ``held`` (from 1) stand still."""
    arm = arm_named(name)
    table = one_run(arm, rows, seed)
    for motor in held:
        table.motor_angles[:, motor - 1] = 0.3
    return arm, recorded(arm, table, wanted, POINT_MM, seed + 1, turn_noise_mrad=TURN_MRAD)


def names(verdict: Verdict) -> set[tuple[str, str]]:
    return {(effect.effect, effect.location) for effect in verdict.effects}


def without(table: Recordings) -> Recordings:
    return replace(table, orientation=None)


@pytest.fixture(scope="module")
def with_turns() -> Diagnosis:
    """Of a joint's zero, points and orientations."""
    return diagnose(*oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]}), QUICK)


@pytest.fixture(scope="module")
def without_turns() -> Diagnosis:
    """Of the same points alone, held out as well."""
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]})
    return diagnose(arm, without(table), replace(QUICK, cross_validation=True))


def test_a_tool_that_is_turned_anyhow_on_the_flange_is_found_from_nothing() -> None:
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 40, seed=2), {}, 0.0, seed=7, far=True, turn_noise_mrad=0.0)
    left = residuals(fit_frames(arm, table), table)
    assert np.abs(left["orientation"]).max() < 1e-7


@pytest.mark.parametrize("seed", seeds(1, 2, 3, 4))
def test_a_true_arm_with_noisy_orientations_misses_nothing(seed: int) -> None:
    verdict = diagnose(*oriented("four-axis", {}, seed=10 * seed), QUICK)
    assert verdict.answer == "nothing missing"
    assert names(verdict) == set()


@pytest.mark.long
def test_a_turn_counts_beside_a_shift_by_the_ratio_of_their_noises(with_turns: Diagnosis) -> None:
    seen = with_turns.orientations
    assert seen is not None
    assert seen.rows == 90
    assert seen.noise_mrad == pytest.approx(TURN_MRAD, rel=0.06)
    assert seen.lever_mm == pytest.approx(1e3 * POINT_MM / TURN_MRAD, rel=0.1)
    assert seen.before_mrad > 1.3 * seen.noise_mrad


def seen_from_one_side(table: Recordings, seed: int, bent: float) -> Recordings:
    """Orientations that err by a milliradian with the side that the tool turns to the instrument, by own formulas."""
    rng = np.random.default_rng(seed)
    turns = Rotation.from_quat(table.quaternions, scalar_first=True)
    side = turns.inv().apply(rng.normal(size=3))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    error = side @ rng.normal(size=(3, 3)) + bent * side * np.roll(side, 1, axis=1)
    error *= 1e-3 / np.sqrt(np.mean(error**2))
    return replace(table, orientation=(turns * Rotation.from_rotvec(error)).as_quat(scalar_first=True))


@pytest.mark.long
@pytest.mark.parametrize(("seed", "bent"), [pytest.param(0, 0.0, marks=pytest.mark.long), (1, 1.5)])
def test_what_goes_with_the_side_that_is_seen_is_the_instruments(seed: int, bent: float) -> None:
    """On a smooth path neighbouring attitudes err alike: that was told as up to eight jumps of the tool."""
    arm = arm_named("six-axis")
    table, rng = one_run(arm, 200, seed), np.random.default_rng(seed)
    course = np.outer(np.linspace(0, 2 * np.pi, 200), rng.uniform(1, 4, 6)) + rng.uniform(0, 6, 6)
    table.motor_angles[:] = table.motor_angles.mean(0) + 1.4 * table.motor_angles.std(0) * np.sin(course)
    wanted: Wanted = {("joint_offset", "joint 3"): [4e-4]}
    table = recorded(arm, table, wanted, POINT_MM, seed + 1, turn_noise_mrad=TURN_MRAD)
    verdict = diagnose(arm, seen_from_one_side(table, seed, bent), QUICK)
    assert names(verdict) == {("joint_offset", "joint 3")}
    assert verdict.orientations is not None
    assert verdict.orientations.instrument_mrad == pytest.approx(1.0, rel=0.1)
    assert verdict.orientations.noise_mrad == pytest.approx(TURN_MRAD, rel=0.1)


def test_orientations_without_such_errors_have_none(with_turns: Diagnosis) -> None:
    assert with_turns.orientations is not None
    assert with_turns.orientations.instrument_mrad == 0


@pytest.mark.long
def test_what_hardly_moves_the_point_shows_in_the_turn() -> None:
    """The tool point lies nearly on the last axis: what its gear does is seen by orientations alone."""
    wave: Wanted = {("gear_eccentricity", "joint 6"): [1.2e-3, 0.0]}
    arm = arm_named("six-axis")
    on_axis = build_arm(arm.description.model_copy(update={"tool_mm": (0.0, 0.0, 80.0)}))
    table = recorded(on_axis, one_run(arm, 90, 3), wave, POINT_MM, 5, turn_noise_mrad=TURN_MRAD)
    assert ("gear_eccentricity", "joint 6") not in names(diagnose(on_axis, without(table), QUICK))
    verdict = diagnose(on_axis, table, QUICK)
    assert names(verdict) == {("gear_eccentricity", "joint 6")}
    amplitude = verdict.effects[0].parameters[0]
    assert abs(amplitude.value - 1.2e-3) < 3 * amplitude.stderr


@pytest.mark.long
def test_two_springs_about_parallel_axes_are_told_more_sharply_with_turns() -> None:
    """Only two joints move: joints 2 and 4 bend the arm under nearly one load, about parallel axes."""
    springs: Wanted = {("joint_compliance", "joint 2"): [6e-5], ("joint_compliance", "joint 4"): [6e-5]}
    arm, table = oriented("seven-axis", springs, rows=200, held=(3, 4, 5, 6, 7))
    found, alone = (
        {e.location: e.parameters[0] for e in diagnose(arm, rows, QUICK).effects if e.family == "elastic"}
        for rows in (table, without(table))
    )
    assert set(found) == {"joint 2", "joint 4"}
    for location, parameter in found.items():
        assert abs(parameter.value - 6e-5) < 3 * parameter.stderr
        assert parameter.stderr < alone[location].stderr


@pytest.mark.long
def test_orientations_of_some_rows_only_are_used_where_they_are() -> None:
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]})
    assert table.orientation is not None
    table.orientation[::2] = np.nan
    verdict = diagnose(arm, table, QUICK)
    assert names(verdict) == {("joint_offset", "joint 3")}
    assert verdict.orientations is not None
    assert verdict.orientations.rows == 45


@pytest.mark.long
def test_wild_orientations_do_not_drag_the_model() -> None:
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]})
    assert table.orientation is not None
    wild = table.orientation.copy()
    turns = Rotation.from_rotvec([[0.02, 0, 0], [0, 0.5, 0], [0, 0, 3.0]])
    wild[[3, 50, 80]] = (turns * Rotation.from_quat(wild[[3, 50, 80]], scalar_first=True)).as_quat(scalar_first=True)
    verdict = diagnose(arm, replace(table, orientation=wild), QUICK)
    assert names(verdict) == {("joint_offset", "joint 3")}
    value = verdict.effects[0].parameters[0]
    assert abs(value.value - 4e-4) < 3 * value.stderr


@pytest.mark.long
def test_orientations_in_another_order_are_told_and_left_out(without_turns: Diagnosis) -> None:
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]})
    assert table.orientation is not None
    verdict = diagnose(arm, replace(table, orientation=table.orientation[:, [1, 2, 3, 0]]), QUICK)
    assert [notice.kind for notice in verdict.notices].count("orientations not the arm's") == 1
    assert verdict.orientations is None
    assert verdict.effects[0].parameters == without_turns.effects[0].parameters


@pytest.mark.long
def test_positions_can_be_asked_for_alone(without_turns: Diagnosis) -> None:
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]})
    asked = diagnose(arm, table, replace(QUICK, orientation=False))
    assert asked.orientations is None
    assert asked.effects[0].parameters == without_turns.effects[0].parameters


@pytest.mark.long
def test_a_tool_put_on_again_turned_is_free_in_every_run() -> None:
    """Its point is where it was: only the orientations show it."""
    arm = arm_named("four-axis")
    offset: Wanted = {("joint_offset", "joint 3"): [4e-4]}
    poses = [one_run(arm, 80, seed) for seed in (2, 3)]
    first, second = (
        recorded(arm, table, offset, POINT_MM, 7 + n, turn_noise_mrad=TURN_MRAD) for n, table in enumerate(poses)
    )
    verdict = diagnose(arm, joined(first, second), QUICK)
    told = [notice.text for notice in verdict.notices if notice.kind == "tool exchanged"]
    assert len(told) == 1
    assert "degrees" in told[0]
    assert "mm" not in told[0]
    assert names(verdict) == {("joint_offset", "joint 3")}


@pytest.mark.long
def test_a_tool_that_turned_on_the_flange_in_between_is_found_with_its_row() -> None:
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]}, rows=200)
    assert table.orientation is not None
    late = np.arange(200) >= 120
    turn = Rotation.from_rotvec([0.0, 5e-4, 0.0])
    turned = Rotation.from_quat(table.orientation, scalar_first=True)
    moved = np.where(late[:, None], (turned * turn).as_quat(scalar_first=True), table.orientation)
    verdict = diagnose(arm, replace(table, orientation=moved), QUICK)
    assert names(verdict) == {("joint_offset", "joint 3"), ("tool_shift", "tool")}


@pytest.mark.long
def test_held_out_orientations_become_as_good_as_their_noise(without_turns: Diagnosis) -> None:
    arm, table = oriented("four-axis", {("joint_offset", "joint 3"): [1e-3]})
    held_out = diagnose(arm, table, replace(QUICK, cross_validation=True)).held_out
    assert held_out.turn_before > 2 * TURN_MRAD
    assert held_out.turn_after < 1.15 * TURN_MRAD
    assert np.isnan(without_turns.held_out.turn_after)
    assert without_turns.to_json()["orientation"] is None


def test_the_model_keeps_how_the_tool_is_turned(with_turns: Diagnosis, tmp_path: Path) -> None:
    _, table = oriented("four-axis", {("joint_offset", "joint 3"): [4e-4]})
    save_model(tmp_path / "model.yaml", with_turns.model)
    again = residuals(load_model(tmp_path / "model.yaml"), table)
    assert 1e3 * np.sqrt(np.mean(again["orientation"] ** 2)) == pytest.approx(TURN_MRAD, rel=0.1)


@pytest.mark.long
@pytest.mark.shared
@pytest.mark.skipif(not IIWA.is_dir(), reason=f"../shared/recordings/{IIWA.name} is not here")
def test_orientations_of_a_real_arm_show_that_its_marker_was_taken_off_between_runs() -> None:
    """README: base and marker must be fitted per run. Points alone take it for shifts, which carry over to no run."""
    arm = load_arm(IIWA / "robot.yaml")
    table = read_recordings(IIWA / "recordings.csv.gz", arm.n_motors)
    table = table.rows(np.char.startswith(table.run, "2016-12-16"))
    settings = Settings(resamples=0)
    alone, both = (diagnose(arm, table, replace(settings, orientation=o)) for o in (False, True))
    assert "tool exchanged" in {notice.kind for notice in both.notices}
    assert both.held_out.after < 0.3 * alone.held_out.after
    assert both.held_out.turn_after < 0.5 * both.held_out.turn_before
