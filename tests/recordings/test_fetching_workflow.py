"""`snakemake fetch_recordings`: what is whole stays and what is wrong is kept aside, whatever else fails."""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
RAW = {name: f"j1,j2,x,y,z\n0,0.{k},1,2,3\n".encode() for k, name in enumerate(("a.csv", "b.csv"))}
TABLE = "results/small/recordings/tiny/recordings.csv.gz"


@pytest.fixture
def checkout(tmp_path):
    """A copy of the workflow with a public set of two files, and a local folder that stands in for its source."""
    for name in ("config", "workflow", "profiles", "src"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "Snakefile", tmp_path)
    if (worked_out := ROOT / "results" / "small" / "settings").is_dir():  # by `make test`: whether paths are in reach
        shutil.copytree(worked_out, tmp_path / "results" / "small" / "settings")
    folder, local = tmp_path / "config" / "recordings" / "tiny", tmp_path / "local" / "tiny" / "raw"
    folder.mkdir()
    local.mkdir(parents=True)
    files = [{"path": n, "sha256": hashlib.sha256(c).hexdigest(), "bytes": len(c)} for n, c in RAW.items()]
    source = {"title": "tiny", "repository": "example.org/some/body", "commit": "0" * 40, "licence": "MIT"}
    (folder / "source.yaml").write_text(yaml.safe_dump(source | {"files": files}))
    columns = {"angles": {"columns": ["j1", "j2"], "unit": "rad"}, "position": {"columns": [3, 4, 5], "unit": "mm"}}
    (folder / "mapping.yaml").write_text(yaml.safe_dump({"columns": columns}))
    shutil.copy(ROOT / "config" / "robots" / "six-axis.yaml", folder / "robot.yaml")
    for name, content in RAW.items():
        (local / name).write_bytes(content)
    return tmp_path


def fetch(checkout):
    command = [sys.executable, "-m", "snakemake", TABLE, "-j1", "--nocolor", "--configfile", "config/small.yaml"]
    command += ["--config", "recordings_dir=local"]
    run = subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=False, env={**os.environ})
    return run.returncode, run.stdout + run.stderr


@pytest.mark.long
def test_one_wrong_file_costs_nothing_that_is_whole_and_what_is_kept_aside_is_not_imported(checkout):
    (checkout / "local" / "tiny" / "raw" / "b.csv").write_bytes(b"something else")
    code, printed = fetch(checkout)
    assert code != 0
    assert "b.csv: sha256" in printed
    raw = checkout / "results" / "small" / "recordings" / "tiny" / "raw"
    assert [path.name for path in raw.iterdir()] == ["a.csv"]
    assert not (checkout / TABLE).exists()
    # the file is mended; one that came wrong earlier lies aside
    (checkout / "local" / "tiny" / "raw" / "b.csv").write_bytes(RAW["b.csv"])
    (raw / "b.csv.wrong-sha256").write_bytes(b"something else")
    code, printed = fetch(checkout)
    assert code == 0, printed
    assert "Table 2" not in printed
    assert (checkout / TABLE).exists()
    assert (raw / "b.csv.wrong-sha256").read_bytes() == b"something else"
    assert "a.csv: kept" in (raw.parent / "fetched.txt").read_text()
