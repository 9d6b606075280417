"""A table comes from a pipe as from a file: standard input, a named pipe, what a shell puts in place of a command."""

import json
import os
import threading
from pathlib import Path

import pandas as pd
import pytest
from tests.test_init import plain_urdf
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"
ROBOT, TABLE = EXAMPLES / "one-effect" / "robot.yaml", EXAMPLES / "one-effect" / "recordings.csv"


def run(*words, given=None):
    done = CliRunner().invoke(app, [str(word) for word in words], input=given)
    assert done.exit_code == 0, (done.output, done.exception)
    return done.stdout


def by_pipe(folder, content, *words):
    """What a command prints that is given a named pipe in place of PIPE."""
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_bytes, args=(content,), daemon=True)
    writer.start()
    told = run(*(pipe if word == "PIPE" else word for word in words))
    writer.join(timeout=10)
    assert not writer.is_alive()
    pipe.unlink()
    return told


def test_check_says_the_same_of_a_pipe_of_standard_input_and_of_a_file(tmp_path):
    of_file = run("check", TABLE, "-r", ROBOT).replace(str(TABLE), "TABLE")
    assert (
        by_pipe(tmp_path, TABLE.read_bytes(), "check", "PIPE", "-r", ROBOT).replace(str(tmp_path / "pipe"), "TABLE")
        == of_file
    )
    assert run("check", "-", "-r", ROBOT, given=TABLE.read_bytes()).replace("-: 60", "TABLE: 60") == of_file


def test_motions_come_by_a_pipe_packed_as_they_are(tmp_path):
    arm = EXAMPLES / "moving-arm"
    told = by_pipe(tmp_path, (arm / "motions.csv.gz").read_bytes(), "check", "PIPE", "-r", arm / "robot.yaml", "--json")
    assert "suspicions" in json.loads(told)


def test_poses_and_paths_come_by_standard_input(tmp_path):
    words = ("predict", ROBOT, "-", "-o", tmp_path / "points.csv")
    run(*words, given=TABLE.read_bytes())
    assert len(pd.read_csv(tmp_path / "points.csv")) == len(pd.read_csv(TABLE))


def test_foreign_tables_are_drafted_and_imported_from_a_pipe(tmp_path):
    table = pd.read_csv(TABLE)
    angles = {f"q{j}_rad": f"Joint{j}" for j in range(1, 7)}
    foreign = table.rename(columns=angles | {"x_mm": "X", "y_mm": "Y", "z_mm": "Z"})
    foreign = foreign[[*angles.values(), "X", "Y", "Z"]].to_csv(sep=";", index=False).encode()
    mapping, made = tmp_path / "mapping.yaml", tmp_path / "made.csv"
    by_pipe(tmp_path, foreign, "init", "PIPE", "-o", mapping)
    by_pipe(tmp_path, foreign, "import", "PIPE", "-m", mapping, "-o", made)
    assert len(pd.read_csv(made)) == len(table)


def test_a_urdf_on_a_pipe_is_one_error(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    threading.Thread(target=pipe.write_text, args=(plain_urdf(3),), daemon=True).start()
    done = CliRunner().invoke(app, ["init", str(pipe), "-o", str(tmp_path / "robot.yaml")])
    assert isinstance(done.exception, InputError)
    assert "must stay a file" in str(done.exception)


@pytest.mark.long
def test_a_named_pipe_is_diagnosed(tmp_path):
    words = ("diagnose", "PIPE", "-r", ROBOT, "-o", tmp_path / "out", "--no-report", "--resamples", "0")
    assert "Joint 2" in by_pipe(tmp_path, TABLE.read_bytes(), *words)


def test_quiet_silences_words_and_no_data(tmp_path):
    """`predict -o - --quiet` wrote nothing, and so did every `--json --quiet`, with exit code 0."""
    assert run("predict", ROBOT, TABLE, "-o", "-", "--quiet") == run("predict", ROBOT, TABLE, "-o", "-")
    assert "suspicions" in json.loads(run("check", TABLE, "-r", ROBOT, "--json", "--quiet"))
    assert run("check", TABLE, "-r", ROBOT, "--quiet") == ""
