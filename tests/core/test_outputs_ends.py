"""What is no regular file is written through; what ends a command leaves nothing half-written behind."""

import json
import os
import resource
import signal
import stat
import subprocess
import sys
import threading

import pytest

from armscope.cli import app
from armscope.core.files import replacing
from armscope.core.locks import Busy
from tests.core.toy import EXAMPLE, PREDICT, ROOT, command, leftovers, run, tree

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


def test_devices_are_written_through(tmp_path):
    to_file, to_device = tmp_path / "a.csv", command(*PREDICT, "/dev/stdout")
    to_stdout = run(*PREDICT, "-", app=app)
    assert run(*PREDICT, to_file, app=app).exit_code == 0
    assert to_device.stdout == to_stdout.stdout == to_file.read_text()
    assert run(*PREDICT, "/dev/null", app=app).exit_code == 0
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
    out, few_rows = small_disk / "out", EXAMPLE.parent / "one-effect"
    line = ("diagnose", few_rows / "recordings.csv", "-r", few_rows / "robot.yaml", "-o", out, "--resamples", "0")
    assert run(*line, "--no-cross-validation", "--no-report", app=app).exit_code == 0
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


def test_too_few_addresses_for_the_libraries_are_refused_at_once(tmp_path):
    """With less, BLAS tries for ever to get its buffers: found by the campaign."""
    few = 400 * 2**20
    done = command(*PREDICT, tmp_path / "a.csv", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (few, few)))
    assert (done.returncode, list(tmp_path.iterdir())) == (71, [])
    assert "400 MB of addresses (ulimit -v); 500 are the least" in done.stderr


FULL = """
import numpy as np
import scipy.linalg.blas
from armscope.cli.endings import endings

with endings():
    taken, size = [], 2**24
    some = np.ones((64, 64))
    while size > 2**20:
        try:
            taken.append(np.empty(size, np.uint8))
        except MemoryError:
            size //= 2
    print((some @ some)[0, 0], scipy.linalg.blas.dgemm(1.0, some, some)[0, 0])
"""


def test_blas_has_its_buffers_when_memory_is_full():
    """It would look for them for ever, without a word: found by a limit of 260 MB of data and a long table."""
    limit = 400 * 2**20
    done = subprocess.run(
        [sys.executable, "-c", FULL], capture_output=True, text=True, check=False, timeout=300,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit)),
    )  # fmt: skip
    assert (done.stdout, done.returncode) == ("64.0 64.0\n", 0), done.stderr


def test_too_little_data_is_refused_at_once(tmp_path):
    few = 150 * 2**20
    done = command(
        *PREDICT, tmp_path / "a.csv", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (few, few))
    )
    assert (done.returncode, list(tmp_path.iterdir())) == (71, [])
    assert "150 MB of data (ulimit -d); 200 are the least" in done.stderr


@pytest.mark.long
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
        "from tests.core.toy import toy\n"
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
