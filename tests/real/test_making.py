"""What may be seen and what is sealed: same seed, same bytes; names of folders say nothing; withheld means gone."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.provenance import sources
from armscope.proof.reading import ALLOWED
from armscope.proof.truth import unsealed
from armscope.real.making import Places, make_altered, make_original, make_withheld
from armscope.real.prepared_recordings import prepared_recordings, with_payload
from armscope.recordings import as_recordings
from armscope.recordings.columns import AXES_MM, QUATERNION
from tests.real.recorded import ROBOT, arm, table

RULES = (Path(__file__).parents[2] / "workflow" / "rules" / "proof_real.smk").read_text(encoding="utf-8")
EFFECTS = ("joint_coupling", "gear_mesh")


def places(folder):
    return Places(ROBOT, folder / "visible", folder / "sealed.tar.gz")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    mine = prepared_recordings(arm(), table(noise_mm=0.02), 1000)
    for attempt in ("first", "second"):
        make_altered(mine, EFFECTS, (1.0, 3.0), 1e-4, (7,), places(folder / attempt))
    make_original(mine, places(folder / "original"))
    return folder


def test_the_same_seed_gives_the_same_bytes(made):
    for file in sorted(path for path in (made / "first").rglob("*") if path.is_file()):
        assert file.read_bytes() == (made / "second" / file.relative_to(made / "first")).read_bytes()


def test_only_recordings_robot_and_poses_without_readings_are_visible(made):
    files = [path for path in (made / "first" / "visible").rglob("*") if path.is_file()]
    assert {path.name for path in files} == ALLOWED
    for path in files:
        assert not any(name in path.as_posix() for name in (*EFFECTS, "truth"))
        if path.name == "test_poses.csv":
            assert not set(AXES_MM) & set(pd.read_csv(path).columns)


def test_measured_orientations_turn_with_the_points(tmp_path):
    mine = prepared_recordings(arm(), table(turn_noise_rad=1e-4), 1000)
    make_altered(mine, ("joint_coupling",), (3.0,), 1e-4, (7,), places(tmp_path))
    (world,) = (tmp_path / "visible").iterdir()
    after = as_recordings(pd.read_csv(world / "recordings.csv"), "after", 6)
    before = mine.recordings.rows(mine.train)
    turn = (
        Rotation.from_quat(after.orientation, scalar_first=True)
        * Rotation.from_quat(before.orientation, scalar_first=True).inv()
    )
    assert turn.magnitude().max() > 1e-4
    assert not set(QUATERNION) & set(pd.read_csv(world / "test_poses.csv").columns)
    # a coupling turns the tool about one joint's axis, and the point with it: as far as the lever reaches
    moved = np.linalg.norm(after.positions - before.positions, axis=1)
    assert np.all(moved <= turn.magnitude() * arm().reach * 1.01 + 1e-7)


def test_altered_and_original_differ_in_the_measured_points_alone(made):
    before = pd.read_csv(made / "original" / "visible" / "original" / "recordings.csv")
    for world in (made / "first" / "visible").iterdir():
        after = pd.read_csv(world / "recordings.csv")
        assert list(after.columns) == list(before.columns)
        rest = [name for name in before.columns if name not in AXES_MM]
        pd.testing.assert_frame_equal(after[rest], before[rest])
        assert np.abs(after[AXES_MM] - before[AXES_MM]).to_numpy().max() > 0.01


def test_every_effect_stands_at_every_size_in_the_archive(made):
    truths = [truth for truth, _ in unsealed(made / "first" / "sealed.tar.gz").values()]
    assert sorted((t["effect"], t["size"]) for t in truths) == sorted((e, s) for e in EFFECTS for s in (1.0, 3.0))
    for truth in truths:
        assert truth["rms_mm"] == pytest.approx(0.1 * truth["size"], rel=0.01)


def test_what_is_withheld_is_gone_and_what_was_not_recorded_is_not_withheld(tmp_path):
    load = table(torque=lambda q: np.sin(q), run="loaded").assign(payload_kg=2.0)
    loaded = prepared_recordings(arm(), with_payload(pd.concat([load, table(run="other")])), 1000)
    assert loaded.targets == ("loaded",)
    make_withheld({"payloads": loaded, "run": prepared_recordings(arm(), table(), 1000)}, places(tmp_path))
    truths = {world: truth for world, (truth, _) in unsealed(tmp_path / "sealed.tar.gz").items()}
    assert [t["withheld"] for t in truths.values() if t["rows"] == "run"] == ["all columns"]
    for world, truth in truths.items():
        columns = pd.read_csv(tmp_path / "visible" / world / "recordings.csv").columns
        assert ("payload_kg" in columns) == (truth["rows"] == "payloads" and "payload" not in truth["withheld"])
        assert ("tau1_nm" in columns) == (truth["rows"] == "payloads" and "torques" not in truth["withheld"])


def test_columns_are_withheld_with_orientations_and_without_but_never_shown_of_test_rows(tmp_path):
    rows = table(torque=lambda q: np.sin(q), turn_noise_rad=1e-3)
    make_withheld({"run": prepared_recordings(arm(), rows, 1000)}, places(tmp_path))
    truths = {world: truth for world, (truth, _) in unsealed(tmp_path / "sealed.tar.gz").items()}
    cases = {(truth["withheld"], truth["orientations"]) for truth in truths.values()}
    assert cases == {(what, oriented) for what in ("all columns", "torques withheld") for oriented in (True, False)}
    for world, truth in truths.items():
        folder = tmp_path / "visible" / world
        assert ("qw" in pd.read_csv(folder / "recordings.csv").columns) == truth["orientations"]
        assert "qw" not in pd.read_csv(folder / "test_poses.csv").columns


def test_the_diagnosing_rule_sees_the_visible_folder_only_in_a_folder_of_its_own():
    rule = re.search(r"use rule proof_diagnose as proof_real_diagnose.*?(?=\n\n\n)", RULES, re.S)
    assert rule is not None
    assert "sealed" not in rule.group()
    inputs = re.search(r"input:\n(.*?)output:", rule.group(), re.S)
    assert re.findall(r"/(\w+)/", inputs.group(1)) == ["visible"]


def test_the_diagnosis_knows_nothing_of_planting():
    used = {path.as_posix() for path in sources("armscope.proof.diagnosing")}
    assert not [path for path in used if "armscope/real/" in path or "armscope/world/" in path]
