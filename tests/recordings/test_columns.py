"""The contract's columns: capitals are accepted and told, and what no row can hold is refused with its range."""

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.recordings import read_recordings
from armscope.recordings.column_reader import ColumnReader
from armscope.recordings.columns import COLUMNS, as_in_contract, column_named

HEADER = "Q1_RAD,Q2_Rad, x_mm,Y_MM,z_mm,ID,Temperature_C"


def write(folder, header, *rows):
    file = folder / "recordings.csv"
    file.write_text("\n".join([header, *rows]) + "\n")
    return file


def test_capitals_and_blanks_in_the_header_are_read_and_told(tmp_path):
    table = read_recordings(write(tmp_path, HEADER, "0.1,0.2,1,2,3,007,21", "0.3,0.4,4,5,6,008,22"))
    np.testing.assert_allclose(table.motor_angles, [[0.1, 0.2], [0.3, 0.4]])
    np.testing.assert_allclose(table.positions, [[0.001, 0.002, 0.003], [0.004, 0.005, 0.006]])
    assert table.id.tolist() == ["007", "008"]
    assert any("Q1_RAD" in note and "q1_rad" in note for note in table.notes)
    assert table.extra is None


def test_a_column_that_is_there_twice_but_for_capitals_is_kept_apart(tmp_path):
    table = read_recordings(write(tmp_path, "q1_rad,Q1_RAD,x_mm,y_mm,z_mm", "0.1,0.9,1,2,3"))
    np.testing.assert_allclose(table.motor_angles, [[0.1]])
    assert list(table.extra.columns) == ["Q1_RAD"]
    assert as_in_contract(["Q1_RAD", "q1_rad", "speed"]) == {}


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("temperature_c", -300, "absolute zero"),
        ("temperature_c", 1e5, "steel melts"),
        ("payload_kg", -1, "not negative"),
        ("payload_kg", 1e9, "2300 kg"),
        ("tau1_nm", 1e12, "11,000 kg"),
        ("dq1_rad_s", 1e6, "42 rad/s"),
    ],
)
def test_what_no_row_can_hold_is_refused_with_its_range_and_source(tmp_path, column, value, words):
    file = write(tmp_path, f"q1_rad,x_mm,y_mm,z_mm,{column}", "0,0,0,0,1", f"0.5,1,2,3,{value}")
    with pytest.raises(InputError, match=rf"line 3, column {column}.*{words}.*allowed is"):
        read_recordings(file)


def test_every_column_has_a_meaning_and_a_range_with_a_rule():
    names = [column.name for column in COLUMNS]
    assert len(set(names)) == len(names)
    assert all(column.meaning for column in COLUMNS)
    bounded = [column for column in COLUMNS if np.abs([column.low, column.high]).max() < 1e15]
    assert all(column.rule for column in bounded)
    assert column_named("q12_rad").name == "q{j}_rad"
    assert column_named("q0_rad") is None


def test_ranges_are_those_of_the_readers_own_refusals():
    table = pd.DataFrame({"q1_deg": [721.0]})
    with pytest.raises(InputError, match="two turns"):
        ColumnReader(table, "table").motor_angles(1)


def test_the_position_of_a_slide_is_refused_with_what_to_do(tmp_path):
    table = write(tmp_path, "q1_rad,q2_rad,q3_m,q4_rad,x_mm,y_mm,z_mm", "0.1,0.2,0.05,0.3,1,2,3")
    with pytest.raises(InputError, match=r"q3_m.*this one slides.*hold_joints"):
        read_recordings(table)
