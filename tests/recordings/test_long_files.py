"""Long files are converted, read and looked through within bounded memory, through the command line."""

import resource
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
MOST_BYTES = 300 << 20
"""Of address space that data may take: a table of cells as Python objects would take several times as much."""


@pytest.fixture(scope="module")
def long_file(tmp_path_factory):
    """A raw file of 200,000 rows, 38 MB, as a tracker that never stops would write it."""
    folder = tmp_path_factory.mktemp("long")
    rng = np.random.default_rng(0)
    some = [",".join(f"{value:.10f}" for value in row) for row in rng.uniform(-3, 3, (1000, 15))]
    with (folder / "raw.csv").open("w") as stream:
        stream.write("j1,j2,j3,j4,j5,j6,x,y,z,a,b,c,d,e,f\n")
        for _ in range(ROWS // 1000):
            stream.write("\n".join(some) + "\n")
    columns = {
        "angles": {"columns": ["j1", "j2", "j3", "j4", "j5", "j6"], "unit": "rad"},
        "position": {"columns": ["x", "y", "z"], "unit": "m"},
        "torque": {"columns": ["a", "b", "c", "d", "e", "f"]},
    }
    (folder / "mapping.yaml").write_text(yaml.safe_dump({"columns": columns}))
    return folder


def limited():
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_BYTES, MOST_BYTES))


@pytest.mark.long
def test_a_long_file_is_imported_and_checked_within_its_memory(long_file):
    for arguments, code in (
        (["import", "raw.csv", "--mapping", "mapping.yaml", "-o", "recordings.csv"], 0),
        (["check", "recordings.csv", "--robot", str(ROBOT), "--figure", "check.png"], 1),  # not this robot's
    ):
        command = [sys.executable, "-c", "from armscope.cli import main; main()", *arguments]
        done = subprocess.run(command, cwd=long_file, capture_output=True, text=True, preexec_fn=limited, check=False)
        assert done.returncode == code, done.stderr[-2000:]
        assert str(ROWS) in done.stdout


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT])
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
