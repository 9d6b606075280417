"""The example of an arm in motion: by the command line, what it conceals is found and its test path predicted.

What the check calls unusable is another arm, which is diagnosed in less time.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from typer.testing import CliRunner

from armscope.cli import app
from armscope.motion.verdict import read_motion_verdict
from tests.motion.moving import ROBOT
from tests.motion.moving import robot as arm
from tests.motion.moving import table as made

EXAMPLE = Path(__file__).parents[2] / "examples" / "moving-arm"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("out")
    robot, motions = str(EXAMPLE / "robot.yaml"), str(EXAMPLE / "motions.csv.gz")
    made = CliRunner().invoke(app, ["diagnose", motions, "--robot", robot, "-o", str(out), "--no-report"])
    assert made.exit_code == 0, made.output
    return out


def test_what_the_example_conceals_is_found_and_nothing_else(folder: Path) -> None:
    truth = yaml.safe_load((EXAMPLE / "truth.yaml").read_text(encoding="utf-8"))
    found = {(e.effect, e.location): e for e in read_motion_verdict(folder / "verdict.json").effects}
    assert found.keys() == {(e["effect"], e["location"]) for e in truth["effects"]}
    for effect in truth["effects"]:
        (wanted,) = effect["parameters"]
        (told,) = found[effect["effect"], effect["location"]].parameters
        low, high = told.interval
        assert low - (high - low) < wanted["value"] < high + (high - low)


def test_its_test_path_is_predicted_as_well_as_noise_allows(folder: Path) -> None:
    made = CliRunner().invoke(
        app, ["predict", str(folder / "model.yaml"), str(EXAMPLE / "test.csv.gz"), "-o", str(folder / "p.csv")]
    )
    assert made.exit_code == 0, made.output
    truth = yaml.safe_load((EXAMPLE / "truth.yaml").read_text(encoding="utf-8"))
    names = [f"tau{j}_nm" for j in range(1, 7)]
    off = pd.read_csv(folder / "p.csv")[names] - pd.read_csv(EXAMPLE / "test.csv.gz")[names]
    assert np.sqrt(np.mean((off / truth["left_on_test_nm"]).to_numpy() ** 2)) < 1.2


def test_a_table_that_the_check_calls_unusable_is_not_diagnosed_unless_asked_for(tmp_path: Path) -> None:
    table, robot, out = made(arm(), 1, seconds=8.0), tmp_path / "robot.yaml", tmp_path / "out"
    robot.write_text(yaml.safe_dump(ROBOT), encoding="utf-8")
    torques = [f"tau{j}_nm" for j in range(1, 4)]
    table[torques] = -table[torques]
    table.to_csv(tmp_path / "turned.csv", index=False)
    words = ["diagnose", str(tmp_path / "turned.csv"), "--robot", str(robot), "-o", str(out), "--no-report"]
    refused = CliRunner().invoke(app, words)
    assert "sign opposite" in str(refused.exception)
    assert not (out / "verdict.json").exists()
    assert CliRunner().invoke(app, [*words, "--anyway"]).exit_code == 0
    told = read_motion_verdict(out / "verdict.json").notices
    assert [each.kind for each in told].count("check") == len(torques)
