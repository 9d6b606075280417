"""The commands as functions: lazily imported, in the command line's order, with what a notebook shows."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import armscope
from armscope import PredictionWarning
from armscope.core.inputs import InputError
from armscope.notebook.result import Diagnosed

EXAMPLE = Path(__file__).parents[2] / "examples" / "one-effect"
RECORDINGS, ROBOT = EXAMPLE / "recordings.csv", EXAMPLE / "robot.yaml"


@pytest.fixture(scope="module")
def found():
    return armscope.diagnose(RECORDINGS, ROBOT, resamples=0, cross_validation=False)


def test_importing_imports_nothing_heavy():
    code = "import armscope, sys; print(*[m for m in ('numpy', 'pandas', 'pinocchio', 'scipy') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
    assert set(armscope.__all__) <= set(dir(armscope))
    with pytest.raises(AttributeError):
        _ = armscope.diagnoze


@pytest.mark.long
def test_a_paragraph_and_a_table_say_the_same_causes(found):
    assert isinstance(found, Diagnosed)
    assert found.effects[0].title in repr(found)
    assert "\n" not in repr(found)
    assert found.headline.split(".")[0][:20] in repr(found)
    assert found._repr_html_().count("<tr>") == 1 + len(found.effects)
    assert json.dumps(found.to_json(), default=str)


def test_it_predicts_what_the_command_does(found):
    table = armscope.read_recordings(RECORDINGS, ROBOT)
    points = found.predict(RECORDINGS)[["x_mm", "y_mm", "z_mm"]].to_numpy()
    assert np.sqrt(np.mean((points - table.positions * 1e3) ** 2)) == pytest.approx(found.residual_after_mm, rel=0.05)
    pd.testing.assert_frame_equal(armscope.predict(found, RECORDINGS), found.predict(pd.read_csv(RECORDINGS)))


def test_it_draws_and_names_the_figures_that_there_are(found):
    assert found.plot()._repr_svg_().startswith("<svg")
    with pytest.raises(InputError, match=r"'armm'.*'arm'"):
        found.plot("armm")


def test_its_content_is_valid_json(found):
    """What is no number is null, as in the file: the size of small errors of all families together is none."""
    strict = json.dumps(found.to_json(), allow_nan=False)
    assert json.loads(strict)["background"]["size"] is None


def test_what_is_read_or_found_is_told_in_a_paragraph(found):
    """Arrays of thousands of numbers say nothing in a notebook."""
    arm, table = armscope.read_robot(ROBOT), armscope.read_recordings(RECORDINGS)
    other = EXAMPLE.parent / "five-effects" / "recordings.csv"
    results = {
        "6 motors": arm,
        "60 rows": table,
        "calibration on 60 rows": armscope.calibrate(table, arm, level="offsets"),
        "15 poses": armscope.choose_poses(arm, 15, candidates=100, starts=1),
        "commands for 60 of 60 rows": armscope.compensate(found, RECORDINGS),
        "five-effects": armscope.compare(table, other, robot=arm),
        "Nothing looks wrong": armscope.check(table, arm),
    }
    for told, result in results.items():
        assert told in repr(result)
        assert len(repr(result)) < 900
        assert "\n" not in repr(result)
        assert result._repr_html_().startswith("<p><b>")


def test_points_out_of_reach_are_warned_of(found):
    far = pd.DataFrame({"x_mm": [9700.0] * 3, "y_mm": 0.0, "z_mm": 0.0, "payload_kg": 0.0})
    with pytest.warns(PredictionWarning, match="3 of 3 rows have no command: beyond reach"):
        armscope.compensate(found, far)


def test_an_error_in_a_data_frame_counts_its_own_rows():
    frame = pd.read_csv(RECORDINGS)
    with pytest.raises(InputError, match=r"data frame: row 0, column q1_rad: found 'x'"):
        armscope.check(frame.assign(q1_rad=["x", *frame["q1_rad"][1:]]), ROBOT)
    with pytest.raises(InputError, match=r"row 1, column id: .* row 0 has it, too"):
        armscope.check(frame.assign(id=1), ROBOT)
    with pytest.raises(InputError, match=r"data frame: columns: found no column q2_rad"):
        armscope.diagnose(frame.drop(columns="q2_rad"), ROBOT)


def test_it_compensates_and_chooses(found):
    wanted = pd.read_csv(RECORDINGS)[[*(f"q{j}_rad" for j in range(1, 7)), "payload_kg"]].head(3)
    assert len(armscope.compensate(found, wanted).commands) == 3
    options = {"start_rad": [0.0] * 6, "allowed_outside": 9.0, "separate_points": True, "frame": "measurement"}
    assert armscope.compensate(found, wanted, **options).reached.all()
    assert len(armscope.choose_poses(ROBOT, 15, candidates=100, starts=1, floor_mm=0).indices) > 0


def test_calibration_and_check_take_the_same_arguments():
    assert armscope.calibrate(RECORDINGS, ROBOT, level="offsets").table is not None
    assert not armscope.check(RECORDINGS, ROBOT).has_problems
    assert armscope.check(RECORDINGS, ROBOT).to_json()["problems"] is False


@pytest.mark.parametrize("swapped", [(ROBOT, RECORDINGS), (armscope.read_robot(ROBOT), RECORDINGS)])
def test_arguments_in_the_old_order_are_told(swapped):
    with pytest.raises(InputError, match="recordings come first"):
        armscope.diagnose(*swapped)


def test_a_misspelt_option_is_told():
    with pytest.raises(InputError, match=r"resample.*resamples"):
        armscope.diagnose(RECORDINGS, ROBOT, resample=0)
