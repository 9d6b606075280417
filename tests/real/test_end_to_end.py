"""The whole concealment by its commands, as the workflow calls them: planted, diagnosed, unsealed, shown."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.files import write_json
from tests.real.recorded import ROBOT, table

pytestmark = pytest.mark.long
SETTINGS = {
    "seed": 1, "title": "made_up", "run": "one", "first_id": None, "most_rows": 500,
    "effects": ["joint_coupling", "backlash", "joint_compliance"], "sizes": [3.0],
}  # fmt: skip


def call(*words):
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exception is None, (words, result.exception, result.stdout)


@pytest.fixture(scope="module", params=[None, 1e-4], ids=["points", "orientations too"])
def folder(request, tmp_path_factory):
    home = tmp_path_factory.mktemp("concealed")
    # an arm with errors of its own: two zeros are off and a gear is out of round
    own = table(
        120, 0.02, error_rad=lambda q, rng: np.array([0, 1e-3, 0, -2e-3, 0, 0]) + 2e-4 * np.cos(q),
        turn_noise_rad=request.param,
    )  # fmt: skip
    own.to_csv(home / "recordings.csv", index=False)
    for part in ("original", "fixed"):
        places = ("--visible", home / "visible" / f"arm-{part}", "--sealed", home / "sealed" / f"arm-{part}.tar.gz")
        level = (
            ()
            if part == "original"
            else ("--verdict", home / "verdicts" / "arm-original" / "original" / "verdict.json")
        )
        settings = ("--settings", json.dumps(SETTINGS), "--part", part)
        call("real", "plant", home / "recordings.csv", ROBOT, *settings, *level, *places)
        call(
            "proof",
            "diagnose",
            home / "visible" / f"arm-{part}",
            "--resamples",
            0,
            "--no-cross-validation",
            "-o",
            home / "verdicts" / f"arm-{part}",
        )
        (home / "seen").mkdir(exist_ok=True)
        (home / "seen" / f"arm-{part}.txt").write_text("./recordings.csv\n")
    call("real", "score", home, "-o", home / "tables")
    write_json(home / "seed.json", {"proof_seed": 5, "drawn": True})
    call("real", "report", home / "tables", home / "seed.json", "--titles", '{"arm": "An Arm"}', "-o", home)
    return home


def test_clear_effects_are_found_beside_what_the_arm_does_itself(folder):
    cases = pd.read_csv(folder / "tables" / "cases.csv")
    assert set(cases["effect"]) == set(SETTINGS["effects"])
    assert cases["found"].all(), cases[["effect", "location", "outcome", "said"]]
    assert np.allclose(cases["size_ratio"], 1, atol=0.2)
    assert (cases["recovered"] > 0.8).all()


def test_the_page_says_what_the_tables_say(folder):
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert "100 % (3/3)" in text
    assert "An Arm" in text
    assert "proof seed 5, drawn when this proof ran" in text
    for name in ("found", "sizes", "held_out"):
        assert (folder / "figures" / f"{name}.png").stat().st_size > 5000
