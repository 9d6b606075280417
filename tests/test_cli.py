"""Whatever is given to a command in place of a file, the answer is one clear sentence, never a traceback."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.files import read_json
from armscope.core.inputs import InputError

EXAMPLE = Path(__file__).parents[1] / "examples" / "five-effects"
ROBOT, RECORDINGS = EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv"
REFERENCE = Path(__file__).parents[1] / "config" / "recordings" / "ur10-ipa" / "reference.yaml"

READERS = [
    "diagnose BAD -r ROBOT -o OUT",
    "diagnose RECORDINGS -r BAD -o OUT",
    "predict BAD RECORDINGS -o OUT",
    "compensate BAD RECORDINGS -o OUT.csv",
    "fit-error-model BAD -r ROBOT -o OUT",
    "fit-error-model RECORDINGS -r BAD -o OUT",
    "check BAD",
    "check RECORDINGS -r BAD",
    "calibrate BAD -r ROBOT -o OUT",
    "import RECORDINGS -m BAD -o OUT",
    "fetch BAD -o OUT",
    "closed-loop ROBOT --poses BAD --errors BAD --robots BAD --fits BAD -o OUT",
    "regions --poses BAD --errors BAD -o OUT",
    "products --poses BAD --errors BAD -o OUT",
    "paper residuals BAD BAD BAD -o OUT",
    "paper table2 BAD -o OUT",
    "paper coefficients BAD -o OUT",
    "paper cross-check BAD --fits BAD -o OUT",
    "paper sub-volumes BAD --errors BAD -o OUT",
    "paper claims BAD --sensitivity BAD -o OUT",
    "paper reading BAD -o OUT",
    "paper convergence-figure BAD -o OUT",
    "sweep draw BAD -o OUT",
    "poses -r BAD -o OUT.csv",
    "proof worlds ROBOT --size small --half fresh --part 0/1 --seed-file BAD --visible OUT --sealed OUT",
    "proof report OUT OUT BAD -o OUT",
    "real protocol BAD ROBOT REFERENCE -o OUT",
    "real protocol RECORDINGS BAD REFERENCE -o OUT",
    "real protocol RECORDINGS ROBOT BAD -o OUT",
]
FOLDER_READERS = [
    "paper figure fig04 BAD -o OUT",
    "proof diagnose BAD -o OUT",
    "proof score BAD -o OUT",
    "proof figures BAD -o OUT",
    "real score BAD -o OUT",
    "real report BAD BAD -o OUT",
]


def error_of(line, **places):
    """The exception that ends a command; words of ``line`` in capitals stand for files."""
    for name, place in (places | {"ROBOT": ROBOT, "RECORDINGS": RECORDINGS, "REFERENCE": REFERENCE}).items():
        line = line.replace(name, str(place))
    return CliRunner().invoke(app, line.split()).exception


def bad_file(kind, tmp_path):
    path = tmp_path / f"bad-{kind}.csv"
    if kind == "folder":
        path.mkdir()
    elif kind == "empty":
        path.touch()
    elif kind == "binary":
        path.write_bytes(bytes(range(128, 256)) * 9)
    elif kind == "other":
        path.write_text("a,b\n1,2\n")
    return path


@pytest.mark.parametrize("kind", ["missing", "folder", "empty", "binary", "other"])
@pytest.mark.parametrize("line", READERS)
def test_a_file_that_is_none_is_named(line, kind, tmp_path):
    bad = bad_file(kind, tmp_path)
    error = error_of(line, BAD=bad, OUT=tmp_path / "out")
    assert isinstance(error, InputError), repr(error)
    assert str(bad) in str(error) or (line.startswith("proof report") and "folder" in str(error))
    assert "np." not in str(error)
    assert not (tmp_path / "out").exists()


def test_a_table_is_not_called_a_workbook(tmp_path):
    error = error_of("poses -r ROBOT -o OUT", OUT=tmp_path / "poses.xlsx")
    assert isinstance(error, InputError)
    assert "Call it poses.csv" in str(error)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("target", ["nowhere.csv", "link.csv"])
def test_a_link_that_leads_nowhere_is_no_spelling_mistake(target, tmp_path):
    (tmp_path / "link.csv").symlink_to(tmp_path / target)
    error = error_of("check BAD", BAD=tmp_path / "link.csv")
    assert isinstance(error, InputError)
    assert f"a link to {tmp_path / target}, where no file is" in str(error)


@pytest.mark.parametrize(
    ("there", "asked", "meant"),
    [
        ("recordings.csv.gz", "recordings.csv", "recordings.csv.gz"),
        ("recordings.csv", "recordings.cvs", "recordings.csv"),
        ("recordings.csv", "recodings.csv", "recordings.csv"),
        ("other.txt", "recordings.csv", None),
        (".recordings", "recordings.csv", None),
    ],
)
def test_a_file_that_is_not_there_is_likened_to_one_beside_it(there, asked, meant, tmp_path):
    (tmp_path / there).touch()
    told = str(error_of("check BAD", BAD=tmp_path / asked))
    assert (f"{meant}'?" in told) if meant else ("Did you mean" not in told)


def test_an_arm_of_the_library_with_a_slip_in_its_name_is_told(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert "Did you mean 'ur5e'?" in str(error_of("check RECORDINGS --robot ur5ee"))


def test_tables_that_are_compared_without_an_arm_ask_for_it():
    told = str(error_of("compare RECORDINGS RECORDINGS"))
    assert re.search(r"Add --robot \S+/five-effects/robot.yaml;", told), told


@pytest.mark.parametrize("line", FOLDER_READERS)
def test_a_folder_that_is_none_is_named(line, tmp_path):
    error = error_of(line, BAD=tmp_path / "nowhere", OUT=tmp_path / "out")
    assert isinstance(error, InputError), repr(error)
    assert "nowhere" in str(error)


@pytest.mark.parametrize(
    "line",
    [
        "diagnose RECORDINGS -r ROBOT -o BAD",
        "calibrate RECORDINGS -r ROBOT -o BAD",
        "fit-error-model RECORDINGS -r ROBOT -o BAD/m.json",
    ],
)
def test_an_output_that_cannot_be_written_is_said(line, tmp_path):
    taken = tmp_path / "taken"
    taken.write_text("a file where a folder should be")
    error = error_of(line, BAD=taken)
    assert isinstance(error, InputError), repr(error)
    assert str(taken) in str(error)


def test_bad_input_is_one_line_and_exit_code_2(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", "from armscope.cli import main; main()", "diagnose", "no.csv", "-r", ROBOT, "-o", "out"],
        capture_output=True, text=True, cwd=tmp_path, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("armscope: no.csv: found no readable file")
    assert done.stderr.count("\n") == 1


@pytest.mark.long
def test_a_robot_may_be_named(tmp_path):
    line = f"poses -n 8 --candidates 30 --seeds 2 -o {tmp_path / 'poses.csv'} -r"
    named = CliRunner().invoke(app, [*line.split(), "puma560"])
    assert named.exit_code == 0, named.exception
    assert "the library's" in named.stderr
    error = CliRunner().invoke(app, [*line.split(), "puma561"]).exception
    assert isinstance(error, InputError)
    assert "a name (armscope init --list)" in str(error)


@pytest.mark.parametrize(("words", "told"), [
    ("help", "Usage: armscope"), ("help diagnose", "Usage: armscope diagnose"), ("-h", "See where a robot arm"),
    pytest.param("diagnose -h", "Find where simulation", marks=pytest.mark.long), ("version", "armscope 0."),
])  # fmt: skip
def test_who_asks_for_help_or_the_version_gets_it_however_it_is_asked(words, told):
    answer = subprocess.run([sys.executable, "-m", "armscope", *words.split()], capture_output=True, text=True)
    assert answer.returncode == 0
    assert told in answer.stdout
    assert not answer.stderr


def test_help_says_how_to_start():
    text = CliRunner().invoke(app, ["--help"]).output
    assert "armscope diagnose recordings.csv --robot robot.yaml" in text
    assert text.index("diagnose ") < text.index("Experiments") < text.index("closed-loop")
    assert CliRunner().invoke(app, ["--version"]).output.startswith("armscope ")


MISTAKES = ["left-handed", "metres", "reverse order"]
ONE_MISTAKE = [MISTAKES[0], *(pytest.param(each, marks=pytest.mark.long) for each in MISTAKES[1:])]
"""That each is told is asked of `diagnose --anyway`, and of the check itself in `tests/check/`."""


@pytest.fixture
def mistaken(request, tmp_path):
    """The example's recordings with a mistake that the reader cannot see; its file and a word that names it."""
    table = pd.read_csv(RECORDINGS)
    angles = [f"q{j}_rad" for j in range(1, 7)]
    if request.param == "left-handed":
        table["y_mm"] *= -1
    elif request.param == "metres":
        table[["x_mm", "y_mm", "z_mm"]] /= 1e3
    else:
        table[angles] = table[angles[::-1]].to_numpy()
    table.to_csv(tmp_path / "mistaken.csv", index=False)
    return tmp_path / "mistaken.csv", request.param


@pytest.mark.long
@pytest.mark.parametrize("mistaken", ONE_MISTAKE, indirect=True)
def test_an_arm_that_does_not_explain_the_points_is_not_calibrated_unless_asked_for(mistaken, tmp_path):
    file, word = mistaken
    error = error_of("calibrate BAD -r ROBOT -o OUT --splits 0", BAD=file, OUT=tmp_path / "out")
    assert isinstance(error, InputError)
    assert word in str(error)
    assert "--anyway" in str(error)
    assert not (tmp_path / "out" / "robot.yaml").exists()
    assert error_of("calibrate BAD -r ROBOT -o OUT --splits 2 --anyway", BAD=file, OUT=tmp_path / "out") is None
    assert (tmp_path / "out" / "robot.yaml").exists()


QUICK = "--resamples 0 --no-cross-validation --no-report"


@pytest.mark.parametrize("mistaken", ONE_MISTAKE, indirect=True)
def test_a_diagnosis_of_mistaken_recordings_is_not_made_unless_asked_for(mistaken, tmp_path):
    """One judgement of a table, the check's: what it calls a problem ends a diagnosis, and nothing is written."""
    file, word = mistaken
    error = error_of(f"diagnose BAD -r ROBOT -o OUT {QUICK}", BAD=file, OUT=tmp_path / "out")
    assert isinstance(error, InputError)
    assert word in str(error)
    assert word in CliRunner().invoke(app, f"check {file} -r {ROBOT}".split()).stdout
    assert not (tmp_path / "out" / "verdict.json").exists()


@pytest.mark.parametrize("mistaken", ONE_MISTAKE, indirect=True)
def test_a_diagnosis_of_mistaken_recordings_says_what_is_wrong_with_them(mistaken, tmp_path):
    file, word = mistaken
    line = f"diagnose {file} -r {ROBOT} -o {tmp_path / 'out'} {QUICK} --anyway"
    result = CliRunner().invoke(app, line.split())
    assert word in result.stderr
    assert "Cannot tell" in result.stdout


@pytest.mark.long
def test_what_is_wrong_with_one_run_stands_in_the_verdict_too(tmp_path):
    table = pd.read_csv(EXAMPLE.parent / "clean" / "recordings.csv", dtype={"run": str})
    table.loc[table["run"] == "2", ["x_mm", "y_mm", "z_mm"]] /= 1000
    table["temperature_c"] += 273.15
    table.to_csv(tmp_path / "mistaken.csv", index=False)
    line = f"diagnose {tmp_path / 'mistaken.csv'} -r {EXAMPLE.parent / 'clean' / 'robot.yaml'} -o {tmp_path / 'out'}"
    result = CliRunner().invoke(app, [*line.split(), *QUICK.split(), "--anyway"])
    assert result.stdout.startswith(("These recordings cannot be relied on", "Cannot tell"))
    told = " ".join(notice["text"] for notice in read_json(tmp_path / "out" / "verdict.json", "")["notices"])
    for words in ("metres that were declared as millimetres in run 2", "kelvin"):
        assert words in result.stderr
        assert words in told


@pytest.mark.long
@pytest.mark.parametrize(("name", "code"), [("clean", 0), ("one-effect", 10)])
def test_the_exit_code_is_the_answer_only_where_asked_for(name, code, tmp_path):
    home = EXAMPLE.parent / name
    line = f"diagnose {home / 'recordings.csv'} -r {home / 'robot.yaml'} -o {tmp_path / 'out'} {QUICK}"
    assert CliRunner().invoke(app, f"{line} --exit-code".split()).exit_code == code
    if code:
        assert CliRunner().invoke(app, line.split()).exit_code == 0
    assert (tmp_path / "out" / "verdict.json").exists()


def test_orientations_that_are_not_the_tools_take_no_part_in_a_calibration(tmp_path):
    table = pd.read_csv(RECORDINGS)
    turned = Rotation.random(len(table), rng=np.random.default_rng(0)).as_quat()
    for number, name in enumerate(("qw", "qx", "qy", "qz")):
        table[name] = turned[:, number]
    table.to_csv(tmp_path / "turned.csv", index=False)
    line = f"calibrate {tmp_path / 'turned.csv'} -r {ROBOT} -o {tmp_path / 'out'} --splits 0"
    result = CliRunner().invoke(app, line.split())
    assert result.exit_code == 0, result.output
    assert "orientations scatter" in result.stderr
    assert "Positions are used alone" in result.stderr
    assert "orientations used" not in result.stdout
