"""`armscope compare` judges each table as `armscope check` and `diagnose` do, before it compares."""

from pathlib import Path

import pandas as pd
import pytest
from tests.comparison.test_changes import session
from typer.testing import CliRunner

from armscope.cli import app
from armscope.cli.comparison import _names
from armscope.core.inputs import InputError

ROBOT = Path(__file__).parents[2] / "examples" / "five-effects" / "robot.yaml"


def inches(table):
    return table.assign(**{f"{axis}_mm": table[f"{axis}_mm"] / 25.4 for axis in "xyz"})


def turned(table):
    return table.assign(q5_rad=-table["q5_rad"])


def mirrored(table):
    return table.assign(y_mm=-table["y_mm"])


def late(table):
    points = [f"{axis}_mm" for axis in "xyz"]
    return table.assign(**table[points].shift(1)).iloc[1:]


@pytest.fixture
def folder(tmp_path):
    for name, seed in (("good", 1), ("bad", 2)):
        made = session(seed)
        columns = {f"q{j + 1}_rad": made.motor_angles[:, j] for j in range(6)}
        columns |= {f"{axis}_mm": 1e3 * made.positions[:, k] for k, axis in enumerate("xyz")}
        pd.DataFrame(columns).to_csv(tmp_path / f"{name}.csv", index=False)
    return tmp_path


def compared(folder, *options):
    tables = [str(folder / f"{name}.csv") for name in ("good", "bad")]
    return CliRunner().invoke(app, ["compare", *tables, "--robot", str(ROBOT), *options])


@pytest.mark.parametrize(("spoilt", "told"), [(inches, "inches"), (turned, "other way"), (mirrored, "other way")])
def test_a_table_that_a_diagnosis_refuses_is_not_compared_and_named(spoilt, told, folder):
    """Seen: "No cause differs (p = 1)" of a table in inches, and exit code 0."""
    spoilt(pd.read_csv(folder / "bad.csv")).to_csv(folder / "bad.csv", index=False)
    error = compared(folder, "-o", str(folder / "out")).exception
    assert isinstance(error, InputError)
    assert "bad.csv" in str(error)
    assert told in str(error)
    assert "--anyway compares it all the same" in str(error)
    assert not (folder / "out").exists()


def test_points_of_the_row_before_are_not_compared(folder):
    late(pd.read_csv(folder / "bad.csv")).to_csv(folder / "bad.csv", index=False)
    assert "too late for the joint angles" in str(compared(folder).exception)


def test_whoever_wants_it_compared_all_the_same_has_it(folder):
    inches(pd.read_csv(folder / "bad.csv")).to_csv(folder / "bad.csv", index=False)
    result = compared(folder, "--anyway")
    assert result.exit_code == 0, result.exception
    assert "noise" in result.stdout


def test_tables_that_can_be_used_are_compared(folder):
    result = compared(folder)
    assert result.exit_code == 0, result.exception
    assert "Nothing changed that these recordings show" in result.stdout


@pytest.mark.parametrize(
    ("files", "names"),
    [
        (["a/may.csv", "a/june.csv", "a/may.csv"], ["1: may", "2: june", "3: may"]),
        (["a/may.csv", "a/june.csv", "b/may.csv"], ["a/may", "a/june", "b/may"]),
        (["a/recordings.csv", "b/recordings.csv.gz"], ["a", "b"]),
        (["a/may.csv", "b/june.csv"], ["may", "june"]),
        (["a", "b"], ["a", "b"]),
    ],
)
def test_recordings_are_called_by_what_tells_them_apart(files, names, tmp_path):
    for file in files:
        path = tmp_path / file
        (path if "." not in file else path.parent).mkdir(exist_ok=True)
        if "." in file:
            path.touch()
    assert _names([tmp_path / file for file in files]) == names


def test_recordings_from_pipes_are_called_as_they_were_given():
    assert _names([Path("/dev/fd/63"), Path("/dev/fd/62"), Path("-")]) == ["63", "62", "-"]
