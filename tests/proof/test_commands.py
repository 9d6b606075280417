"""One world all the way through the commands that the workflow calls."""

from __future__ import annotations

import json

import pandas as pd
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from tests.proof.test_seal import REPOSITORY

BATCH = "fixed-0"


def run(*words):
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, f"{result.output}\n{result.exception!r}"


@pytest.fixture(scope="module")
def proof(tmp_path_factory):
    """A proof of one world with a concealed effect, from seed to report."""
    folder = tmp_path_factory.mktemp("proof")
    visible, verdicts = folder / "visible" / BATCH, folder / "verdicts" / BATCH
    run("proof", "seed", "--fixed", 9, "-o", folder / "seed.json")
    made = ("--visible", visible, "--sealed", folder / "sealed" / f"{BATCH}.tar.gz")
    run(
        "proof",
        "worlds",
        REPOSITORY / "config" / "robots",
        "--size",
        "small",
        "--half",
        "fixed",
        "--part",
        "5/12",
        *made,
    )
    run("proof", "diagnose", visible, "-o", verdicts)
    (folder / "seen").mkdir()
    (folder / "seen" / f"{BATCH}.txt").write_text("./visible/recordings.csv\n")
    run("proof", "score", folder, "-o", folder / "tables")
    run("proof", "figures", folder / "tables", "-o", folder / "figures")
    run("proof", "report", folder / "tables", folder / "figures", folder / "seed.json", "-o", folder / "report.html")
    return folder


@pytest.mark.long
def test_every_step_leaves_what_the_next_one_reads_and_a_report(proof):
    assert (proof / "report.html").stat().st_size > 100_000
    worlds = pd.read_csv(proof / "tables" / "worlds.csv")
    assert len(worlds) == 1
    assert worlds["failed"].isna().all()
    assert 0.9 < worlds["held_out_ratio"][0] < 50


@pytest.mark.long
def test_a_batch_gives_a_world_the_verdict_that_armscope_diagnose_gives_it_alone(proof, tmp_path):
    (world,) = (proof / "visible" / BATCH).glob("[!.]*")
    options = ("--resamples", 0, "--no-cross-validation", "--no-report")
    run("diagnose", world / "recordings.csv", "--robot", world / "robot.yaml", "-o", tmp_path, *options)
    alone = json.loads((tmp_path / "verdict.json").read_text())
    batch = json.loads((proof / "verdicts" / BATCH / world.name / "verdict.json").read_text())
    assert alone == batch
    run("predict", tmp_path / "model.yaml", world / "test_poses.csv", "-o", tmp_path / "test_predicted.csv")
    axes = ["x_mm", "y_mm", "z_mm"]
    theirs = pd.read_csv(proof / "verdicts" / BATCH / world.name / "test_predicted.csv")[axes]
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "test_predicted.csv")[axes], theirs)


def test_a_drawn_seed_is_recorded_as_drawn(tmp_path):
    run("proof", "seed", "-o", tmp_path / "seed.json")
    content = json.loads((tmp_path / "seed.json").read_text())
    assert content["drawn"]
    assert content["proof_seed"] >= 0
