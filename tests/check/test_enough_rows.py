"""A table that is too short for a diagnosis says how many rows one needs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.check.enough_rows import rows_needed, still, too_few
from armscope.check.preconditions import refuse_unusable
from armscope.check.report import check
from armscope.core.inputs import InputError
from armscope.recordings import read_recordings
from armscope.robot import load_arm

FOLDER = Path(__file__).parents[2] / "examples" / "one-effect"


@pytest.fixture(scope="module")
def arm():
    return load_arm(FOLDER / "robot.yaml")


@pytest.fixture(scope="module")
def table():
    return read_recordings(FOLDER / "recordings.csv")


@pytest.mark.parametrize(("rows", "said"), [(2, "2 rows"), (6, "6 rows"), (14, "14 rows"), (15, ""), (60, "")])
def test_check_says_when_a_diagnosis_would_not_begin(rows, said, arm, table):
    few = table.rows(np.arange(len(table)) < rows)
    for told in (check(few, arm).text(), check(few).text()):
        assert ("a diagnosis needs 15 at least" in told) == bool(said)
        assert said in told
    assert rows_needed(arm, few) == 15


def test_many_runs_need_more_rows_as_a_diagnosis_does(arm, table):
    few = table.rows(np.arange(len(table)) < 20)
    of_runs = replace(few, run=np.array([str(n // 4) for n in range(20)]))
    needed = rows_needed(arm, of_runs)
    assert needed > 20
    assert f"needs {needed} at least" in too_few(of_runs, arm)[0].text()
    assert too_few(of_runs, None) == []


def test_one_row_is_told_as_few_rows_not_as_joints_that_stand(arm, table):
    one = table.rows(np.arange(len(table)) < 1)
    with pytest.raises(InputError) as error:
        refuse_unusable(arm, one)
    assert "found '1 row in which every joint stands still'" in str(error.value)
    assert "needs 15 rows at least" in str(error.value)
    assert "--anyway" not in str(error.value), "it would not help"
    assert check(one, arm).text().count("15") == 1
    assert still(table) == []
