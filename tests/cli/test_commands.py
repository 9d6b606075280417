"""A folder of worlds is read, never written: no command takes it for an output of the same name."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.core.locks import Lock

EXAMPLE = Path(__file__).parents[2] / "examples" / "one-effect"


def told_of(*words: str) -> str:
    """What a command that ends with an error says."""
    done = CliRunner().invoke(app, list(words))
    assert isinstance(done.exception, InputError), done.output
    return str(done.exception)


@pytest.fixture
def worlds(tmp_path: Path) -> Path:
    (tmp_path / "worlds" / "some").mkdir(parents=True)
    (tmp_path / "worlds" / "some" / "robot.yaml").write_text("name: none\n")
    return tmp_path / "worlds"


@pytest.mark.parametrize("command", ["proof diagnose", "proof motion diagnose"])
def test_worlds_that_are_diagnosed_are_not_written(command: str, worlds: Path, monkeypatch) -> None:
    """Two commits can diagnose the same worlds side by side."""
    taken: list[str] = []
    monkeypatch.setattr(Lock, "take", lambda lock: taken.append(lock.what))
    monkeypatch.setattr("armscope.proof.diagnosing.diagnose_worlds", lambda *_: None)
    monkeypatch.setattr("armscope.proof.motion.diagnosing.diagnose_worlds", lambda *_: None)
    done = CliRunner().invoke(app, [*command.split(), str(worlds), "-o", str(worlds.parent / "verdicts")])
    assert done.exception is None or isinstance(done.exception, SystemExit)
    assert [what.split(":")[0] for what in taken] == [str(worlds.parent / "verdicts")]


def test_several_files_go_into_no_file_with_force_or_without(tmp_path: Path) -> None:
    (tmp_path / "afile").write_text("mine")
    table, robot = (str(EXAMPLE / name) for name in ("recordings.csv", "robot.yaml"))
    for force in ((), ("--force",)):
        told = told_of("diagnose", table, "--robot", robot, "-o", str(tmp_path / "afile"), *force)
        assert "afile: found 'a file'; needed here: folder for report" in told
        assert "--force" not in told


def test_what_is_no_file_but_an_arm_of_the_library_is_told_as_that() -> None:
    told = told_of("predict", "ur5e", str(EXAMPLE / "recordings.csv"), "-o", "x.csv")
    assert "ur5e is an arm of the library, and no file: `armscope init ur5e -o robot.yaml` writes one." in told
    assert "Did you mean" not in told
    assert "Did you mean 'ur5e'?" in told_of("check", str(EXAMPLE / "recordings.csv"), "--robot", "ur5ee")
    assert "Did you mean" not in told_of("predict", "ur5ee", str(EXAMPLE / "recordings.csv"), "-o", "x.csv")


def test_a_folder_in_the_place_of_a_file_is_told_with_what_it_holds(tmp_path: Path) -> None:
    table = str(EXAMPLE / "recordings.csv")
    for words in (("check", table, "--robot", str(EXAMPLE)), ("predict", str(EXAMPLE), table, "-o", "x.csv")):
        told = told_of(*words)
        assert "found no readable file, but a folder; a YAML file is needed here" in told
        assert f"Name the file in it: {EXAMPLE / 'robot.yaml'}" in told
    told = told_of("predict", str(EXAMPLE / "robot.yaml"), str(EXAMPLE), "-o", "x.csv")
    assert f"Name the file in it: {EXAMPLE / 'recordings.csv'}" in told
    assert "it has none that could be meant" in told_of("predict", str(tmp_path), table, "-o", "x.csv")


def test_advice_about_a_file_names_it_as_it_was_named(tmp_path: Path) -> None:
    robot, foreign = str(EXAMPLE / "robot.yaml"), tmp_path / "a log.csv"
    told = told_of("diagnose", robot, "--robot", robot, "-o", "x")
    assert "YAML, 'name: 120 kg parallelogram arm'" in told
    assert "A robot.yaml is given by --robot" in told
    foreign.write_text("q1_rad;q2_rad;x_mm\n1;2;3\n")
    assert f"`armscope init '{foreign}' -o mapping.yaml`" in told_of("check", str(foreign))


@pytest.mark.parametrize("line", ["compare TABLE TABLE -o -", "calibrate TABLE -o /dev/stdout", "diagnose TABLE -o -"])
def test_a_folder_is_no_standard_output(line: str, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    said = told_of(*line.replace("TABLE", str(EXAMPLE / "recordings.csv")).split(), "-r", str(EXAMPLE / "robot.yaml"))
    assert "no folder, but a stream; needed here: folder" in said
    assert not list(tmp_path.iterdir())
