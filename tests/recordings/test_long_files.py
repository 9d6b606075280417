"""Long files are converted, read and looked through within bounded memory, through the command line."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import yaml

ROBOT = Path(__file__).parents[2] / "config" / "robots" / "six-axis.yaml"
ROWS = 200_000
COLUMNS = 15
MOST_BYTES = 25 * ROWS * COLUMNS
"""Of memory that the rows may take beyond what a short table does: 25 bytes a cell, of which a number takes 8. A cell
as a Python object takes some 70. What libraries take is theirs, and differs between versions."""
COMMAND = """
from armscope.cli import main
try:
    main()
finally:
    import re, sys
    from pathlib import Path
    print(re.search(r"VmHWM:\\s*(\\d+)", Path("/proc/self/status").read_text())[1], file=sys.stderr)
"""
"""The command line, and then the most memory that its process had, kB."""


@pytest.fixture(scope="module")
def long_file(tmp_path_factory):
    """A raw file of 200,000 rows, 38 MB, as a tracker that never stops would write it; beside it a short one."""
    folder = tmp_path_factory.mktemp("long")
    rng = np.random.default_rng(0)
    some = [",".join(f"{value:.10f}" for value in row) for row in rng.uniform(-3, 3, (1000, COLUMNS))]
    for name, rows in (("raw.csv", ROWS), ("short.csv", 1000)):
        with (folder / name).open("w") as stream:
            stream.write("j1,j2,j3,j4,j5,j6,x,y,z,a,b,c,d,e,f\n")
            for _ in range(rows // 1000):
                stream.write("\n".join(some) + "\n")
    columns = {
        "angles": {"columns": ["j1", "j2", "j3", "j4", "j5", "j6"], "unit": "rad"},
        "position": {"columns": ["x", "y", "z"], "unit": "m"},
        "torque": {"columns": ["a", "b", "c", "d", "e", "f"]},
    }
    (folder / "mapping.yaml").write_text(yaml.safe_dump({"columns": columns}))
    return folder


def most_kb(folder, *arguments, code):
    """The most memory that a command had."""
    command = [sys.executable, "-c", COMMAND, *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr[-2000:]
    return int(done.stderr.split()[-1])


@pytest.mark.long
def test_a_long_file_is_imported_and_checked_within_its_memory(long_file):
    took = {}
    for name in ("short", "raw"):
        converting = ("import", f"{name}.csv", "--mapping", "mapping.yaml", "-o", f"{name}-recordings.csv")
        looking = ("check", f"{name}-recordings.csv", "--robot", str(ROBOT), "--figure", f"{name}.png")
        took[name] = most_kb(long_file, *converting, code=0), most_kb(long_file, *looking, code=1)  # not this robot's
    assert sum(1 for _ in (long_file / "raw-recordings.csv").open()) == ROWS + 1
    for short, long in zip(took["short"], took["raw"], strict=True):
        assert (long - short) * 1024 < MOST_BYTES, took


@pytest.mark.long
@pytest.mark.parametrize("end", [signal.SIGTERM, pytest.param(signal.SIGINT, marks=pytest.mark.long)])
def test_an_import_that_is_ended_midway_leaves_nothing(long_file, end):
    command = [sys.executable, "-c", "from armscope.cli import main; main()"]
    command += ["import", "raw.csv", "--mapping", "mapping.yaml", "-o", "ended/out.csv.gz"]
    running = subprocess.Popen(command, cwd=long_file, stderr=subprocess.DEVNULL)
    while not list(long_file.glob("ended/.armscope/out*.new/*")):
        assert running.poll() is None
        time.sleep(0.02)
    running.send_signal(end)
    assert running.wait(timeout=20) != 0
    assert not (long_file / "ended").exists()  # nor the folder that was made for it
