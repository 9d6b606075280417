import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.recordings import read_recordings

ROBOT = Path(__file__).parents[2] / "config" / "robots" / "six-axis.yaml"
FEW = ("--candidates", "150", "--starts", "1", "--seeds", "2")


def run(*arguments):
    return CliRunner().invoke(app, ["poses", "--robot", str(ROBOT), *map(str, arguments)])


@pytest.mark.long
def test_it_writes_poses_of_the_contract_and_says_what_they_are_worth(tmp_path):
    path = tmp_path / "poses.csv"
    result = run("-n", 20, "-o", path, "--tracker", "4000,0,1500", "--floor-mm", 0, *FEW)
    assert result.exit_code == 0, result.output
    assert len(read_recordings(path, 6, measured=False)) == 20
    told = json.loads((tmp_path / "poses.json").read_text())
    assert set(told["indices"]) == {"O1", "O2", "O3", "O4", "O5"}
    assert told["assumed"]["tracker_mm"] == [4000.0, 0.0, 1500.0]
    assert set(told["compared"]["medians"]) == {"chosen", "random", "grid"}
    assert (tmp_path / "poses.png").stat().st_size > 10_000
    first = path.read_bytes(), (tmp_path / "poses.json").read_bytes()
    run("-n", 20, "-o", path, "--tracker", "4000,0,1500", "--floor-mm", 0, *FEW)
    assert first == (path.read_bytes(), (tmp_path / "poses.json").read_bytes())


def test_effects_that_follow_context_get_its_columns(tmp_path):
    path = tmp_path / "poses.csv"
    run("-n", 15, "-o", path, "--effects", "backlash,joint_compliance", "--payload-kg", 10, *FEW)
    table = read_recordings(path, 6, measured=False)
    assert table.approach is not None
    # driven in the order of the file: sides that were drawn agreed with the way in half of all cells
    np.testing.assert_array_equal(table.approach[1:], np.sign(np.diff(table.motor_angles, axis=0)))
    assert set(table.payload.tolist()) == {0.0, 10.0}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--criterion", "O7"), "O1, O2, O3, O4 or O5"),
        (("--tracker", "4000,0"), "three numbers"),
        (("--tracker", "here"), "three numbers"),
        (("-o", "poses.txt"), "ends in .csv"),
        (("-o", "poses.xlsx"), "Call it poses.csv"),
    ],
)
def test_bad_options_are_named(tmp_path, options, words):
    result = run(*options)
    assert isinstance(result.exception, InputError)
    assert words in str(result.exception)
