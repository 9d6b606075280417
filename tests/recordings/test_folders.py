"""A folder in place of a table: its own recordings and robot.yaml are read, and what is missing or twofold is told."""

import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.recordings.folders import others_than, robot_for, robot_in, table_in

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_a_folder_is_its_table_and_its_arm():
    points, motions = EXAMPLES / "clean", EXAMPLES / "moving-arm"
    assert table_in(points) == points / "recordings.csv"
    assert table_in(motions) == motions / "motions.csv.gz"
    assert robot_for(None, points) == points / "robot.yaml"


def test_what_was_named_is_taken_as_it_is():
    table = EXAMPLES / "clean" / "recordings.csv"
    assert table_in(table) == table
    assert robot_for(Path("ur5e"), EXAMPLES / "clean") == Path("ur5e")
    assert robot_in(table) is None, "an arm that only lies beside a table was not given"


def test_an_arm_beside_a_table_is_named_in_the_error():
    with pytest.raises(InputError, match=str(EXAMPLES / "clean" / "robot.yaml")):
        robot_for(None, EXAMPLES / "clean" / "recordings.csv")


@pytest.mark.parametrize(
    ("names", "told"), [([], "without any"), (["recordings.csv", "motions.csv"], "recordings.csv and motions.csv")]
)
def test_a_folder_with_no_table_or_two_is_one_error(names, told, tmp_path):
    for name in names:
        (tmp_path / name).touch()
    with pytest.raises(InputError, match=told):
        table_in(tmp_path)


@pytest.mark.parametrize("command", ["check", "calibrate", "diagnose"])
def test_commands_write_the_same_for_a_folder_as_for_its_files(command, tmp_path):
    folder = EXAMPLES / "one-effect"
    words = {"diagnose": ["--no-report", "--resamples", "0", "--no-cross-validation"], "calibrate": ["--splits", "0"]}
    said = []
    for given in ([folder], [folder / "recordings.csv", "--robot", folder / "robot.yaml"]):
        output = [] if command == "check" else ["-o", tmp_path / str(len(given))]
        result = CliRunner().invoke(app, [command, *map(str, [*given, *words.get(command, []), *output])])
        assert not isinstance(result.exception, InputError), result.exception
        said.append(result.output.replace(str(folder / "recordings.csv"), str(folder)).replace("/3/", "/1/"))
    assert said[0].replace("/recordings.csv", "") == said[1].replace("/recordings.csv", "")
    written = [{path.name: path.read_bytes() for path in tmp_path.glob(f"{n}/*") if path.is_file()} for n in (1, 3)]
    assert written[0] == written[1]


def test_what_lies_in_the_folder_is_an_input_and_never_overwritten(tmp_path):
    folder = tmp_path / "own"
    shutil.copytree(EXAMPLES / "one-effect", folder)
    before = (folder / "robot.yaml").read_bytes()
    words = ["calibrate", str(folder), "-o", str(folder), "--splits", "0", "--force"]
    assert isinstance(CliRunner().invoke(app, words).exception, InputError)
    assert (folder / "robot.yaml").read_bytes() == before


@pytest.mark.long
def test_another_arm_in_a_later_folder_is_told(tmp_path):
    for name, source in (("before", "clean"), ("again", "clean"), ("after", "one-effect")):
        shutil.copytree(EXAMPLES / source, tmp_path / name)
    before, again, after = (tmp_path / name for name in ("before", "again", "after"))
    own = (before / "robot.yaml").read_text()
    (after / "robot.yaml").write_text(own.replace("name:", "# mended by hand\nname:", 1))
    assert others_than(before / "robot.yaml", [before, again, after]) == [after / "robot.yaml"]
    words = ["compare", *(str(tmp_path / name) for name in ("before", "after"))]
    assert "after/robot.yaml differs from" in CliRunner().invoke(app, words).stderr
