"""Raw files become the table that they say they are, or one clear error."""

import gzip
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.core.inputs import InputError
from armscope.recordings import read_recordings
from armscope.recordings.importing.constants import LIMITS
from armscope.recordings.importing.formats import TextFormat
from armscope.recordings.importing.rawfiles import read_pieces

from .raw import SIMPLE, convert, convert_files, with_columns, with_format


def test_units_end_up_in_radians_and_millimetres(tmp_path):
    mapping = {
        "columns": {
            "angles": {"columns": ["j1", "j2"], "unit": "deg"},
            "position": {"columns": ["x", "y", "z"], "unit": "m"},
        }
    }
    _, table = convert(tmp_path, "j1,j2,x,y,z\n180,-90,0.1,0.2,-1.5\n", mapping)
    np.testing.assert_allclose(table[["q1_rad", "q2_rad"]], [[np.pi, -np.pi / 2]], rtol=1e-9)
    np.testing.assert_allclose(table[["x_mm", "y_mm", "z_mm"]], [[100, 200, -1500]], rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "style"),
    [
        ("j1;j2;x;y;z\n0,5;1;2;3;4,25\n", {"delimiter": ";", "decimal": ","}),
        ("j1\tj2\tx\ty\tz\r\n0.5\t1\t2\t3\t4.25\r\n", {"delimiter": "tab"}),
        ("j1 j2  x y z\n 0.5   1 2 3 4.25\n", {"delimiter": "whitespace"}),
        ("j1|j2|x|y|z\n0.5|1|2|3|4.25\n", {"delimiter": "|"}),
        ("\ufeffj1, j2, x, y, z\n0.5, 1, 2, 3, 4.25\n", {}),
        ('"j1","j2","x","y","z"\n"0.5","1","2","3","4.25"\n', {}),
        ("made by hand\n# a remark\nj1,j2,x,y,z\n# another\n0.5,1,2,3,4.25", {"skip_lines": 1, "comment": "#"}),
        ("j1;j2;x;y;z\n5,0E-01;1;2;3;425E-02\n", {"delimiter": ";", "decimal": ","}),
    ],
)
def test_delimiters_decimals_byte_order_marks_and_remarks_are_read(text, style, tmp_path):
    _, table = convert(tmp_path, text, with_format(**style))
    assert table[["q1_rad", "q2_rad", "x_mm", "y_mm", "z_mm"]].to_numpy().tolist() == [[0.5, 1, 2, 3, 4.25]]


def test_a_file_without_header_is_read_by_numbers_counted_from_1(tmp_path):
    mapping = {
        "format": {"header": False},
        "columns": {
            "angles": {"columns": [4, 5], "unit": "rad"},
            "position": {"columns": [1, 2, 3], "unit": "mm"},
        },
    }
    _, table = convert(tmp_path, "7,8,9,0.1,0.2\n10,11,12,0.3,0.4\n", mapping)
    assert table["x_mm"].tolist() == [7, 10]
    assert table["q2_rad"].tolist() == [0.2, 0.4]
    assert table["id"].tolist() == ["1", "2"]


def test_constant_columns_belong_to_their_run_and_are_empty_elsewhere(tmp_path):
    mapping = SIMPLE | {
        "runs": [
            {"run": "light", "file": "a.csv", "columns": {"payload": {"constant": 1.25}}},
            {"run": "unknown", "file": "b.csv"},
        ]
    }
    row = "j1,j2,x,y,z\n0,0,1,2,3\n"
    _, table = convert(tmp_path, {"a.csv": row, "b.csv": row}, mapping)
    assert table["run"].tolist() == ["light", "unknown"]
    assert table["payload_kg"].iloc[0] == 1.25
    assert np.isnan(table["payload_kg"].iloc[1])


def test_time_stamps_become_seconds_since_the_first_row_of_their_run(tmp_path):
    mapping = with_columns(time={"column": "t", "format": "%Y%m%d%H%M%S"})
    raw = "t,j1,j2,x,y,z\n20240229235959,0,0,1,2,3\n20240301000101,0,0,1,2,3\n20240229235958,0,0,1,2,3\n"
    _, table = convert(tmp_path, raw, mapping)
    assert table["time_s"].tolist() == [0, 62, -1]


def test_time_stamps_count_from_the_first_one_there_is_whatever_their_zone(tmp_path):
    mapping = with_columns(time={"column": "t", "format": "%Y-%m-%dT%H:%M:%S%z"})
    raw = "t,j1,j2,x,y,z\n,0,0,1,2,3\n2024-01-01T10:00:00+0100,0,0,1,2,3\n2024-01-01T10:00:00+0000,0,0,1,2,3\n"
    _, table = convert(tmp_path, raw, mapping)
    assert np.isnan(table["time_s"][0])
    assert table["time_s"][1:].tolist() == [0, 3600]


def test_seconds_since_1970_keep_their_milliseconds(tmp_path):
    mapping = with_columns(time={"column": "t", "unit": "ms"})
    _, table = convert(tmp_path, "t,j1,j2,x,y,z\n1732190000123,0,0,1,2,3\n,0,0,1,2,3\n", mapping)
    assert table["time_s"][0] == 1732190000.123
    assert np.isnan(table["time_s"][1])


def test_a_run_may_have_a_text_format_of_its_own(tmp_path):
    mapping = SIMPLE | {"runs": [{"run": "r", "file": "raw.csv", "format": {"delimiter": ";", "decimal": ","}}]}
    _, table = convert(tmp_path, "j1;j2;x;y;z\n0;0;1,5;2;3\n", mapping)
    assert table["x_mm"].tolist() == [1.5]


def test_a_wrong_time_stamp_is_named(tmp_path):
    mapping = with_columns(time={"column": "t", "format": "%Y%m%d%H%M%S"})
    with pytest.raises(InputError, match=r"line 2, column t.*'2,02011E\+13'"):
        convert(tmp_path, 't,j1,j2,x,y,z\n"2,02011E+13",0,0,1,2,3\n', mapping)


def test_row_filters_keep_the_source_rows_as_ids_and_report_what_they_left_out(tmp_path):
    mapping = SIMPLE | {
        "rows": [
            {"drop_missing": ["x"]},
            {"first_of": ["pose"]},
            {"between": {"column": "pose", "low": 2}},
            {"equal": {"column": "state", "value": "ok"}},
        ]
    }
    raw = (
        "pose,state,j1,j2,x,y,z\n1,ok,0,0,1,2,3\n2,ok,0,0,,,\n2,ok,0,0,1,2,3\n2,ok,0,0,1,2,3\n3,bad,0,0,1,2,3\n"
        "4,ok,0,0,1,2,3\n"
    )
    report, table = convert(tmp_path, raw, mapping)
    assert table["id"].tolist() == ["3", "6"]
    assert [out.rows for out in report.runs[0].left_out] == [[2], [4], [1], [5]]
    text = report.text()
    assert "2 of 6 rows" in text
    assert "left out, no value in x: 1 row (source row 2)" in text


def test_columns_by_number_and_filters_that_leave_nothing_out_are_reported_in_words(tmp_path):
    columns = {"angles": {"columns": [2, 3], "unit": "rad"}, "position": {"columns": [4, 5, 6], "unit": "mm"}}
    mapping = {
        "format": {"header": False},
        "columns": columns,
        "rows": [{"first_of": [1]}, {"drop_missing": [4, 5]}, {"between": {"column": 4, "low": 0}}],
    }
    report, _ = convert(tmp_path, "1,0,0,1,2,3\n1,0,0,1,2,3\n1,0,0,1,2,3\n", mapping)
    assert "left out, not the first row of its column 1: 2 rows (source rows 2, 3)" in report.text()
    assert "left out, no value in columns 4, 5: no row" in report.text()
    assert "left out, column 4 not >= 0: no row" in report.text()


def test_filters_remember_across_pieces_of_a_long_file(tmp_path, monkeypatch):
    monkeypatch.setattr("armscope.recordings.importing.rawfiles.LIMITS", replace(LIMITS, rows=3))
    mapping = with_columns(time={"column": "pose", "unit": "s"}) | {"rows": [{"first_of": ["pose"]}]}
    rows = "".join(f"{k // 2},0,0,{k},2,3\n" for k in range(20))
    report, table = convert(tmp_path, "pose,j1,j2,x,y,z\n" + rows, mapping)
    assert table["x_mm"].tolist() == list(range(0, 20, 2))
    assert table["id"].tolist() == [str(k) for k in range(1, 21, 2)]
    assert report.runs[0].rows_read == 20


def test_rows_of_a_file_beside_are_repeated_for_the_points_of_each_configuration(tmp_path):
    mapping = {
        "columns": {
            "id": {"row_of": "angles"},
            "angles": {"columns": ["angles:j1", "angles:j2"], "unit": "rad"},
            "position": {"columns": ["x", "y", "z"], "unit": "mm"},
            "target": {"cycle": ["left", "right"]},
        },
        "runs": [{"run": "r", "file": "p.csv", "beside": [{"file": "q.csv", "name": "angles", "repeat_each": 2}]}],
    }
    points = "x,y,z\n" + "".join(f"{k},0,0\n" for k in range(4))
    _, table = convert(tmp_path, {"p.csv": points, "q.csv": "j1,j2\n0.1,0.2\n0.3,0.4\n"}, mapping)
    assert table["id"].tolist() == ["1", "1", "2", "2"]
    assert table["target"].tolist() == ["left", "right"] * 2
    assert table["q1_rad"].tolist() == [0.1, 0.1, 0.3, 0.3]
    for wrong in (points + "9,0,0\n", "x,y,z\n1,0,0\n"):
        with pytest.raises(InputError, match="repeat_each"):
            convert(tmp_path, {"p.csv": wrong, "q.csv": "j1,j2\n0.1,0.2\n0.3,0.4\n"}, mapping)


@pytest.mark.parametrize("repeat", [1, 3, 7])
def test_files_beside_are_read_along_whatever_pieces_they_come_in(repeat, tmp_path, monkeypatch):
    monkeypatch.setattr("armscope.recordings.importing.rawfiles.LIMITS", replace(LIMITS, rows=5))
    mapping = {
        "columns": {
            "id": {"row_of": "angles"},
            "angles": {"columns": ["angles:j1", "angles:j2"], "unit": "rad"},
            "position": {"columns": ["x", "y", "z"], "unit": "mm"},
            "target": {"cycle": [str(k) for k in range(repeat)] if repeat > 1 else ["a", "b"]},
        },
        "rows": [{"between": {"column": "y", "low": 0}}, {"between": {"column": "angles:j2", "low": 0}}],
        "runs": [{"run": "r", "file": "p.csv", "beside": [{"file": "q.csv", "name": "angles", "repeat_each": repeat}]}],
    }
    rng = np.random.default_rng(0)
    angles, keep = rng.uniform(-1, 1, (12, 2)), rng.uniform(-1, 1, 12 * repeat)
    points = "x,y,z\n" + "".join(f"{row},{keep[row]},0\n" for row in range(12 * repeat))
    joints = "j1,j2\n" + "".join(f"{a!r},{b!r}\n" for a, b in angles.tolist())
    _, table = convert(tmp_path, {"p.csv": points, "q.csv": joints}, mapping)
    of = np.arange(12 * repeat) // repeat
    expected = np.flatnonzero((keep >= 0) & (angles[of, 1] >= 0))
    assert table["x_mm"].tolist() == expected.tolist()
    np.testing.assert_allclose(table["q1_rad"], angles[of[expected], 0], rtol=1e-9)
    assert table["id"].tolist() == (of[expected] + 1).astype(str).tolist()


def test_the_table_that_comes_out_is_one_that_the_reader_takes(tmp_path):
    mapping = with_columns(orientation={"quaternion": ["a", "b", "c", "w"], "order": "xyzw"})
    convert(tmp_path, "j1,j2,x,y,z,a,b,c,w\n0,0,1,2,3,0.6,0,0,0.8\n", mapping, "out.csv.gz")
    assert gzip.decompress((tmp_path / "out.csv.gz").read_bytes()).startswith(b"id,run,q1_rad")
    recordings = read_recordings(tmp_path / "out.csv.gz", n_motors=2)
    np.testing.assert_allclose(recordings.orientation, [[0.8, 0.6, 0, 0]])


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    delimiter=st.sampled_from([",", ";", "tab", "|"]),
    decimal=st.sampled_from([".", ","]),
    angle=st.sampled_from(["rad", "deg"]),
    length=st.sampled_from(["mm", "m"]),
    by_number=st.booleans(),
    packed=st.booleans(),
)
def test_whatever_way_a_table_is_written_it_comes_back(seed, delimiter, decimal, angle, length, by_number, packed):
    if delimiter == decimal:
        return
    rng = np.random.default_rng(seed)
    values = np.column_stack([rng.uniform(-3, 3, (7, 2)), rng.uniform(-5, 5, (7, 3))])
    order = rng.permutation(5)
    shown = values * [*[{"rad": 1, "deg": 180 / np.pi}[angle]] * 2, *[{"m": 1, "mm": 1e3}[length]] * 3]
    names, sign = np.array(["j1", "j2", "x", "y", "z"])[order], {"tab": "\t"}.get(delimiter, delimiter)
    lines = [sign.join(names)] + [sign.join(repr(float(v)).replace(".", decimal) for v in row[order]) for row in shown]
    column = {name: (int(np.flatnonzero(names == name)[0]) + 1 if by_number else name) for name in names.tolist()}
    mapping = {
        "format": {"delimiter": delimiter, "decimal": decimal},
        "columns": {
            "angles": {"columns": [column["j1"], column["j2"]], "unit": angle},
            "position": {"columns": [column[axis] for axis in "xyz"], "unit": length},
        },
    }
    with tempfile.TemporaryDirectory() as folder:
        raw = Path(folder) / ("raw.csv.gz" if packed else "raw.csv")
        text = "\n".join(lines).encode()
        raw.write_bytes(gzip.compress(text) if packed else text)
        convert_files(Path(folder), [raw], mapping)
        back = read_recordings(Path(folder) / "out.csv")
    np.testing.assert_allclose(back.motor_angles, values[:, :2], rtol=1e-9)
    np.testing.assert_allclose(back.positions, values[:, 2:], rtol=1e-9)


def test_a_long_file_is_read_piece_by_piece(tmp_path, monkeypatch):
    monkeypatch.setattr("armscope.recordings.importing.rawfiles.LIMITS", replace(LIMITS, rows=10))
    (tmp_path / "raw.csv").write_text("a,b\n" + "1,2\n" * 25 + "cut")
    pieces = read_pieces(tmp_path / "raw.csv", TextFormat(), Counter())
    assert len(next(pieces)) == 10  # before the broken end is reached
    assert next(pieces).numbers_of_rows[0] == 11
    with pytest.raises(InputError, match=r"line 27.*cut off"):
        next(pieces)


def test_runs_of_one_file_have_their_own_ids_and_their_own_first_time_stamp(tmp_path):
    text = "day,no,clock,j1,j2,x,y,z\n" + "".join(
        f"{day},{no},{clock},0,0,{no},2,3\n"
        for day, no, clock in (
            ("mon", 1, "10:00:05"),
            ("mon", 2, "10:00:07"),
            ("tue", 1, "09:30:00"),
            ("mon", 3, "10:00:09"),
        )
    )
    mapping = with_columns(run={"column": "day"}, id={"column": "no"}, time={"column": "clock", "format": "%H:%M:%S"})
    report, table = convert(tmp_path, text, mapping)
    assert "4 rows, 2 run(s)" in report.text()
    assert table["run"].tolist() == ["mon", "mon", "tue", "mon"]
    assert table["time_s"].tolist() == [0, 2, 0, 4]
    twice = text + "tue,1,09:31:00,0,0,9,2,3\n"
    with pytest.raises(InputError, match="an id stands once per run and target"):
        convert(tmp_path, twice, mapping)
    with pytest.raises(InputError, match="every row is of a run"):
        convert(tmp_path, text.replace("tue", ""), mapping)
