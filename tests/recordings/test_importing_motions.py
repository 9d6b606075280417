"""Raw files of arms in motion become motions.csv as a mapping says."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.inputs import InputError
from armscope.recordings.importing.fetching import fetch_recordings, load_source
from armscope.recordings.importing.motions import load_any_mapping
from armscope.recordings.importing.tables import import_recordings
from armscope.recordings.motions import read_motions

ROOT = Path(__file__).parents[2]
SETS = sorted(path for path in (ROOT / "config" / "motions").iterdir())
SHARED = ROOT.parent / "shared" / "motions"
MOST_RUNS = slice(0, 4, 3)
"""The first, and of the longest set the one whose file holds broken rows."""

MAPPING = {
    "table": "motions",
    "format": {"header": False, "skip_lines": 1, "last_line": 4},
    "columns": {
        "time": {"column": 1, "unit": "ms"},
        "positions": {"columns": ["q:1", "q:2"], "unit": "deg"},
        "speeds": {"columns": [2, 3], "unit": "rad/s"},
        "current": {"columns": [4, 5], "scale": 2},
        "payload": {"constant": 1.5},
    },
    "runs": [
        {
            "run": "one",
            "file": "a.csv",
            "beside": [{"file": "q.txt", "name": "q", "format": {"header": False, "values_per_row": 2}}],
        }
    ],
}
FILES = {"a.csv": "broken\n0,1,2,3,4\n10,1,2,3,5\n20,1,2,3,6\nbroken again\n", "q.txt": "0\n90\n10\n91\n20\n92\n"}


def imported(folder: Path, **changes: object) -> pd.DataFrame:
    for name, text in FILES.items():
        (folder / name).write_text(text)
    (folder / "mapping.yaml").write_text(yaml.safe_dump(MAPPING | changes))
    import_recordings([folder / name for name in FILES], folder / "mapping.yaml", folder / "motions.csv")
    return pd.read_csv(folder / "motions.csv")


def test_columns_are_scaled_windows_kept_and_flat_lists_cut(tmp_path: Path) -> None:
    table = imported(tmp_path)
    assert list(table["time_s"]) == [0, 0.01, 0.02]
    np.testing.assert_allclose(table[["q1_rad", "q2_rad"]], np.radians([[0, 90], [10, 91], [20, 92]]), rtol=1e-9)
    assert list(table["current2_a"]) == [8, 10, 12]
    motions = read_motions(tmp_path / "motions.csv", 2)
    assert motions.kind == "current"
    assert motions.payload is not None
    assert motions.payload[0] == 1.5


def test_the_command_converts_them_too(tmp_path: Path) -> None:
    imported(tmp_path)
    (tmp_path / "motions.csv").unlink()
    places = [str(tmp_path / name) for name in (*FILES, "mapping.yaml", "motions.csv")]
    done = CliRunner().invoke(app, ["import", *places[:2], "--mapping", places[2], "-o", places[3]])
    assert done.exit_code == 0, done.output
    assert len(pd.read_csv(tmp_path / "motions.csv")) == 3


@pytest.mark.parametrize(
    ("group", "content", "message"),
    [
        ("torque", {"columns": [4, 5]}, "one of the two"),
        ("current", {"columns": [4]}, "1 columns for 2 motors"),
        ("time", None, "needs `time`"),
        ("position", {"columns": [1, 2, 3], "unit": "mm"}, "position"),
    ],
)
def test_what_is_missing_or_unknown_is_named(group: str, content: object, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        imported(tmp_path, columns=MAPPING["columns"] | {group: content})  # type: ignore[operator]


@pytest.mark.parametrize("folder", SETS, ids=lambda path: path.name)
def test_every_set_names_its_files_and_how_they_are_read(folder: Path) -> None:
    mapping, source = load_any_mapping(folder / "mapping.yaml"), load_source(folder / "source.yaml")
    wanted = {name for run in mapping.runs for name in (run.file, *(beside.file for beside in run.beside))}
    assert wanted == {file.name for file in source.files}


@pytest.mark.shared
@pytest.mark.parametrize(
    "folder",
    [pytest.param(path, marks=[pytest.mark.long] * (path.name in ("panda-motion", "ur10e-currents"))) for path in SETS],
    ids=lambda path: path.name,
)
def test_a_real_set_converts_to_the_reference_table_within_its_rounding(folder: Path, tmp_path: Path) -> None:
    if not SHARED.is_dir():
        pytest.skip("../shared/motions is not here, so there is nothing to compare with")
    fetched = fetch_recordings(folder / "source.yaml", tmp_path / "raw", recordings_dir=SHARED)
    mapping = yaml.safe_load((folder / "mapping.yaml").read_text())
    mapping["runs"] = mapping["runs"][MOST_RUNS]
    (tmp_path / "mapping.yaml").write_text(yaml.safe_dump(mapping))
    wanted = {name["file"] for run in mapping["runs"] for name in (run, *run.get("beside", []))}
    files = [path for path in fetched.paths if path.name in wanted]
    import_recordings(files, tmp_path / "mapping.yaml", tmp_path / "motions.csv")
    ours, theirs = pd.read_csv(tmp_path / "motions.csv"), pd.read_csv(SHARED / folder.name / "motions.csv.gz")
    for run, rows in ours.groupby("run", sort=False):
        whole = theirs[theirs["run"] == run]
        told = [name for name in rows if name not in ("run", "time_s", "payload_kg")]
        start = int(np.abs(whole[told] - rows[told].iloc[0]).sum(axis=1).to_numpy().argmin())
        same = whole.iloc[start : start + len(rows)]
        np.testing.assert_allclose(rows[told], same[told], rtol=1e-8, atol=1e-8, err_msg=str(run))
        np.testing.assert_allclose(np.diff(rows["time_s"]), np.diff(same["time_s"]), atol=1e-6)


def test_several_motions_of_one_file_are_runs_of_their_own(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("t,Bahn,q1,q2,M1,M2\n0,B1,1,2,3,4\n10,B1,1,2,3,4\n0,B2,1,2,3,4\n")
    groups = {"positions": {"columns": ["q1", "q2"], "unit": "deg"}, "torque": {"columns": ["M1", "M2"]}}
    columns = {"time": {"column": "t", "unit": "ms"}, "run": {"column": "Bahn"}} | groups
    mapping = tmp_path / "mapping.yaml"
    mapping.write_text(yaml.safe_dump({"table": "motions", "columns": columns}))
    report = import_recordings([tmp_path / "log.csv"], mapping, tmp_path / "motions.csv")
    assert "3 rows, 2 run(s)" in report.text()
    assert read_motions(tmp_path / "motions.csv", 2).run.tolist() == ["B1", "B1", "B2"]
    (tmp_path / "log.csv").write_text("t,Bahn,q1,q2,M1,M2\n0,B1,1,2,3,4\n10,,1,2,3,4\n")
    with pytest.raises(InputError, match="line 3, column Bahn: found nothing; every row is of a run"):
        import_recordings([tmp_path / "log.csv"], mapping, tmp_path / "again.csv")


def test_each_motor_may_have_a_temperature_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("t,q1,q2,M1,M2,T1,T2\n0,1,2,3,4,20,30\n10,1,2,3,4,21,\n")
    groups = {"positions": {"columns": ["q1", "q2"], "unit": "deg"}, "torque": {"columns": ["M1", "M2"]}}
    columns = {"time": {"column": "t", "unit": "ms"}, "temperatures": {"columns": ["T1", "T2"]}} | groups
    mapping = tmp_path / "mapping.yaml"
    mapping.write_text(yaml.safe_dump({"table": "motions", "columns": columns | {"payload": {"constant": 2}}}))
    report = import_recordings([tmp_path / "log.csv"], mapping, tmp_path / "motions.csv")
    assert report.columns[-3:] == ("payload_kg", "temperature1_c", "temperature2_c")
    written = pd.read_csv(tmp_path / "motions.csv")[["temperature1_c", "temperature2_c"]]
    np.testing.assert_array_equal(written, [[20, 30], [21, np.nan]], "what was not recorded is not invented")
    np.testing.assert_array_equal(read_motions(tmp_path / "motions.csv", 2).temperature, [[20, 30], [21, 30]])
    mapping.write_text(yaml.safe_dump({"table": "motions", "columns": columns | {"temperature": {"constant": 20}}}))
    with pytest.raises(InputError, match="one of the two"):
        load_any_mapping(mapping)
