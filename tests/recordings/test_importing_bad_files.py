"""Raw files and mappings that can't be: one clear error, nothing written; MATLAB files; what is never loaded."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from armscope.inputs import InputError

from .raw import SIMPLE, convert, convert_files, with_columns, with_format

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "recordings"


@pytest.mark.parametrize(
    ("raw", "mapping", "message"),
    [
        ("", SIMPLE, "line 1: found nothing"),
        ("j1,j2,x,y,z\n", SIMPLE, "at least one row"),
        ("j1,j2,x,y,z\n0,0,1,2,3\n0,0,1,2\n", SIMPLE, "line 3: found '4 values'; every row has 5"),
        ("j1,j2,x,y,z\n0,0,1,2,3,4\n", SIMPLE, "line 2: found '6 values'.*decimal comma"),
        ("j1;j2;x;y;z\n0;0;1;2;3\n", SIMPLE, "no column j1"),
        ("j1,j2,x,y,z\n0;0;1;2;3\n", SIMPLE, "line 2.*delimiter really"),
        ("j1,j2,x,y,z\n0,0,1,2,3\n0,0,one,2,3\n", SIMPLE, "line 3, column x: found 'one'"),
        ("j1,j2,x,y,z\n0,0,inf,2,3\n", SIMPLE, "finite"),
        ("j1,j2,x,y,z\n0,0,1_0,2,3\n", SIMPLE, "'1_0'"),
        ("j1;j2;x;y;z\n0;0;1,5;2.5;3\n", with_format(delimiter=";", decimal=","), r"column y: found '2\.5'.*another"),
        ("j1;j2;x;y;z\n0;0;1.5;2,5;3\n", with_format(delimiter=";"), "column y: found '2,5'.*another"),
        ("j1,j2,x,x,y,z\n0,0,1,1,2,3\n", SIMPLE, "the header has this name 2 times.*number"),
        ("joint1,j2,x,y,z\n0,0,1,2,3\n", {**SIMPLE}, "no column j1.*Did you mean"),
        ("j1,j2,x,y,z\n0,0,,2,3\n", SIMPLE, "line 2, column x: found nothing.*drop_missing"),
        ("j1,j2,x,y,z\n90,0,1,2,3\n", SIMPLE, "two turns.*unit: deg"),
        ("j1,j2,x,y,z\n0,0,1,2,3\n", with_columns(temperature={"column": 9}), "column 9: found '5 columns'"),
        ("j1,j2,x,y,z\n0,0,1,2,3\n", SIMPLE | {"rows": [{"first_of": ["pos"]}]}, "no column pos"),
        (
            "pose,j1,j2,x,y,z\n1,0,0,1,2,3\n1,0,0,1,2,3\n",
            with_columns(id={"column": "pose"}),
            "line 3, column pose.*once per run and target.*first_of",
        ),
        (
            "j1,j2,x,y,z\n0,0,1,2,3\n",
            SIMPLE | {"rows": [{"between": {"column": "x", "low": 5}}]},
            "no row left.*column x not >= 5: 1",
        ),
    ],
)
def test_bad_raw_files_are_one_clear_error_and_nothing_is_written(raw, mapping, message, tmp_path):
    with pytest.raises(InputError, match=f"(?s){message}"):
        convert(tmp_path, raw, mapping)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mapping.yaml", "raw.csv"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"colums": {}}, "Did you mean 'columns'"),
        ({"format": {"delimeter": ";"}}, "Did you mean 'delimiter'"),
        ({"format": {"decimal": ","}}, "both be a comma"),
        ({"columns": {"position": SIMPLE["columns"]["position"]}}, "`angles` is needed"),
        ({"columns": {"angles": {"columns": [0, 1], "unit": "rad"}}}, "counted from 1"),
        ({"columns": {"angles": {"columns": ["j1"], "unit": "degrees"}}}, "'rad' or 'deg'"),
        (with_columns(orientation={"euler": ["a", "b", "c"], "sequence": "XXY", "unit": "deg"}), "three axes such as"),
        (with_columns(orientation={"euler": ["a", "b", "c"], "sequence": "xYz", "unit": "deg"}), "three axes such as"),
        (with_columns(orientation={"quaternion": ["a", "b", "c", "d"]}), "wxyz or xyzw"),
        (with_columns(torque={"columns": ["t1"]}), "1 columns for 2 motors"),
        ({"runs": [{"run": "a", "file": "other.csv"}]}, "no file other.csv"),
        ({"runs": [{"run": "a", "file": "raw.csv"}, {"run": "a", "file": "raw.csv"}]}, "stands twice"),
        ({"rows": [{"first_of": ["x"], "drop_missing": ["x"]}]}, "one rule"),
    ],
)
def test_a_mapping_that_can_not_be_is_one_clear_error(change, message, tmp_path):
    with pytest.raises(InputError, match=message):
        convert(tmp_path, "j1,j2,x,y,z\n0,0,1,2,3\n", {**SIMPLE, **change})


def test_a_raw_file_that_no_run_wants_is_named(tmp_path):
    mapping = SIMPLE | {"runs": [{"run": "a", "file": "a.csv"}]}
    with pytest.raises(InputError, match=r"b\.csv.*no run"):
        convert(tmp_path, {"a.csv": "j1,j2,x,y,z\n0,0,1,2,3\n", "b.csv": ""}, mapping)
    with pytest.raises(InputError, match="Name the runs"):
        convert(tmp_path, {"a.csv": "", "a.txt": ""}, SIMPLE)


def test_a_broken_archive_is_one_clear_error(tmp_path):
    whole = gzip.compress(b"j1,j2,x,y,z\n0,0,1,2,3\n" * 50)
    for content in (whole[: len(whole) // 2], b"j1,j2,x,y,z\n0,0,1,2,3\n"):
        (tmp_path / "raw.csv.gz").write_bytes(content)
        with pytest.raises(InputError, match="plain or gzipped"):
            convert_files(tmp_path, [tmp_path / "raw.csv.gz"], SIMPLE)


def test_text_that_is_not_utf8_asks_for_its_encoding_and_is_read_with_it(tmp_path):
    (tmp_path / "raw.csv").write_bytes("j1,j2,x,y,z,t\n0,0,1,2,3,20 °C\n".encode("latin-1"))
    with pytest.raises(InputError, match="encoding"):
        convert_files(tmp_path, [tmp_path / "raw.csv"], SIMPLE)
    _, table = convert_files(tmp_path, [tmp_path / "raw.csv"], with_format(encoding="latin-1"))
    assert len(table) == 1


# ---- MATLAB, and what is never loaded


def matlab(**variables):
    return {
        "format": {"kind": "matlab", **variables},
        "columns": {
            "angles": {"columns": [1, 2], "unit": "rad"},
            "position": {"columns": [3, 4, 5], "unit": "mm"},
        },
    }


def test_matlab_matrices_are_read_by_column_numbers_and_nan_counts_as_missing(tmp_path):
    values = np.array([[0.1, 0.2, 1, 2, 3], [0.1, 0.2, np.nan, 2, 3]])
    scipy.io.savemat(tmp_path / "raw.mat", {"data": values, "other": np.ones(3)})
    mapping = matlab(variable="data") | {"rows": [{"drop_missing": [3]}]}
    report, table = convert_files(tmp_path, [tmp_path / "raw.mat"], mapping)
    assert table["z_mm"].tolist() == [3]
    assert report.runs[0].left_out[0].rows == [2]
    for wrong, message in [(matlab(), "data, other"), (matlab(variable="dta"), "Did you mean 'data'")]:
        with pytest.raises(InputError, match=message):
            convert_files(tmp_path, [tmp_path / "raw.mat"], wrong)


@pytest.mark.parametrize("content", [b"", b"not a matlab file", b"MATLAB 5.0 MAT-file" + b"\0" * 200])
def test_a_broken_matlab_file_is_one_clear_error(content, tmp_path):
    (tmp_path / "raw.mat").write_bytes(content)
    with pytest.raises(InputError):
        convert_files(tmp_path, [tmp_path / "raw.mat"], matlab())


def test_a_pickle_is_never_loaded_whatever_it_is_called(tmp_path):
    import pickle

    class Harm:
        def __reduce__(self):
            return (Path.touch, (tmp_path / "harm",))

    for name in ("raw.pickle", "raw.csv", "raw.mat"):
        (tmp_path / name).write_bytes(pickle.dumps(Harm()))
        for mapping in (SIMPLE, matlab()):
            with pytest.raises(InputError, match="never loaded"):
                convert_files(tmp_path, [tmp_path / name], mapping)
    assert not (tmp_path / "harm").exists()
