"""Nothing that a user has is overwritten, mixed or lost, and what a command writes appears together or not at all."""

import json
import os
import shutil
import signal
import stat
import subprocess
import sys
import threading
from pathlib import Path
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from armscope.cli import app as armscope
from armscope.cli.commands import Commands
from armscope.core.files import replacing, writable, write_text
from armscope.core.inputs import InputError
from armscope.core.locks import Busy

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "five-effects"

toy = Commands()


@toy.command()
def folder(
    output: Annotated[Path, typer.Option("-o")],
    names: Annotated[list[str], typer.Argument()],
    source: Annotated[Path | None, typer.Option()] = None,
    end: str = "",
):
    """Write files of some names into a folder."""
    writable(output, *names)
    for name in names:
        write_text(output / name, f"{name} {source.read_text() if source else ''}")
        if end == "error":
            raise RuntimeError
    if end == "found":
        raise typer.Exit(1)


@toy.command()
def file(
    output: Annotated[Path, typer.Option("-o")],
    source: Annotated[Path | None, typer.Option()] = None,
    text: str = "made",
    beside: bool = False,
):
    """Write a file, and another beside it."""
    write_text(output, text)
    if beside:
        write_text(output.with_suffix(".json"), text)
    print("words")


def run(*words, app=toy):
    return CliRunner().invoke(app, [str(word) for word in words])


def refused(*words, app=toy):
    error = run(*words, app=app).exception
    assert isinstance(error, InputError), repr(error)
    return str(error)


def tree(folder):
    """What a user sees: names and contents without the hidden folder."""
    seen = (path for path in sorted(folder.rglob("*")) if ".armscope" not in path.parts and path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_text() for path in seen}


def leftovers(folder):
    """What should be gone when a command has ended: drafts, plans, locks."""
    return [path for path in folder.rglob("*") if path.suffix in (".part", ".new", ".plan", ".lock")]


# what is the user's


def aliases(path):
    """Other names of a file."""
    path.with_name("hard").hardlink_to(path)
    path.with_name("soft").symlink_to(path)
    path.with_name("sub").mkdir()
    return [path, path.with_name("hard"), path.with_name("soft"), path.with_name("sub") / ".." / path.name]


@pytest.mark.parametrize("force", [[], ["--force"]])
def test_an_input_is_never_overwritten_under_any_of_its_names(tmp_path, force):
    mine = tmp_path / "mine.csv"
    mine.write_text("mine")
    for name in aliases(mine):
        assert "an input of this command" in refused("file", "--source", mine, "-o", name, *force)
        assert "an input of this command" in refused("file", "--source", name, "-o", mine, *force)
        assert mine.read_text() == "mine"
    into = refused("folder", "--source", mine, "-o", tmp_path, "other", "mine.csv", *force)
    assert "an input of this command" in into
    assert not (tmp_path / "other").exists()
    assert leftovers(tmp_path) == []


@pytest.mark.parametrize(
    "line",
    [
        "predict OUT/robot.yaml OUT/recordings.csv -o OUT/recordings.csv",
        "predict OUT/robot.yaml OUT/recordings.csv -o OUT/robot.yaml",
        "calibrate OUT/recordings.csv -r OUT/robot.yaml -o OUT --splits 0",
        "diagnose OUT/predicted.csv -r OUT/robot.yaml -o OUT --no-report --resamples 0 --no-cross-validation",
        "fit-error-model OUT/recordings.csv -r OUT/robot.yaml -o OUT/recordings.csv",
        "import OUT/recordings.csv -m OUT/robot.yaml -o OUT/robot.yaml",
        "check OUT/recordings.csv -r OUT/robot.yaml --figure OUT/picture.png",
    ],
)
def test_no_command_overwrites_its_input_or_what_is_not_its_own(line, tmp_path):
    for name in ("robot.yaml", "recordings.csv"):
        shutil.copy(EXAMPLE / name, tmp_path / name)
    shutil.copy(EXAMPLE / "recordings.csv", tmp_path / "predicted.csv")
    (tmp_path / "picture.png").write_text("a picture of mine")
    before = tree(tmp_path)
    assert "an input of this" in (said := refused(*line.replace("OUT", str(tmp_path)).split(), app=armscope)) or (
        "picture.png" in said and "did not write" in said
    )
    assert tree(tmp_path) == before
    assert leftovers(tmp_path) == []


def test_a_file_that_a_description_names_is_an_input_too(tmp_path):
    arm = ROOT / "tests" / "robot" / "torso_arm.urdf"
    shutil.copy(arm, tmp_path / "arm.urdf")
    (tmp_path / "robot.yaml").write_text("name: an arm\nurdf: arm.urdf\ntip: nowhere\n")
    from armscope.core.outputs import Delivery
    from armscope.robot import load_arm

    with Delivery("any", [], [tmp_path / "out"]).running() as delivery:
        with pytest.raises(InputError):
            load_arm(tmp_path / "robot.yaml")
        for name in ("robot.yaml", "arm.urdf"):
            with pytest.raises(InputError, match="an input of this command"):
                delivery.stage(tmp_path / name)


def test_what_armscope_did_not_write_is_overwritten_only_when_forced(tmp_path):
    (tmp_path / "a").write_text("mine")
    assert "a file that armscope did not write" in refused("file", "-o", tmp_path / "a")
    assert "--force" in refused("folder", "-o", tmp_path, "b", "a")
    assert tree(tmp_path) == {"a": "mine"}
    assert run("file", "-o", tmp_path / "a", "--force").exit_code == 0
    assert tree(tmp_path) == {"a": "made"}
    (tmp_path / "c.json").write_text("mine")
    assert "c.json" in refused("file", "-o", tmp_path / "c.csv", "--beside")
    assert "c.csv" not in tree(tmp_path)  # both or none


def test_the_same_command_again_simply_works_and_a_file_that_was_edited_meanwhile_is_safe(tmp_path):
    for text in ("one", "two"):
        assert run("file", "-o", tmp_path / "a.csv", "--text", text, "--beside").exit_code == 0
        assert tree(tmp_path) == {"a.csv": text, "a.json": text}
    (tmp_path / "a.csv").write_text("edited")
    assert "changed since armscope wrote it" in refused("file", "-o", tmp_path / "a.csv")
    assert tree(tmp_path)["a.csv"] == "edited"


def test_another_commands_result_is_not_overwritten(tmp_path):
    assert run("folder", "-o", tmp_path / "out", "a").exit_code == 0
    assert "of another armscope result (folder)" in refused("file", "-o", tmp_path / "out" / "a")


def test_a_folder_holds_the_last_result_and_all_that_is_the_users(tmp_path):
    out = tmp_path / "new" / "out"
    assert run("folder", "-o", out, "a", "figures/b", "figures/c").exit_code == 0
    (out / "figures" / "mine").write_text("mine")
    (out / "a").write_text("edited, and not written again")
    assert run("folder", "-o", out, "figures/b", "d").exit_code == 2 or tree(out)["a"].startswith("edited")
    assert run("folder", "-o", out, "figures/b", "d", "--force").exit_code == 0
    assert tree(out) == {
        "a": "edited, and not written again", "d": "d ", "figures/b": "figures/b ", "figures/mine": "mine",
    }  # fmt: skip
    assert run("folder", "-o", out, "d").exit_code == 0
    assert sorted(tree(out)) == ["a", "d", "figures/mine"]
    assert leftovers(tmp_path) == []


def test_a_command_that_fails_leaves_everything_as_it_was(tmp_path):
    out = tmp_path / "out"
    assert run("folder", "-o", out, "a", "b", "--end", "error").exception
    assert list(tmp_path.iterdir()) == []
    assert run("folder", "-o", out, "a").exit_code == 0
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert run("folder", "-o", out, "a", "b", "--end", "error").exception
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_a_finding_is_no_failure(tmp_path):
    assert run("folder", "-o", tmp_path / "out", "a", "--end", "found").exit_code == 1
    assert tree(tmp_path) == {"out/a": "a "}


# what is no regular file


def test_a_link_stays_a_link_and_its_target_is_written(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    for name, link in (("a.csv", tmp_path / "link.csv"), ("out", tmp_path / "folder")):
        link.symlink_to(tmp_path / "elsewhere" / name)
    for _ in range(2):
        assert run("file", "-o", tmp_path / "link.csv").exit_code == 0
        assert run("folder", "-o", tmp_path / "folder", "b").exit_code == 0
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "folder").is_symlink()
    assert tree(tmp_path / "elsewhere") == {"a.csv": "made", "out/b": "b "}
    (tmp_path / "elsewhere" / "out" / "b").unlink()
    (tmp_path / "elsewhere" / "out" / "b").symlink_to(tmp_path / "elsewhere" / "far")
    assert run("folder", "-o", tmp_path / "folder", "b").exit_code == 0
    assert (tmp_path / "elsewhere" / "far").read_text() == "b "


def test_a_pipe_is_written_through(tmp_path):
    pipe, got = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: got.append(pipe.read_text()))
    reader.start()
    assert run("file", "-o", pipe).exit_code == 0
    reader.join()
    assert got == ["made"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


def test_a_dash_is_standard_output_and_words_go_elsewhere():
    result = run("file", "-o", "-")
    assert (result.stdout, result.stderr) == ("made", "words\n")


def command(*words, **options):
    code = "from armscope.cli import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, words)],
        capture_output=True, text=True, check=False, timeout=100, **options,
    )  # fmt: skip


PREDICT = ("predict", EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv", "-o")


def test_devices_are_written_through(tmp_path):
    to_file, to_device, to_stdout = tmp_path / "a.csv", command(*PREDICT, "/dev/stdout"), command(*PREDICT, "-")
    assert command(*PREDICT, to_file).returncode == 0
    assert to_device.stdout == to_stdout.stdout == to_file.read_text()
    assert command(*PREDICT, "/dev/null").returncode == 0
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    appended = tmp_path / "log"
    appended.write_text("before\n")
    with appended.open("a") as log:
        subprocess.run(
            [sys.executable, "-m", "armscope", *map(str, PREDICT), "/dev/stdout"], stdout=log, check=True
        )  # fmt: skip
    assert appended.read_text() == "before\n" + to_file.read_text()


# what goes wrong


def test_a_full_disk_is_one_line_with_an_exit_code_of_its_own():
    full = command(*PREDICT, "/dev/full")
    assert (full.returncode, full.stdout) == (74, "")
    assert full.stderr.startswith("armscope: ")
    assert "No space left on device" in full.stderr
    assert full.stderr.count("\n") == 1


@pytest.fixture
def small_disk(tmp_path):
    """A disk that holds a verdict, and no page beside it."""
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=256k", "none", tmp_path], capture_output=True, check=False
    )
    if made.returncode:
        pytest.skip("mounting a small disk needs rights that this user does not have")
    yield tmp_path
    subprocess.run(["umount", tmp_path], check=True)


def test_a_disk_that_fills_up_keeps_the_old_result(small_disk):
    out = small_disk / "out"
    line = ("diagnose", EXAMPLE / "recordings.csv", "-r", EXAMPLE / "robot.yaml", "-o", out, "--resamples", "0")
    assert command(*line, "--no-cross-validation", "--no-report").returncode == 0
    before = tree(out)
    full = command(*line, "--no-cross-validation")
    assert full.returncode == 74, full.stderr
    assert "No space left on device" in full.stderr
    assert full.stderr.count("\n") == 1
    assert tree(out) == before
    assert leftovers(small_disk) == []


def test_no_memory_is_one_line_with_an_exit_code_of_its_own(tmp_path):
    code = (
        "import sys\nimport armscope.physics.model_file as model\n"
        "def hungry(*_):\n    return bytearray(1 << 60)\n"
        "model.load_model = hungry\nfrom armscope.cli import main\nmain()"
    )
    (tmp_path / "model.yaml").write_text("{}")
    words = ["predict", tmp_path / "model.yaml", EXAMPLE / "recordings.csv", "-o", tmp_path / "out.csv"]
    done = subprocess.run([sys.executable, "-c", code, *map(str, words)], capture_output=True, text=True, check=False)
    assert done.returncode == 71, done.stderr
    assert done.stderr.startswith("armscope: out of memory")
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out.csv").exists()


def test_a_reader_that_goes_away_costs_no_result(tmp_path):
    line = [
        "calibrate",
        EXAMPLE / "recordings.csv",
        "-r",
        EXAMPLE / "robot.yaml",
        "-o",
        tmp_path / "out",
        "--splits",
        "0",
    ]
    code = "from armscope.cli import main; main()"
    running = subprocess.Popen(
        [sys.executable, "-c", code, *map(str, line)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    running.stdout.close()
    assert running.stderr.read() == "armscope: nobody reads standard output any more\n"
    assert running.wait() == 141
    assert (tmp_path / "out" / "robot.yaml").exists()


SLOW = """
import sys, time
from pathlib import Path
from typing import Annotated
import typer
from armscope.cli.commands import Commands
from armscope.cli.endings import endings
from armscope.core.files import write_text
app = Commands()
@app.command()
def slow(output: Annotated[Path, typer.Option("-o")]):
    write_text(output / "a", "half")
    print("ready", flush=True)
    time.sleep(60)
with endings():
    app()
"""


def slow(out):
    running = subprocess.Popen(
        [sys.executable, "-c", SLOW, "-o", out], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert running.stdout.readline() == "ready\n"
    return running


@pytest.mark.parametrize(("end", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_command_that_is_told_to_end_leaves_nothing(end, code, tmp_path):
    running = slow(tmp_path / "out")
    running.send_signal(end)
    said = running.communicate()[1]
    assert running.returncode == code
    assert said.count("\n") == (end == signal.SIGINT)
    assert list(tmp_path.iterdir()) == []


def test_two_runs_into_one_folder_do_not_mix_and_the_second_is_told_of_the_first(tmp_path):
    running = slow(tmp_path / "out")
    second = run("folder", "-o", tmp_path / "out", "a")
    running.kill()
    running.communicate()
    assert isinstance(second.exception, Busy)
    assert f"process {running.pid} on " in str(second.exception)
    assert "since 20" in str(second.exception)
    assert not (tmp_path / "out").exists()
    # a dead owner's lock is nobody's, and what it left is tidied away
    assert leftovers(tmp_path) != []
    assert run("folder", "-o", tmp_path / "out", "a").exit_code == 0
    assert leftovers(tmp_path) == []


def test_a_run_that_was_killed_while_it_put_its_files_in_place_is_finished_by_the_next(tmp_path, monkeypatch):
    out = tmp_path / "out"
    out.mkdir()
    assert run("folder", "-o", out, "a", "b", "old").exit_code == 0
    (out / "mine").write_text("mine")
    code = (
        "import os, signal, sys\nimport armscope.core.records as outputs\n"
        "move, count = outputs._move, []\n"
        "def dying(source, target):\n"
        "    count.append(1)\n    len(count) == 3 and os.kill(os.getpid(), signal.SIGKILL)\n    move(source, target)\n"
        "outputs._move = dying\n"
        "from tests.core.test_outputs import toy\n"
        "toy(['folder', '-o', sys.argv[1], 'a', 'b', 'c', '--source', sys.argv[2]])\n"
    )
    (tmp_path / "words").write_text("of the second run")
    killed = subprocess.run([sys.executable, "-c", code, out, tmp_path / "words"], cwd=ROOT, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert "c" not in tree(out)
    # any command that looks at this folder finishes it
    assert run("file", "-o", out / "other").exit_code == 0
    assert tree(out) == {name: f"{name} of the second run" for name in "abc"} | {"mine": "mine", "other": "made"}
    assert leftovers(tmp_path) == []
    assert sorted(json.loads((out / ".armscope" / "folder.json").read_text())["files"]) == ["a", "b", "c"]


def test_leftovers_of_dead_writers_are_removed_by_the_next(tmp_path):
    code = (
        "import os, signal, sys\nfrom armscope.core.files import replacing\n"
        "with replacing(sys.argv[1]) as beside:\n"
        "    beside.write_text('half')\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path / "a.csv"], check=False)
    assert [path.suffix for path in tmp_path.iterdir()] == [".part"]
    with replacing(tmp_path / "a.csv") as beside:
        beside.write_text("whole")
    assert tree(tmp_path) == {"a.csv": "whole"}


def test_every_path_a_command_takes_is_an_input_or_an_output_and_those_that_write_can_be_forced():
    import inspect

    commands = [command for group in [armscope, *(each.typer_instance for each in armscope.registered_groups)]
                for command in group.registered_commands]  # fmt: skip
    assert len(commands) > 10
    for each in commands:
        names = set(inspect.signature(each.callback).parameters)
        assert ("output" in names or "figure" in names or "visible" in names) == ("force" in names), each.callback
