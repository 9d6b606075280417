"""A built world shows what it may, seals what it must, and its truth is true."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
import yaml

from armscope.recordings import read_recordings
from armscope.robot.description_file import load_description
from armscope.world.catalogue import catalogue
from armscope.world.folder import build
from armscope.world.spec import WorldSpec
from armscope.world.virtual_arm import conceal, measure_session
from tests.world.by_hand import ROBOTS, HandArm
from tests.world.measuring import measure_at

OFFSET = {"kind": "joint_offset", "strength": 4.0, "location": "joint 3"}
SOFT = {"kind": "joint_compliance", "strength": 3.0, "location": "joint 2"}


def spec(**changes):
    return WorldSpec.model_validate(
        {
            "id": "000-test", "category": "single", "arm": "six-axis", "seed": 11, "fresh": False, "rows": 60,
            "sigma_mm": 0.02, "effects": [OFFSET], **changes,
        }
    )  # fmt: skip


def read(home):
    truth = yaml.safe_load((home / "sealed" / "truth.yaml").read_text())
    recordings = pd.read_csv(home / "visible" / "recordings.csv")
    return truth, recordings, pd.read_csv(home / "sealed" / "test.csv")


def test_a_world_has_the_folders_and_files_of_the_contract(tmp_path):
    home = build(spec(), tmp_path, ROBOTS)
    files = {str(path.relative_to(home)) for path in home.rglob("*") if path.is_file()}
    assert files == {"visible/robot.yaml", "visible/recordings.csv", "sealed/truth.yaml", "sealed/test.csv"}
    truth, recordings, test = read(home)
    assert list(truth)[:4] == ["sigma_mm", "effects", "frames", "rms_on_test_mm"]
    assert set(truth["frames"]) == {"translation_mm", "rotation_rad", "tool_error_mm"}
    assert (len(recordings), len(test)) == (60, 100)
    load_description(home / "visible" / "robot.yaml")
    assert read_recordings(home / "visible" / "recordings.csv").n_motors == 6


def test_all_context_is_read_as_what_it_was_in_the_session(tmp_path):
    asked = spec(columns="irrelevant")
    table = read_recordings(build(asked, tmp_path, ROBOTS) / "visible" / "recordings.csv")
    arm = conceal(asked, ROBOTS)
    session, measured = arm.scene.session, measure_session(arm)
    for read_back, was, within in (
        (table.approach, session.approach, 0.0),
        (table.speed, session.speed, 1e-9),
        (table.torque, measured.torque, 0.06 * np.abs(measured.torque).max()),
        (table.payload, session.payload, 1e-9),
        (table.temperature, session.temperature, 1e-9),
    ):
        assert np.abs(read_back - was[arm.recorded]).max() <= within


@pytest.mark.long
@pytest.mark.parametrize(
    "arm", ["parallelogram-120kg", *(pytest.param(arm, marks=pytest.mark.long) for arm in ("six-axis", "seven-axis"))]
)
def test_the_same_spec_gives_the_same_bytes_and_another_seed_others(arm, tmp_path):
    effects = [OFFSET, SOFT]
    homes = [
        build(spec(arm=arm, effects=effects, seed=seed), tmp_path / part, ROBOTS)
        for part, seed in (("a", 1), ("b", 1), ("c", 2))
    ]
    for file in ("visible/robot.yaml", "visible/recordings.csv", "sealed/truth.yaml", "sealed/test.csv"):
        assert (homes[0] / file).read_bytes() == (homes[1] / file).read_bytes()
    assert (homes[0] / "visible/recordings.csv").read_bytes() != (homes[2] / "visible/recordings.csv").read_bytes()


def test_the_truth_recomputed_by_hand_leaves_the_stated_noise(tmp_path):
    """An offset and the frames of truth.yaml, put through a product of D-H matrices, against test.csv."""
    truth, _, test = read(build(spec(), tmp_path, ROBOTS))
    arm = HandArm.named("six-axis")
    offset = truth["effects"][0]["parameters"][0]["value"]
    frames = truth["frames"]
    arm.tool = arm.tool + np.array(frames["tool_error_mm"]) / 1e3
    angles = test[[f"q{m}_rad" for m in range(1, 7)]].to_numpy() + offset * np.eye(6)[2]
    tool = np.array([arm.point(q) for q in angles])
    rx, ry, rz = frames["rotation_rad"]
    turn = np.eye(3) + np.array([[0, -rz, ry], [rz, 0, -rx], [-ry, rx, 0]])
    turn += 0.5 * (turn - np.eye(3)) @ (turn - np.eye(3))
    left = tool @ turn.T * 1e3 + frames["translation_mm"] - test[["x_mm", "y_mm", "z_mm"]].to_numpy()
    found = np.sqrt(np.mean(left**2))
    assert found == pytest.approx(truth["rms_on_test_mm"]["true_model"], rel=0.01)
    assert found == pytest.approx(truth["sigma_mm"], rel=0.15)
    assert truth["rms_on_test_mm"]["frames_only"] > 2 * found


def test_each_effect_is_as_strong_as_wished(tmp_path):
    truth, *_ = read(build(spec(effects=[OFFSET, SOFT]), tmp_path, ROBOTS))
    strengths = {effect["effect"]: effect["strength"] for effect in truth["effects"]}
    assert strengths == pytest.approx({"joint_offset": 4.0, "joint_compliance": 3.0}, rel=0.01)
    sizes = [effect["rms_at_tool_mm"] for effect in truth["effects"]]
    assert sizes == sorted(sizes, reverse=True)


@pytest.mark.long
def test_the_same_displacement_is_not_concealed_twice(tmp_path):
    """On this arm a tilting base and a tilting first bearing are one; the second one is left out."""
    tilts = [
        {"kind": "base_compliance", "strength": 5.0},
        {"kind": "bearing_compliance", "strength": 5.0, "location": "joint 1"},
    ]
    truth, *_ = read(build(spec(category="multiple", effects=tilts), tmp_path, ROBOTS))
    assert [effect["effect"] for effect in truth["effects"]] == ["base_compliance"]


def test_a_clean_arm_has_nothing_to_find(tmp_path):
    truth, *_ = read(build(spec(category="clean", effects=[]), tmp_path, ROBOTS))
    assert truth["effects"] == []
    assert truth["scoring"]["mismatch"] is False
    assert truth["rms_on_test_mm"]["frames_only"] == pytest.approx(truth["sigma_mm"], rel=0.15)


def test_nothing_visible_names_what_is_concealed(tmp_path):
    home = build(spec(noise_stated=False), tmp_path, ROBOTS)
    text = "".join(path.read_text() for path in (home / "visible").iterdir())
    assert not any(word in text for word in ("offset\n", "joint_offset", "sigma", "seed", "truth"))


def test_a_column_that_would_show_the_effect_can_be_missing(tmp_path):
    asked = {"kind": "backlash", "strength": 4.0}
    shown, hidden = (
        build(spec(id=str(n), effects=[asked], columns=columns), tmp_path, ROBOTS)
        for n, columns in enumerate(("some", "missing"))
    )
    assert "approach1" in read(shown)[1]
    truth, recordings, test = read(hidden)
    assert "approach1" not in recordings
    assert "approach1" not in test
    assert truth["scoring"]["columns_left_out"] == ["approach"]


@pytest.mark.long
def test_a_base_that_moves_is_not_given_away_or_hidden_by_runs(tmp_path):
    for seed in range(5):
        home = build(spec(effects=[{"kind": "base_drift", "strength": 4.0}], seed=seed), tmp_path, ROBOTS)
        assert "run" not in read(home)[1]
        assert "time_s" in read(home)[1]


def test_bad_shots_are_where_the_truth_says(tmp_path):
    home = build(spec(noise="outliers", effects=[], category="bad_shots", rows=200), tmp_path, ROBOTS)
    truth, recordings, _ = read(home)
    arm = conceal(spec(noise="outliers", effects=[], category="bad_shots", rows=200), ROBOTS)
    true = measure_session(arm).points[arm.recorded] * 1e3
    off = np.linalg.norm(recordings[["x_mm", "y_mm", "z_mm"]].to_numpy() - true, axis=1)
    assert (np.flatnonzero(off > 0.5) + 1).tolist() == truth["scoring"]["bad_rows"]
    assert len(truth["scoring"]["bad_rows"]) == 4


def test_heavy_tails_are_heavier_than_gauss(tmp_path):
    arm = conceal(spec(noise="heavy_tails", effects=[], rows=300), ROBOTS)
    noise = measure_session(arm).noise / 2e-5
    assert np.median(np.abs(noise)) == pytest.approx(0.765, rel=0.1)  # Student's t, 3 degrees of freedom
    assert np.abs(noise).max() > 5


@pytest.mark.parametrize("masses", ["wrong", "absent"])
def test_masses_can_be_wrong_or_absent_in_what_is_visible(masses, tmp_path):
    home = build(spec(effects=[SOFT], masses=masses), tmp_path, ROBOTS)
    visible = yaml.safe_load((home / "visible" / "robot.yaml").read_text())
    right = yaml.safe_load((ROBOTS / "six-axis.yaml").read_text())
    assert visible.get("links") != right["links"]
    assert ("links" in visible) == (masses == "wrong")
    assert read(home)[0]["effects"][0]["values_comparable"] is False


def test_what_can_not_be_told_apart_has_its_alternatives_in_the_truth(tmp_path):
    world = spec(category="inseparable", arm="parallelogram-120kg", effects=[SOFT], poses="no_payload", rows=150)
    truth, recordings, _ = read(build(world, tmp_path, ROBOTS))
    found = [(a["effect"], a["location"]) for a in truth["effects"][0]["alternatives"]]
    assert ("gear_eccentricity", "joint 2") in found
    assert (recordings["payload_kg"] == 0).all()


def test_an_effect_outside_the_library_is_called_unknown_with_its_driver_and_shape(tmp_path):
    asked = {"kind": "unknown/local_bump", "strength": 5.0}
    truth, *_ = read(build(spec(category="outside", effects=[asked]), tmp_path, ROBOTS))
    effect = truth["effects"][0]
    assert (effect["effect"], effect["driver"], effect["shape"]) == ("unknown", "joint angle", "local_bump")
    assert truth["scoring"]["outside_library"] is True


def test_a_real_arm_has_a_story_and_a_background(tmp_path):
    world = next(s for s in catalogue(3, "full") if s.category == "real").model_copy(update={"rows": 60})
    truth, *_ = read(build(world, tmp_path, ROBOTS))
    story = [effect for effect in truth["effects"] if not effect["minor"]]
    background = [effect for effect in truth["effects"] if effect["minor"]]
    assert story == truth["effects"][:1]
    assert len(background) > 15
    assert max(effect["strength"] for effect in background) < 2 < story[0]["strength"]
    assert json.dumps(truth)  # plain numbers only


def test_the_arm_can_be_measured_again_at_poses_asked_for_later():
    """Its own rows, asked for again, have the same true places; new poses with a payload show the compliance."""
    arm = conceal(spec(effects=[SOFT]), ROBOTS)
    session = arm.scene.session
    poses = pd.DataFrame({f"q{m + 1}_rad": session.commanded[:, m] for m in range(6)}).assign(
        payload_kg=session.payload
    )
    again = measure_at(arm, poses, np.random.default_rng(1))[["x_mm", "y_mm", "z_mm"]].to_numpy()
    noise = again - measure_session(arm).points * 1e3
    assert np.std(noise) == pytest.approx(0.02, rel=0.1)
    lighter = measure_at(arm, poses.drop(columns="payload_kg"), np.random.default_rng(1))
    assert np.abs(lighter[["x_mm", "y_mm", "z_mm"]].to_numpy() - again).max() > 0.05


def test_the_oracle_fits_a_base_in_each_run_that_the_table_shows(tmp_path):
    shown = set()
    for seed in range(4):
        truth, recordings, _ = read(build(spec(seed=seed), tmp_path / str(seed), ROBOTS))
        runs = recordings["run"].nunique() if "run" in recordings else 1
        shown.add("run" in recordings)
        assert truth["effects"][0]["oracle"]["frame_numbers"] == 6 * runs + 3
    assert shown == {True, False}
