"""A table of motions in a notebook: the same functions, and what they give."""

import json
from pathlib import Path

import pandas as pd
import pytest

import armscope
from armscope.core.inputs import InputError
from armscope.notebook.motion import MotionDiagnosed, of_motion

EXAMPLE = Path(__file__).parents[2] / "examples" / "moving-arm"
MOTIONS, ROBOT = EXAMPLE / "motions.csv.gz", EXAMPLE / "robot.yaml"
POINTS = EXAMPLE.parent / "one-effect" / "recordings.csv"


@pytest.fixture(scope="module")
def found():
    return armscope.diagnose(MOTIONS, ROBOT)


def test_it_is_told_from_a_table_of_points():
    assert of_motion(str(MOTIONS))
    assert of_motion(pd.read_csv(MOTIONS))
    assert not of_motion(POINTS)
    assert not of_motion(None)


@pytest.mark.long
def test_a_paragraph_and_a_table_say_the_same_causes(found):
    assert isinstance(found, MotionDiagnosed)
    assert "\n" not in repr(found)
    assert all(each.title in repr(found) for each in found.verdict.effects)
    assert found._repr_html_().count("<tr>") == 1 + len(found.verdict.effects)
    assert json.dumps(found.to_json())


@pytest.mark.long
def test_it_writes_predicts_and_draws_what_the_command_does(found, tmp_path):
    assert found.report(tmp_path / "out").name == "report.html"
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"verdict.json", "model.yaml", "corrected.urdf", "mujoco.xml", "parameters.csv"} <= names
    by_file = armscope.predict(tmp_path / "out" / "model.yaml", EXAMPLE / "test.csv.gz")
    pd.testing.assert_frame_equal(by_file, armscope.predict(found, pd.read_csv(EXAMPLE / "test.csv.gz")), rtol=1e-4)
    assert found.plot("friction_2")._repr_svg_().startswith("<svg")
    with pytest.raises(InputError, match=r"'armm'.*arm"):
        found.plot("armm")


@pytest.mark.long
def test_it_is_checked_and_what_does_not_belong_to_it_is_told(found):
    assert not armscope.check(MOTIONS, ROBOT).has_problems
    with pytest.raises(InputError, match="resamples"):
        armscope.diagnose(MOTIONS, ROBOT, resamples=0)
    with pytest.raises(InputError, match="robot"):
        armscope.diagnose(MOTIONS, armscope.read_robot(ROBOT))
    with pytest.raises(InputError, match="a diagnosis, a fitted model or a path"):
        armscope.compensate(found, POINTS, POINTS)
    with pytest.raises(InputError, match="table of motions"):
        armscope.predict(found, armscope.read_recordings(POINTS))
