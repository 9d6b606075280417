"""A table of points and a table of motions: what belongs to the other kind is told, not passed over."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"
POINTS, MOTIONS = EXAMPLES / "one-effect", EXAMPLES / "moving-arm"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("diagnose MOTIONS -r ARM -o OUT --tool-per-run", "--tool-per-run"),
        ("diagnose MOTIONS -r ARM -o OUT --first-id 3", "--first-id"),
        ("diagnose MOTIONS -r ARM -o OUT --estimate-gravity", "--estimate-gravity"),
        ("diagnose MOTIONS -r ARM -o OUT --held-out run1 --held-out run2", "Hold out fewer"),
        ("diagnose POINTS -r ROBOT -o OUT --cutoff 8", "--cutoff"),
        ("diagnose POINTS -r ROBOT -o OUT --held-out a", "--held-out"),
        ("calibrate MOTIONS -r ARM -o OUT", "table of an arm in motion"),
        ("compare MOTIONS MOTIONS -r ARM", "table of an arm in motion"),
        ("compensate MODEL POINTS -o OUT.csv", "model of|of an arm in motion"),
    ],
)
def test_what_is_for_the_other_kind_is_one_error(words, told, tmp_path):
    model = Path(__file__).parents[1] / "fuzz" / "corpus" / "motion-model" / "moving-arm.yaml"
    places = {
        "MOTIONS": MOTIONS / "motions.csv.gz",
        "ARM": MOTIONS / "robot.yaml",
        "POINTS": POINTS / "recordings.csv",
        "ROBOT": POINTS / "robot.yaml",
        "MODEL": model,
        "OUT": tmp_path / "out",
        "OUT.csv": tmp_path / "out.csv",
    }
    error = CliRunner().invoke(app, [str(places.get(word, word)) for word in words.split()]).exception
    assert isinstance(error, InputError), repr(error)
    assert any(each in str(error) for each in told.split("|")), str(error)
    assert not (tmp_path / "out").exists()
