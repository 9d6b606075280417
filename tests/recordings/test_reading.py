"""What the reader makes of good tables: SI units, context, byte-order marks, compression."""

import gzip

import numpy as np
import pandas as pd
import pytest

from armscope.core.files import write_table
from armscope.core.inputs import InputError
from armscope.recordings import as_recordings, read_recordings
from tests.recordings.test_bad_input import ROWS, table, write


def test_units_stand_in_the_names(tmp_path):
    text = "q1_deg,q2_rad,x_m,y_m,z_m\n90,0.5,1,2,3\n"
    read = read_recordings(write(tmp_path, text))
    assert np.allclose(read.motor_angles, [[np.pi / 2, 0.5]])
    assert np.allclose(read.positions, [[1, 2, 3]])
    assert read.id.tolist() == ["1"]
    assert read.run.tolist() == [""]


def test_a_byte_order_mark_is_no_part_of_the_first_name(tmp_path):
    read = read_recordings(write(tmp_path, table(*ROWS), encoding="utf-8-sig"))
    assert read.id.tolist() == ["1", "2", "3"]


def test_windows_line_ends_and_gzip(tmp_path):
    file = tmp_path / "recordings.csv.gz"
    file.write_bytes(gzip.compress(table(*ROWS).replace("\n", "\r\n").encode()))
    assert len(read_recordings(file)) == 3


def test_context_columns_keep_their_gaps(tmp_path):
    text = (
        "q1_rad,x_mm,y_mm,z_mm,run,temperature_c,payload_kg,time_s,approach1,dq1_rad_s,tau1_nm,sigma_mm,colour\n"
        "0.1,1,2,3,a,20,,0,1,0.5,10,0.02,red\n0.2,1,2,3,b,,2,5,-1,0.5,,0.03,blue\n"
    )
    read = read_recordings(write(tmp_path, text))
    assert read.run.tolist() == ["a", "b"]
    assert np.array_equal(read.temperature, [20, np.nan], equal_nan=True)
    assert np.array_equal(read.payload, [np.nan, 2], equal_nan=True)
    assert read.approach.tolist() == [[1], [-1]]
    assert np.allclose(read.sigma, [[2e-5] * 3, [3e-5] * 3])
    assert read.torque.shape == (2, 1)
    assert list(read.extra) == ["colour"]
    assert "colour" in read.notes[0]


def test_an_empty_column_was_not_recorded(tmp_path):
    read = read_recordings(write(tmp_path, "q1_rad,x_mm,y_mm,z_mm,temperature_c\n0.1,1,2,3,\n0.2,1,2,3,\n"))
    assert read.temperature is None


def test_poses_to_be_predicted_need_no_positions(tmp_path):
    read = read_recordings(write(tmp_path, "q1_rad\n0.1\n"), measured=False)
    assert np.isnan(read.positions).all()


def test_an_id_may_return_in_another_run_or_for_another_target(tmp_path):
    text = (
        "id,run,target,q1_rad,x_mm,y_mm,z_mm\n1,a,p,0,1,2,3\n1,b,p,0,1,2,3\n1,a,q,0,1,2,3\n,a,p,0,1,2,3\n,a,p,0,1,2,3\n"
    )
    assert len(read_recordings(write(tmp_path, text))) == 5


def test_ids_stay_text(tmp_path):
    read = read_recordings(write(tmp_path, "id,q1_rad,x_mm,y_mm,z_mm\n007,0,1,2,3\n"))
    assert read.id.tolist() == ["007"]


@pytest.mark.parametrize(("ids", "numbers"), [("7 9 12", [7, 9, 12]), ("a 9 c", [1, 2, 3]), ("7 12 9", [1, 2, 3])])
def test_rows_keep_the_numbers_of_the_whole_table(tmp_path, ids, numbers):
    """Ids are their numbers where they rise; else the order, which a part of the table must not count anew."""
    lines = [f"{one},0.1,0.2,1,2,3" for one in ids.split()]
    file = tmp_path / "recordings.csv"
    file.write_text("\n".join(["id,q1_rad,q2_rad,x_mm,y_mm,z_mm", *lines]))
    table = read_recordings(file, 2)
    assert table.number.tolist() == numbers
    assert table.rows(np.array([2, 0])).rows(slice(0, 1)).number.tolist() == [numbers[2]]


def test_rows_take_everything_along(tmp_path):
    text = "id,q1_rad,x_mm,y_mm,z_mm,time_s,colour\n1,0,1,2,3,10,red\n2,1,4,5,6,20,blue\n3,2,7,8,9,30,green\n"
    some = read_recordings(write(tmp_path, text)).rows(np.array([2, 0]))
    assert some.id.tolist() == ["3", "1"]
    assert some.time.tolist() == [30, 10]
    assert some.extra["colour"].tolist() == ["green", "red"]
    assert len(some) == 2


def test_write_and_read_again_gives_the_same(tmp_path):
    rng = np.random.default_rng(0)
    values = pd.DataFrame(rng.normal(size=(20, 5)), columns=["q1_rad", "q2_rad", "x_mm", "y_mm", "z_mm"])
    file = tmp_path / "t.csv.gz"
    write_table(file, values, digits=17)
    again = read_recordings(file)
    assert np.array_equal(again.motor_angles, as_recordings(values).motor_angles)
    assert np.array_equal(again.positions, as_recordings(values).positions)


@pytest.mark.parametrize("name", ["deg", "rad"])
def test_angles_up_to_two_turns_are_plausible(tmp_path, name):
    value = 700 if name == "deg" else 12.5
    read = read_recordings(write(tmp_path, f"q1_{name},x_mm,y_mm,z_mm\n{value},1,2,3\n"))
    assert read.motor_angles[0, 0] > 12


def test_a_column_that_stands_twice_in_a_data_frame_is_refused() -> None:
    frame = pd.DataFrame({"q1_rad": [0.1, 0.2], "x_mm": [1.0, 2.0], "y_mm": [1.0, 2.0], "z_mm": [1.0, 2.0]})
    with pytest.raises(InputError, match=r"x_mm.*twice"):
        as_recordings(pd.concat([frame, frame[["x_mm"]]], axis=1))


def test_runs_that_are_numbers_with_gaps_are_words_without_a_warning(recwarn) -> None:
    frame = pd.DataFrame({"q1_rad": [0.1, 0.2], "x_mm": [1.0, 2.0], "y_mm": [1.0, 2.0], "z_mm": [1.0, 2.0]})
    read = as_recordings(frame.assign(run=[1.0, np.nan]))
    assert list(read.run) == ["1.0", ""]
    assert not recwarn.list
