"""Functions take what their commands take, and refuse what they do not know in the same words."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import armscope
from armscope.core.inputs import InputError
from armscope.notebook.given import arm_for, arm_of, names_of, table_of
from armscope.report.svg import Drawing

EXAMPLE = Path(__file__).parents[2] / "examples" / "one-effect"


def test_a_folder_is_its_table_and_its_arm():
    assert table_of(str(EXAMPLE)) == EXAMPLE / "recordings.csv"
    assert arm_of(None, EXAMPLE) == arm_for(None, EXAMPLE) == EXAMPLE / "robot.yaml"
    assert armscope.check(EXAMPLE).text() == armscope.check(EXAMPLE / "recordings.csv", EXAMPLE / "robot.yaml").text()
    assert len(armscope.read_recordings(EXAMPLE)) == len(armscope.read_recordings(EXAMPLE / "recordings.csv"))


def test_an_arm_that_nobody_gave_is_asked_for(tmp_path):
    shutil.copy(EXAMPLE / "recordings.csv", tmp_path)
    for command in (armscope.diagnose, armscope.calibrate, armscope.compare):
        with pytest.raises(InputError, match="the nominal arm must be known"):
            command(tmp_path)
        with pytest.raises(InputError, match="the nominal arm must be known"):
            command(pd.DataFrame({"q1_rad": np.zeros(3)}))


def test_one_recording_given_twice_is_told_as_that():
    with pytest.raises(InputError, match=r"one-effect more than once'; .*Was one file copied, or named twice\?"):
        armscope.compare(EXAMPLE, EXAMPLE)
    with pytest.raises(InputError, match="as many different names as recordings"):
        armscope.compare(EXAMPLE, EXAMPLE, names=["a", "a"])
    assert names_of([EXAMPLE, pd.DataFrame()], ()) == [str(EXAMPLE), "2"]


def test_only_what_is_public_is_listed():
    assert sorted(name for name in dir(armscope) if not name.startswith("__")) == sorted(armscope.__all__)


@pytest.mark.parametrize(
    ("command", "given"),
    [
        (armscope.diagnose, (EXAMPLE,)),
        (armscope.calibrate, (EXAMPLE,)),
        (armscope.choose_poses, (EXAMPLE / "robot.yaml",)),
        (armscope.compensate, ("model.yaml", "wanted.csv")),
    ],
)
def test_an_option_that_a_command_has_not_is_one_error(command, given):
    with pytest.raises(
        InputError, match=f"{command.__name__}: found 'colour'; an option of {command.__name__} is one of"
    ):
        command(*given, colour="red")


def test_the_nearest_option_is_named():
    with pytest.raises(InputError, match="Did you mean 'robust'"):
        armscope.calibrate(EXAMPLE, robustt=True)


def test_a_drawing_is_short_in_words():
    drawing = Drawing(100, 50, "an arm")
    drawing.line(np.zeros((4000, 2)))
    assert len(repr(drawing)) < 100
    assert "an arm" in repr(drawing)


def test_recordings_in_a_list_are_asked_for_one_after_the_other():
    with pytest.raises(InputError, match=r"found 'a list'; two or more .* one after the other.*\*recordings"):
        armscope.compare([EXAMPLE, EXAMPLE])
    with pytest.raises(InputError, match="no recordings"):
        armscope.compare()
