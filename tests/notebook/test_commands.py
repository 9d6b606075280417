"""The commands as functions: lazily imported, in the command line's order, with what a notebook shows."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import armscope
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
