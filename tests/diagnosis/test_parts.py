"""The pieces of the pipeline one by one: curves, scatter, parameters, noise, folds, atlas, jumps, long tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.diagnosis import Settings, diagnose, selection
from armscope.diagnosis.held_out import split_rows
from armscope.diagnosis.summary.effect_curve import describe
from armscope.diagnosis.summary.parameters import parameters
from armscope.fitting.joint_scatter import find_scatter, motor_jacobians, whitening
from armscope.measurement import robust
from armscope.measurement.noise import known_noise, relative_uncertainty
from armscope.measurement.row_weights import whitened
from armscope.physics import loads
from armscope.physics.model import Base, FittedModel
from armscope.physics.registry import library

from ..physics.scenes import arm_named, full_table
from .planted import one_run, planted, recorded

QUICK = Settings(resamples=0, cross_validation=False)

AT = np.linspace(-1.5, 1.5, 361)
SHAPES = {
    "a trend in proportion": 3e-4 * AT,
    "a step at": 3e-4 * (AT > 0.4),
    "only beyond": 3e-4 * np.clip(AT - 0.5, 0, None),
    "only below": 3e-4 * np.clip(-0.5 - AT, 0, None),
    "a local bump at": 3e-4 * np.exp(-0.5 * ((AT - 0.3) / 0.15) ** 2),
}


@pytest.mark.parametrize("words", SHAPES)
def test_a_curve_is_described_by_its_shape(words: str) -> None:
    said = describe(AT, SHAPES[words], np.random.default_rng(1).uniform(-1.5, 1.5, 200))
    assert said.startswith(words), said


@pytest.mark.parametrize(("unit", "place"), [("rad", "29 deg"), ("N m", "0.5 N m"), ("", "0.5")])
def test_a_shape_is_told_in_the_units_of_its_driver(unit: str, place: str) -> None:
    at = np.linspace(0.0, 1.0, 321)
    said = describe(at, np.clip(at - 0.5, 0, None), np.random.default_rng(1).uniform(0, 1, 200), (), unit)
    assert said == f"only beyond {place}"


def test_a_wave_is_described_by_its_period_and_noise_by_nothing() -> None:
    assert describe(AT, np.cos(7 * AT), AT, ((7, 1.0),)) == "a wave, 7 per turn"
    assert describe(AT, np.random.default_rng(2).normal(size=361), AT).startswith("a free curve")


@given(st.floats(1e-6, 1e-2), st.floats(-3.1, 3.1))
@settings(max_examples=30, deadline=None)
def test_a_wave_is_told_as_amplitude_and_phase(amplitude: float, phase: float) -> None:
    arm = arm_named("six-axis")
    placed = next(p for p in library(arm, one_run(arm, 20, 1)) if p.name == "gear_eccentricity")
    values = amplitude * np.array([np.cos(phase), np.sin(phase)])
    told = parameters(placed, values, np.eye(2) * (1e-3 * amplitude) ** 2)
    assert told[0].value == pytest.approx(amplitude, rel=1e-6)
    assert told[1].value == pytest.approx(phase, abs=1e-6)
    assert told[0].stderr == pytest.approx(1e-3 * amplitude, rel=1e-3)
    assert told[1].stderr == pytest.approx(1e-3, rel=1e-3)


def test_a_wobble_is_told_as_amplitude_phase_and_direction() -> None:
    arm = arm_named("six-axis")
    placed = next(p for p in library(arm, one_run(arm, 20, 1)) if p.name == "axis_wobble")
    wave, direction = np.array([np.cos(0.7), np.sin(0.7)]), np.array([np.cos(-0.4), np.sin(-0.4)])
    told = parameters(placed, (2e-4 * np.outer(direction, wave)).reshape(-1), np.eye(4) * 1e-12)
    assert [p.value for p in told[:3]] == pytest.approx([2e-4, 0.7, -0.4], abs=1e-6)


def test_a_wobble_of_which_half_is_hidden_has_an_interval_that_holds_the_whole() -> None:
    """Tilts (cos d, sin d) cos(q - p): half of them turn with the joint, as a tool offset does, half against it."""
    arm = arm_named("six-axis")
    placed = next(p for p in library(arm, one_run(arm, 20, 1)) if p.name == "axis_wobble")
    whole = 2e-4 * np.outer([np.cos(0.3), np.sin(0.3)], [np.cos(0.9), np.sin(0.9)])
    turning = np.array([[1, 0, 0, 1], [0, -1, 1, 0]]) / np.sqrt(2)
    seen = whole.reshape(-1) - turning.T @ (turning @ whole.reshape(-1))
    covariance = (1e-6) ** 2 * np.eye(4) + (1e-4) ** 2 * turning.T @ turning
    amplitude = parameters(placed, seen, covariance)[0]
    assert amplitude.value == pytest.approx(1e-4, rel=0.01)
    low, high = amplitude.interval
    assert low < 2e-4 < high


def test_scatter_is_found_at_its_joint_and_noise_has_no_place() -> None:
    arm, table = planted("six-axis", {}, 150, 0.0, seed=3)
    moved = motor_jacobians(FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}), table)
    rng = np.random.default_rng(4)
    noise = 0.02 * rng.normal(size=(150, 3))
    assert find_scatter(noise, moved, 0.0) == []
    scattered = noise + 1e-4 * rng.choice([-1, 1], 150)[:, None] * moved[2]
    (found,) = find_scatter(scattered, moved, 0.0)
    assert found.motor == 3
    assert found.size == pytest.approx(1e-4, rel=0.6)
    turn = whitening([found], moved, 0.02)
    white = whitened(scattered, turn)
    assert np.sqrt(np.mean(white**2)) < 1.2 * 0.02 < 0.5 * np.sqrt(np.mean(scattered**2))


@pytest.mark.parametrize("share", [0.02, 0.06, 0.12])
def test_bad_shots_of_any_direction_are_no_scatter_and_hide_none(share: float) -> None:
    arm, table = planted("six-axis", {}, 150, 0.0, seed=3)
    moved = motor_jacobians(FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}), table)
    rng = np.random.default_rng(5)
    residuals = 0.02 * rng.normal(size=(150, 3))
    residuals[: round(share * 150)] += rng.normal(size=(round(share * 150), 3))
    assert find_scatter(residuals, moved, 0.0) == []
    residuals += 1e-4 * rng.choice([-1, 1], 150)[:, None] * moved[2]
    assert [found.motor for found in find_scatter(residuals, moved, 0.0)] == [3]


def test_heavy_tails_are_no_scatter() -> None:
    arm, table = planted("six-axis", {}, 150, 0.0, seed=3)
    moved = motor_jacobians(FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}), table)
    rng = np.random.default_rng(6)
    of_row = np.sqrt(4 / rng.chisquare(4, 150))
    assert find_scatter(0.02 * of_row[:, None] * rng.normal(size=(150, 3)), moved, 0.0) == []


def test_weights_leave_noise_alone_and_silence_what_is_far() -> None:
    rng = np.random.default_rng(6)
    residuals = rng.normal(size=(400, 3))
    residuals[7] = 30
    w = robust.quartic_weights(residuals, np.ones(400), 0.0)
    assert w[7] < 0.01
    assert np.mean(w[np.arange(400) != 7] == 1) > 0.99
    assert robust.scale_of(residuals) == pytest.approx(1, rel=0.1)


def test_noise_comes_from_the_robot_the_table_or_repeats() -> None:
    arm = arm_named("six-axis")
    table = recorded(arm, one_run(arm, 30, 2), {}, 0.02, seed=2)
    assert known_noise(arm, table).least_mm == 0
    twice = table.rows(np.repeat(np.arange(30), 3))
    twice.positions[:] += 2e-5 * np.random.default_rng(1).normal(size=twice.positions.shape)
    assert known_noise(arm, twice).least_mm == pytest.approx(0.8 * 0.02, rel=0.25)
    assert "repeated poses" in known_noise(arm, twice).source
    stated = replace(table, sigma=np.full((30, 3), 1e-5))
    assert known_noise(arm, stated).least_mm == pytest.approx(0.01)
    uneven = np.full((30, 3), 1e-5)
    uneven[4] = 5e-5
    relative = relative_uncertainty(replace(table, sigma=uneven), 0.01)
    assert relative[4] == pytest.approx(5)
    assert relative_uncertainty(replace(table, sigma=uneven), 1.0)[4] == pytest.approx(1, abs=0.01)


def test_targets_and_repeats_of_one_pose_are_never_split_between_folds() -> None:
    arm = arm_named("six-axis")
    table = one_run(arm, 60, 2).rows(np.tile(np.arange(30), 2))
    layout = split_rows(table, np.random.default_rng(0))
    assert layout.grouped_by == "configuration"
    np.testing.assert_array_equal(layout.of_row[:30], layout.of_row[30:])
    runs = replace(full_table(arm, 120, 2), run=np.repeat(["1", "2", "3"], 40))
    layout = split_rows(runs, np.random.default_rng(0))
    assert layout.grouped_by == "run"
    for run in "123":
        assert len(set(layout.fold[layout.of_row[runs.run == run]])) == 1


def test_the_atlas_shows_where_and_by_what() -> None:
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [1e-6]}, 100, 0.02, seed=9)
    atlas = diagnose(arm, table, QUICK).atlas
    assert atlas is not None
    cell = atlas.locations.index("joint 2"), atlas.directions.index("rz"), atlas.drivers.index("gravity load")
    assert atlas.share[cell] > 0.98
    assert np.nanmax(atlas.left) < 0.05
    assert np.nanmax(atlas.share[atlas.locations.index("joint 4")]) < 0.9


@pytest.mark.long
@pytest.mark.parametrize(
    ("robot", "effect", "place", "driver", "values"),
    [
        pytest.param("six-axis", "link_geometry", "link 2", "constant", [1e-3, -8e-4, 5e-4], marks=pytest.mark.long),
        # modified D-H rows
        pytest.param("seven-axis", "link_geometry", "link 4", "constant", [1e-3, -8e-4, 5e-4], marks=pytest.mark.long),
        ("four-axis", "link_bending", "link 2", "gravity load", [3e-6]),
        pytest.param("six-axis", "link_bending", "link 2", "gravity load", [3e-6], marks=pytest.mark.long),
        pytest.param("six-axis", "thermal_expansion", "link 2", "temperature", [3e-4], marks=pytest.mark.long),
        ("six-axis", "instrument_scale", "instrument", "constant", [4e-4]),
    ],
)
def test_the_atlas_shows_links_and_what_is_no_joint(
    robot: str, effect: str, place: str, driver: str, values: list[float]
) -> None:
    """What is planted there alone is explained there wholly, and no cell but its own explains all of it."""
    arm, table = planted(robot, {(effect, place): values}, 150, 0.02, seed=9)
    found = diagnose(arm, table, QUICK).atlas
    assert found is not None
    row, column = found.locations.index(place), found.drivers.index(driver)
    own = found.share[row, found.directions.index("together"), column]
    assert own > 0.97
    assert np.nanmax(found.left) < 0.06
    others = found.share.copy()
    others[row] = np.nan
    assert own > np.nanmax(others) - 0.03
    assert set(found.locations) >= {f"link {j}" for j in range(1, arm.n_joints + 1)}


@pytest.mark.parametrize(
    "ids",
    # of ids in order it is asked below as well, of a fainter jump; ids that are no numbers are in rows' order, too
    [
        *(pytest.param(ids, marks=pytest.mark.long) for ids in ("in order", "text")),
        "of a list of poses in another order",
    ],
)
def test_a_jump_of_the_base_is_found_with_its_row_whatever_ids_are(ids: str) -> None:
    arm, table = planted("four-axis", {}, 120, 0.02, seed=14)
    names = np.arange(1, 121) if ids != "of a list of poses in another order" else (np.arange(120) * 7) % 120 + 1
    text = np.char.add("pose " if ids == "text" else "", names.astype(str))
    table = replace(table, time=None, id=text, number=np.empty(0))
    table.positions[70:] += [3e-4, -2e-4, 1e-4]
    (found,) = diagnose(arm, table, QUICK).effects
    assert (found.effect, found.location) == ("base_shift", "base")
    row = {p.name: p for p in found.parameters}["row"]
    assert row.value == pytest.approx(71, abs=2)
    assert abs(row.value - 71) <= 3 * row.stderr
    assert 0.2 < row.stderr < 3


@pytest.mark.long
def test_a_faint_jump_has_a_wide_interval() -> None:
    arm, table = planted("four-axis", {}, 120, 0.02, seed=14)
    spreads = []
    for size in (1.0, 0.12):  # a smaller one might be the set-up's wander as well
        moved = table.positions.copy()
        moved[70:] += size * np.array([3e-4, -2e-4, 1e-4])
        (found,) = diagnose(arm, replace(table, time=None, positions=moved), QUICK).effects
        row = {p.name: p for p in found.parameters}["row"]
        assert abs(row.value - 71) < 3 * row.stderr + 1
        spreads.append(row.stderr)
    assert spreads[1] > 2 * spreads[0]


def test_a_long_table_is_sampled_and_then_weighed_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [5e-7]}, 400, 0.02, seed=15)
    monkeypatch.setattr(loads, "PLAUSIBLE", replace(loads.PLAUSIBLE, weighed_share=1e-3))
    monkeypatch.setattr(selection, "LOOP", replace(selection.LOOP, sample_rows=120))
    verdict = diagnose(arm, table, QUICK)
    (found,) = verdict.effects
    assert (found.effect, found.location) == ("joint_compliance", "joint 2")
    assert verdict.rows == 400
    # stated masses are known to a tenth each, and so is what gives way under them, less where several share the error;
    # the payload is exact here
    (compliance,) = found.parameters
    assert compliance.stderr < 0.03 * 5e-7
    assert abs(compliance.value - 5e-7) < 3 * compliance.stderr
    assert len(verdict.residuals.after) == 400


@pytest.mark.long
def test_what_carries_over_between_runs_is_said_and_what_does_not_is_too() -> None:
    arm = arm_named("four-axis")
    table = replace(one_run(arm, 90, 16), run=np.repeat(["1", "2", "3"], 30))
    same = recorded(arm, table, {("joint_compliance", "joint 2"): [5e-7]}, 0.02, seed=17)
    (found,) = diagnose(arm, same, QUICK).effects
    assert found.carries_over.startswith("Each of the 3 runs alone gives the same value")
    stiffer = recorded(arm, table, {("joint_compliance", "joint 2"): [3.5e-7]}, 0.02, seed=17)
    changed = same.positions.copy()
    changed[table.run == "3"] = stiffer.positions[table.run == "3"]
    told = {effect.effect: effect for effect in diagnose(arm, replace(same, positions=changed), QUICK).effects}
    # what differs from run to run has a name of its own, beside which the drive is the same in all of them
    assert told["compliance_change"].parameters[0].value == pytest.approx(-1.5e-7, rel=0.1)
    assert told["joint_compliance"].carries_over.startswith("Each of the 3 runs alone gives the same value")


@pytest.mark.long
def test_what_carries_over_between_payloads_and_halves_of_the_workspace_is_said() -> None:
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [5e-7]}, 150, 0.02, seed=16)
    table = replace(table, payload=np.repeat([0.0, 4.0, 8.0], 50))
    table = recorded(arm, table, {("joint_compliance", "joint 2"): [5e-7]}, 0.02, seed=17)
    (found,) = diagnose(arm, table, QUICK).effects
    assert "3 payloads alone gives the same value" in found.carries_over
    assert "2 halves of the workspace alone gives the same value" in found.carries_over


@pytest.mark.long
def test_a_cause_that_differs_between_near_and_far_is_said_to() -> None:
    arm, table = planted("six-axis", {("joint_compliance", "joint 2"): [5e-7]}, 120, 0.02, seed=16)
    other = recorded(arm, table, {("joint_compliance", "joint 2"): [6e-7]}, 0.02, seed=17)
    reach = np.linalg.norm(table.positions[:, :2], axis=1)
    positions = np.where((reach > np.median(reach))[:, None], other.positions, table.positions)
    effects = diagnose(arm, replace(table, positions=positions), QUICK).effects
    differing = [e for e in effects if "halves of the workspace alone give different values" in e.carries_over]
    assert differing
    # a size that depends on where one looks is none of a single cause
    assert all(effect.named_as != "effect" for effect in differing)
