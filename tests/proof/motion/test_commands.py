"""The motion proof from the command line: worlds made, an answer put beside them, unsealed and scored."""

import pandas as pd
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.motion.verdict import write_motion_verdict
from armscope.proof.motion import making, reading
from armscope.proof.motion.answers import read_answer
from armscope.proof.motion.diagnosing import diagnose_worlds
from armscope.proof.motion.truth import unseal
from armscope.world.motion.catalogue import MotionSpec
from armscope.world.spec import EffectSpec
from tests.proof.motion.cases import said, verdict_of
from tests.world.motion.arms import FOLDER

SPEC = MotionSpec(
    id="motion-000", category="single", arm="two-axis", seed=3, fresh=False, rate=100, noise=0.01,
    durations=(5.0, 5.0), effects=(EffectSpec(kind="torque_offset", strength=5.0, location="joint 1"),),
)  # fmt: skip


def run(*words):
    ended = CliRunner().invoke(app, list(map(str, words)))
    assert ended.exit_code == 0, ended.output
    return ended.output


@pytest.fixture
def proof(tmp_path, monkeypatch):
    monkeypatch.setattr(making, "catalogue", lambda seed, size: [SPEC])
    run("proof", "seed", "--fixed", 5, "-o", tmp_path / "seed.json")
    run("proof", "motion", "worlds", FOLDER, "--seed-file", tmp_path / "seed.json", "--visible", tmp_path / "visible",
        "--sealed", tmp_path / "sealed.tar.gz")  # fmt: skip
    return tmp_path


def test_what_is_visible_holds_no_truth(proof):
    files = {path.name for path in (proof / "visible").glob("motion-*/*")}
    assert files == reading.ALLOWED


def test_the_truth_itself_scores_as_right(proof):
    truth = unseal(proof / "sealed.tar.gz")["motion-000"]
    folder = proof / "verdicts" / "motion-000"
    folder.mkdir(parents=True)
    offset = truth.effects[0].parameters["offset"][0]
    write_motion_verdict(verdict_of([said("torque_offset", "joint 1", offset=(offset, 0.1))], background=()), folder)
    truth.test.to_csv(folder / "test_predicted.csv", index=False)
    (proof / "seen.txt").write_text("visible/motion-000/motions.csv\n")
    printed = run("proof", "motion", "score", proof, "-o", proof / "tables")
    cases = pd.read_csv(proof / "tables" / "proof.csv")
    assert cases["exact"].tolist() == [True]
    assert cases["held_out_ratio"].tolist() == [0.0]
    assert pd.read_csv(proof / "tables" / "intervals.csv")["covered"].tolist() == [True]
    assert "exact set of names, single causes" in printed


def test_a_verdict_without_prediction_keeps_its_names_and_is_infinitely_wrong_on_the_test_path(tmp_path):
    write_motion_verdict(verdict_of([], answer="nothing missing"), tmp_path)
    (tmp_path / "not_predicted.txt").write_text("armscope predict: no model.yaml\n")
    answer = read_answer(tmp_path)
    assert (answer.failed, answer.predicted, answer.answer) == ("", None, "nothing missing")
    assert "model.yaml" in answer.not_predicted


@pytest.mark.long
def test_a_world_that_cannot_be_diagnosed_is_written_down_as_failed(tmp_path):
    world = tmp_path / "visible" / "motion-007"
    world.mkdir(parents=True)
    (world / "motions.csv").write_text("time_s,q1_rad,tau1_nm\n")
    (world / "robot.yaml").write_text("name: nothing\n")
    diagnose_worlds([world], tmp_path / "verdicts")
    assert "armscope diagnose" in (tmp_path / "verdicts" / "motion-007" / "failed.txt").read_text()
