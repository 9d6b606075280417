"""Raw files and mappings that can't be: one clear error, nothing written; MATLAB files; what is never loaded."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from armscope.core.inputs import InputError

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
        ("j1,j2,x,y,z\nrad,rad,mm,mm,mm\n0,0,1,2,3\n", SIMPLE, "line 2, column j1.*holds units.*below_header: 1"),
        ("j1,j2,x,y,z\n0,0,1,2,3,\n", SIMPLE, "line 2: found '6 values'.*ends with a delimiter"),
        ("j1,j2,x,y,z\n0,0,1,2,3\n# the end\n", SIMPLE, "line 3: found '1 values'.*declare `comment: '#'`"),
        ("j1,j2,x,y,z\n0,0,1e308,2,3\n", SIMPLE, "line 2, column x: found '1e308'; no recorded value.*`missing`"),
        ("j1,j2,x,y,z\n0,0,1,2e8,3\n", SIMPLE, r"line 2, column y: found '2e\+08'.*10 km.*really mm"),
        ("j1,j2,x,y,z\n0,0,1,2,3\n", SIMPLE | {"format": {"delimiter": "tab"}}, "no column j1.*delimiter really 'tab'"),
        ('j1,j2,x,y,z\n0,0,"1,2,3\n0,0,1,2,3\n', SIMPLE, "line 2: found '3 values'.*quotation mark"),
        ('j1,j2,x,y,z\n0,0,1,2,3\n"' + "0,0,1,2,3\n" * 20_000, SIMPLE, "line 3: .*quotation mark"),
        (
            "j1,j2,x,y,z,a,b,c\n0,0,1,2,3,,1,2\n",
            with_columns(orientation={"euler": ["a", "b", "c"], "sequence": "XYZ", "unit": "deg"}),
            "line 2, column a: found nothing.*whole",
        ),
        (
            "j1,j2,x,y,z,a,b,c,d\n0,0,1,2,3,,,,\n0,0,1,2,3,1,0,0,\n",
            with_columns(orientation={"quaternion": ["a", "b", "c", "d"], "order": "wxyz"}),
            "line 3, column d: found nothing.*whole",
        ),
        (
            "j1,j2,x,y,z,a,b,c\n0,0,1,2,3,0,170,2\n",
            with_columns(orientation={"euler": ["a", "b", "c"], "sequence": "XYZ", "unit": "rad"}),
            "line 2, column b: found '170'.*unit: deg",
        ),
        (
            "j1,j2,x,y,z,a,b\n0,0,1,2,3,1,2\n",
            with_columns(approach={"columns": ["a", "b"]}),
            "line 2, column b: found '2'.*-1 or",
        ),
        (
            "j1,j2,x,y,z,s\n0,0,1,2,3,-1\n",
            with_columns(sigma={"columns": ["s", "s", "s"], "unit": "mm"}),
            "line 2, column s: found '-1'.*not negative",
        ),
        ("j1,j2,x,y,z\n0,0,1,2,3\n", with_columns(payload={"constant": -2}), "found '-2'; a payload is not negative"),
        ("j1,j2,x,y,z\n0,0,1,2,-300\n", with_columns(temperature={"column": "z"}), "column z.*absolute zero"),
        ("j1,j2,x,y,z\n0,0,1_0,2,3\n", SIMPLE, "'1_0'"),
        ("j1;j2;x;y;z\n0;0;1,5;2.5;3\n", with_format(delimiter=";", decimal=","), r"column y: found '2\.5'.*another"),
        ("j1;j2;x;y;z\n0;0;1.5;2,5;3\n", with_format(delimiter=";"), "column y: found '2,5'.*another"),
        ("j1,j2,x,y,z\nMean,,1,2,3\n", SIMPLE, "column j1: found 'Mean'"),
        ("j1,j2,x,y,z\n0,0,1,2,3\nMean,,1,2,3\n", SIMPLE, "line 3, column j1.*missing.*remove it, or say `last_line`"),
        ("j1;j2;x;y;z\n0;0;2,001.5;2;3\n", with_format(delimiter=";"), "found '2,001.5'.*declare `thousands: ','`"),
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
        ({"format": {"decimal": ",", "thousands": ","}}, "can't be the same sign"),
        ({"format": {"delimiter": "whitespace", "thousands": " "}}, "can't be told from those between columns"),
        ({"columns": {"position": SIMPLE["columns"]["position"]}}, "`angles` is needed"),
        ({"columns": {"angles": {"columns": [0, 1], "unit": "rad"}}}, "counted from 1"),
        ({"columns": {"angles": {"columns": ["j1"], "unit": "degrees"}}}, "'rad', 'deg', 'gon' or 'mrad'"),
        (with_columns(orientation={"euler": ["a", "b", "c"], "sequence": "XXY", "unit": "deg"}), "three axes such as"),
        (with_columns(orientation={"euler": ["a", "b", "c"], "sequence": "xYz", "unit": "deg"}), "three axes such as"),
        (with_columns(orientation={"quaternion": ["a", "b", "c", "d"]}), "wxyz or xyzw"),
        (with_columns(torque={"columns": ["t1"]}), "1 columns for 2 motors"),
        ({"runs": [{"run": "a", "file": "other.csv"}]}, "no file other.csv"),
        ({"runs": [{"run": "a", "file": "raw.csv"}, {"run": "a", "file": "raw.csv"}]}, "stands twice"),
        ({"rows": [{"first_of": ["x"], "drop_missing": ["x"]}]}, "one rule"),
        ({"rows": [{"between": {"column": "x"}}]}, "`low`, `high` or both"),
        ({"rows": [{"between": {"column": "x", "low": 2, "high": 1}}]}, "above `high`"),
        (
            {"columns": {**SIMPLE["columns"], "angles": {"colums": ["j1", "j2"], "unit": "rad"}}},
            "Did you mean 'columns'",
        ),
        (
            {"columns": {**SIMPLE["columns"], "angles": {"columns": ["j1", "j1"], "unit": "rad"}}},
            "'j1' is one quantity",
        ),
        ({"columns": {**SIMPLE["columns"], "angles": {"columns": ["j1", "x"], "unit": "rad"}}}, "'x' is one quantity"),
        (with_columns(time={"column": "x", "format": "%Q"}), "directives of strftime: 'Q'"),
        (
            {
                "runs": [
                    {"run": "a", "file": "raw.csv"},
                    {"run": "b", "file": "b.csv", "columns": {"angles": {"columns": ["j1"], "unit": "rad"}}},
                ]
            },
            "no consistent content; .*not a: 2, b: 1",
        ),
        (
            with_columns(angles={"columns": ["w:j1", "w:j2"], "unit": "rad"})
            | {"runs": [{"run": "a", "file": "raw.csv", "beside": [{"file": "raw.csv", "name": "angles"}]}]},
            "no file beside is called 'w' .*Known: angles",
        ),
        (with_columns(id={"row_of": "angles"}), "no file beside is called 'angles'.*no `beside`"),
    ],
)
def test_a_mapping_that_can_not_be_is_one_clear_error(change, message, tmp_path):
    with pytest.raises(InputError, match=message):
        convert(tmp_path, "j1,j2,x,y,z\n0,0,1,2,3\n", {**SIMPLE, **change})


@pytest.mark.parametrize(
    ("angles", "message"),
    [
        ("j1,j2\n\n0,0\n0.1,\n", r"q\.csv: line 4, column q:j2: found nothing; this value is required"),
        ("j1,j2\n0,0\n# later\n0.1,35\n", r"q\.csv: line 4, column q:j2: found '35 rad'"),
        ("j1,j2\n0,0\n0.1,x\n", r"q\.csv: line 3, column j2: found 'x'"),
        ("j1,j2\n0,0\n", r"q\.csv: found 'row 2 of the first file'; this file has 1 rows for 1 each"),
        ("j1,j2\n0,0\n0,0\n0,0\n", r"q\.csv: found '2 rows in the first file'; this file has 3 rows for 1 each"),
    ],
)
def test_what_is_wrong_in_a_file_beside_is_named_in_that_file(angles, message, tmp_path):
    mapping = {
        "format": {"comment": "#"},
        "columns": {
            "angles": {"columns": ["q:j1", "q:j2"], "unit": "rad"},
            "position": SIMPLE["columns"]["position"],
        },
        "runs": [{"run": "r", "file": "p.csv", "beside": [{"file": "q.csv", "name": "q"}]}],
    }
    with pytest.raises(InputError, match=message):
        convert(tmp_path, {"p.csv": "x,y,z\n1,2,3\n4,5,6\n", "q.csv": angles}, mapping)


def test_a_raw_file_that_no_run_wants_is_named(tmp_path):
    mapping = SIMPLE | {"runs": [{"run": "a", "file": "a.csv"}]}
    with pytest.raises(InputError, match=r"b\.csv.*no run"):
        convert(tmp_path, {"a.csv": "j1,j2,x,y,z\n0,0,1,2,3\n", "b.csv": ""}, mapping)
    with pytest.raises(InputError, match="Name the runs"):
        convert(tmp_path, {"a.csv": "", "a.txt": ""}, SIMPLE)


def test_a_broken_archive_is_one_clear_error(tmp_path):
    whole = gzip.compress(b"j1,j2,x,y,z\n0,0,1,2,3\n" * 50)
    for content in (whole[: len(whole) // 2], whole[:5], whole[:30] + b"something else entirely"):
        (tmp_path / "raw.csv.gz").write_bytes(content)
        with pytest.raises(InputError, match=r"plain or gzipped|no readable file"):
            convert_files(tmp_path, [tmp_path / "raw.csv.gz"], SIMPLE)
        assert not (tmp_path / "out.csv").exists()


@pytest.mark.parametrize("name", ["raw.csv", "raw.csv.gz", "raw.txt"])
@pytest.mark.parametrize("packed", [True, False])
def test_compression_is_told_by_the_content_whatever_the_name(name, packed, tmp_path):
    text = b"j1,j2,x,y,z\n0,0,1,2,3\n"
    (tmp_path / name).write_bytes(gzip.compress(text) if packed else text)
    assert len(convert_files(tmp_path, [tmp_path / name], SIMPLE)[1]) == 1


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"PK\x03\x04" + bytes(200), "Excel workbook.*Save the sheet as CSV"),
        (b"MATLAB 5.0 MAT-file" + bytes(200), "MATLAB file.*kind: matlab"),
        ("j1,j2,x,y,z\n".encode("utf-16"), "UTF-16.*encoding: utf-16"),
        (b"j1,j2,x,y,z\n0,0,1,2,3\n0,0,1,2,\xb0\n", r"line 3.*0xb0 after '0,0,1,2,'.*encoding"),
    ],
)
def test_another_kind_of_file_is_named_by_what_it_is(content, message, tmp_path):
    (tmp_path / "raw.csv").write_bytes(content)
    with pytest.raises(InputError, match=message):
        convert_files(tmp_path, [tmp_path / "raw.csv"], SIMPLE)


@pytest.mark.parametrize("encoding", ["utf-8", "UTF8", "utf-8-sig"])
def test_a_byte_order_mark_is_passed_over_however_utf8_is_spelt(encoding, tmp_path):
    (tmp_path / "raw.csv").write_bytes(b"\xef\xbb\xbfj1,j2,x,y,z\n0,0,1,2,3\n")
    assert len(convert_files(tmp_path, [tmp_path / "raw.csv"], with_format(encoding=encoding))[1]) == 1


def test_utf_16_is_read_where_it_is_declared(tmp_path):
    (tmp_path / "raw.csv").write_bytes("j1,j2,x,y,z\n0,0,1,2,3\n".encode("utf-16"))
    assert len(convert_files(tmp_path, [tmp_path / "raw.csv"], with_format(encoding="utf-16"))[1]) == 1


def test_the_cure_for_a_line_of_units_cures(tmp_path):
    columns = {"angles": {"columns": [1, 2], "unit": "rad"}, "position": {"columns": [3, 4, 5], "unit": "mm"}}
    mapping = {"format": {"header": False, "skip_lines": 2}, "columns": columns}
    assert len(convert(tmp_path, "j1,j2,x,y,z\nrad,rad,mm,mm,mm\n0,0,1,2,3\n", mapping)[1]) == 1


@pytest.mark.parametrize("output", ["raw.csv", "mapping.yaml", "."])
def test_an_import_never_writes_over_what_it_reads(output, tmp_path):
    with pytest.raises(InputError, match="is written to a file"):
        convert(tmp_path, "j1,j2,x,y,z\n0,0,1,2,3\n", SIMPLE, output)
    assert (tmp_path / "raw.csv").read_text().startswith("j1")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mapping.yaml", "raw.csv"]


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
