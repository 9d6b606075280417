"""Each way in which a recordings table can be wrong ends in one error: file, row, column, value, rule, cure."""

import gzip

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.recordings import read_recordings

HEADER = "id,q1_rad,q2_rad,x_mm,y_mm,z_mm"
ROWS = ["1,0.1,0.2,100,200,300", "2,0.3,0.4,101,201,301", "3,0.5,0.6,102,202,302"]


def write(folder, text, name="recordings.csv", encoding="utf-8"):
    file = folder / name
    file.write_bytes(text.encode(encoding))
    return file


def table(*rows, header=HEADER):
    return "\n".join([header, *rows]) + "\n"


def changed(row, column, value):
    cells = [line.split(",") for line in ROWS]
    cells[row][HEADER.split(",").index(column)] = value
    return table(*(",".join(line) for line in cells))


def complaint(file, **options):
    with pytest.raises(InputError) as error:
        read_recordings(file, **options)
    message = str(error.value)
    assert message.startswith(str(file))
    assert "\n" not in message
    return message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        pytest.param(changed(1, "x_mm", ""), ["line 3", "x_mm", "nothing", "required"], id="empty cell"),
        pytest.param(changed(2, "q1_rad", "nan"), ["line 4", "q1_rad", "nothing", "required"], id="NaN"),
        pytest.param(changed(2, "y_mm", "inf"), ["line 4", "y_mm", "inf", "finite"], id="infinite"),
        pytest.param(
            table(*[f"{n},0.1,0.2,{'9' * 400},4,5" for n in range(3)]), ["line 2", "x_mm", "finite"], id="400 digits"
        ),
        pytest.param(changed(0, "z_mm", "tall"), ["line 2", "z_mm", "'tall'", "number"], id="text in a number"),
        pytest.param(changed(0, "z_mm", "TRUE"), ["line 2", "z_mm", "number"], id="a truth value in a number"),
        pytest.param(
            changed(1, "q2_rad", "35.5"), ["line 3", "q2_rad", "35.5", "12.57", "q2_deg"], id="degrees as rad"
        ),
        pytest.param(changed(2, "id", "1"), ["line 4", "id", "'1'", "line 2"], id="duplicate id"),
        pytest.param(table(*ROWS, "4,0.1,0.2,3,4"), ["line 5", "5 values", "6 values"], id="a row too short"),
        pytest.param(table(*ROWS, "4,0.1,0.2,3,4,5,6"), ["line 5", "7 values", "6 values"], id="a row too long"),
        pytest.param(table(ROWS[0] + ",9", *ROWS[1:]), ["line 2", "7 values", "6 values"], id="the first row too long"),
        pytest.param(
            table(ROWS[0], "2,0.3,0.4,101,5,201,301"), ["line 3", "7 values", "decimal comma"], id="decimal comma, bare"
        ),
        pytest.param(changed(1, "x_mm", '"101,5"'), ["line 3", "x_mm", "101,5", "decimal point"], id="decimal comma"),
        pytest.param(
            table(*[row + ",0" for row in ROWS], header=HEADER + ",x_mm"), ["line 1", "x_mm", "twice"], id="same column"
        ),
        pytest.param(
            table(ROWS[0], HEADER, ROWS[1]),
            ["line 3", "q1_rad", "number", "second time"],
            id="the header again in the middle",
        ),
        pytest.param(table(*ROWS).replace("x_mm", "X"), ["line 1", "no column x_mm"], id="missing position"),
        pytest.param(table(*ROWS).replace("q2_rad", "q3_rad"), ["line 1", "no column q2_rad"], id="missing angle"),
        pytest.param(
            table(*ROWS).replace("q1_rad", "j1").replace("q2_rad", "j2"), ["no column q1_rad"], id="no angles"
        ),
        pytest.param(table(*ROWS).replace(",", ";"), ["line 1", "commas"], id="semicolons"),
        pytest.param("", ["line 1", "nothing", "names the columns"], id="empty file"),
        pytest.param(HEADER + "\n", ["line 2", "nothing", "one measured row"], id="header only"),
        pytest.param(table(ROWS[0], "", ROWS[1]), ["line 3", "nothing", "blank line"], id="blank line"),
        pytest.param(changed(1, "x_mm", '"101'), ["quotation mark"], id="a quotation mark that is never closed"),
        pytest.param(table('"' + ROWS[0], *ROWS * 20_000), ["line", "quotation mark"], id="never closed, long file"),
        *(
            pytest.param(changed(1, "x_mm", word), ["line 3", "x_mm", "must be a number", cure], id=f"x_mm is {word}")
            for word, cure in (
                ("1'234.5", "between thousands"),
                ("1 234.5", "between thousands"),
                ("1_234", "between thousands"),
                ('"1,234.5"', "between thousands"),
                ("812 mm", "Write the number alone"),
                ("12°", "Write the number alone"),
                ("\N{MINUS SIGN}12.5", "as a hyphen"),
                ("[mm]", "holds units, remove it"),
                ("#REF!", "formula of the spreadsheet"),
                ("01.Mrz", "took a number for a date"),
                ("1-Mar", "took a number for a date"),
                ("1.25D+02", "exponent with E"),
                ("2024-05-01T10:00:00", "Write seconds"),
                ("３.５", "Write digits 0 to 9"),
                ("0x1F", "Correct it, or remove the row"),
            )
        ),
        pytest.param("name: arm\na: [1, 2, 3]\n", ["line 2", "3 values", "the right file"], id="no table at all"),
        pytest.param("sep=,\n" + table(*ROWS), ["line 1", "sep=,", "Remove this line"], id="a spreadsheet's own line"),
        pytest.param("\n".join(ROWS), ["line 1", "numbers", "Write a line q1_rad"], id="no names at all"),
        pytest.param('[{"q1_rad": 0.1, "q2_rad": 0.2}]', ["line 1", "JSON", "Save it as CSV"], id="JSON"),
        pytest.param("<table><tr><td>0.1", ["line 1", "HTML or XML", "Save it as CSV"], id="HTML"),
        pytest.param(table(*ROWS).replace(",", "   "), ["line 1", "by commas", "armscope init"], id="blanks"),
        pytest.param(table(*ROWS, header=HEADER.replace(",", "','").join("''")), ["Remove the quotes"], id="quotes"),
        pytest.param(table(*ROWS).replace("_rad", " [rad]"), ["'q1 [rad]'", "call it q1_rad"], id="units in brackets"),
        pytest.param(
            table("1,0.1,0.2,0.3,0.4,0.5", header="id,x1,y1,z1,arm_1_joint,arm_2_joint"),
            ["If 'arm_1_joint' is motor 1's angle"],
            id="a point's column is no angle",
        ),
        pytest.param(table(*ROWS).replace("q1_rad", "J1").replace("q2_rad", "J2"), ["'J1'", "call it q1_rad"], id="J1"),
        pytest.param(table(*ROWS).replace("x_mm", "x_nm"), ["no column x_mm", "mean 'x_nm'"], id="a slip in a name"),
        pytest.param(
            changed(1, "x_mm", "NaN"),
            ["line 3, column x_mm: found nothing, written 'NaN'", "required"],
            id="no value in words",
        ),
        pytest.param(changed(1, "x_mm", ""), ["line 3, column x_mm: found nothing", "required"], id="no value"),
        pytest.param(
            "run,time_s,q1_rad,q2_rad\na,0,0.1,0.2\n",
            ["no columns x_mm, y_mm, z_mm, and neither tau1_nm nor current1_a", "torques stand in tau1_nm"],
            id="angles alone",
        ),
        pytest.param(changed(1, "x_mm", "1e308"), ["line 3", "x_mm", "1e+308", "no recorded value"], id="huge"),
        pytest.param(changed(1, "x_mm", "1.5e7"), ["line 3", "x_mm", "10 km"], id="beyond any instrument"),
    ],
)
def test_one_error_that_says_where_what_and_how_to_mend_it(tmp_path, text, words):
    message = complaint(write(tmp_path, text))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"qw": 1, "qx": 0, "qy": 0}, ["line 1", "no column qz", "come together"]),
        ({"qw": 1, "qx": 0, "qy": 0, "qz": 1}, ["line 2", "quaternion", "length"]),
        ({"approach1": 1}, ["no column approach2"]),
        ({"approach1": 1, "approach2": 3}, ["line 2", "approach2", "3", "-1 or +1"]),
        ({"qw": 1, "qx": 0, "qy": 0, "qz": ""}, ["line 2", "qw ... qz", "3 of 4", "whole"]),
        ({"sigma_mm": -1}, ["line 2", "sigma_mm", "-1", "not negative"]),
        ({"sigma_mm": 1e-300}, ["line 2", "sigma_mm", "1e-07 mm"]),
        ({"sigma_mm": 1e12}, ["line 2", "sigma_mm", "10 km"]),
        ({"sigma_mm": 1, "sigma_x_mm": 1, "sigma_y_mm": 1, "sigma_z_mm": 1}, ["sigma_mm and sigma_x_mm"]),
        ({"payload_kg": -2}, ["line 2", "payload_kg", "-2", "not negative"]),
        ({"temperature_c": -300}, ["line 2", "temperature_c", "-300", "absolute zero"]),
        ({"tau1_nm": 1e200, "tau2_nm": 0}, ["line 2", "tau1_nm", "no recorded value"]),
        ({"sigma_x_mm": 1}, ["no column sigma_y_mm"]),
        ({"temperature_c": "warm"}, ["line 2", "temperature_c", "'warm'", "number"]),
        ({"payload_kg": "1,5"}, ["payload_kg"]),
        ({"q3_rad": 0.1}, ["q3_rad", "2 motors"]),
    ],
)
def test_optional_columns_are_checked_too(tmp_path, columns, words):
    header = ",".join([HEADER, *columns])
    values = ",".join(f'"{value}"' if "," in str(value) else str(value) for value in columns.values())
    message = complaint(write(tmp_path, table(*[f"{row},{values}" for row in ROWS], header=header)), n_motors=2)
    for word in words:
        assert word in message, message


def test_too_few_motors_for_the_arm(tmp_path):
    message = complaint(write(tmp_path, table(*ROWS)), n_motors=3)
    assert "no column q3_rad" in message
    assert "has 2 motor angles: is this the right robot" in message


def test_a_missing_file_and_a_folder(tmp_path):
    assert "no readable file" in complaint(tmp_path / "nowhere.csv")
    assert "no readable file" in complaint(tmp_path)


def test_a_file_that_is_not_text(tmp_path):
    file = tmp_path / "recordings.csv"
    file.write_bytes(b"id,q1_rad\n\xff\xfe\x00\x01")
    assert "UTF-8" in complaint(file)


def test_words_that_pandas_takes_for_nothing_stay_words(tmp_path):
    text = table(*[row + ",NA,None" for row in ROWS], header=HEADER + ",run,target").replace("\n1,", "\nnull,")
    read = read_recordings(write(tmp_path, text))
    assert read.run.tolist() == ["NA"] * 3
    assert read.target.tolist() == ["None"] * 3
    assert read.id.tolist() == ["null", "2", "3"]


def test_a_broken_gzip_file(tmp_path):
    file = tmp_path / "recordings.csv.gz"
    whole = gzip.compress(table(*ROWS * 200).encode())
    for broken in (whole[:-20], whole[:30], whole[:5], whole[:40] + b"something else"):
        file.write_bytes(broken)
        assert "no readable file" in complaint(file)
        assert "copy or download it again" in complaint(file)


def test_a_gzip_file_of_another_method_says_what_to_do(tmp_path):
    file, whole = tmp_path / "recordings.csv.gz", bytearray(gzip.compress(table(*ROWS).encode()))
    whole[2] = 5  # the byte that names the method
    file.write_bytes(bytes(whole))
    assert "damaged (Unknown compression method): copy or download it again" in complaint(file)


def test_joints_that_go_by_names_lead_to_a_drafted_mapping(tmp_path):
    header = HEADER.replace("q1_rad", "shoulder_pan_joint").replace("q2_rad", "wrist_1_joint")
    header = header.replace("q2_rad", "elbow_joint")
    both = header.replace("wrist_1_joint", "elbow_joint")
    for n_motors in (None, 2):
        message = complaint(write(tmp_path, table(*ROWS, header=both)), n_motors=n_motors)
        assert "`armscope init recordings.csv -o mapping.yaml`" in message
        assert "motor 1" not in message


def test_compression_is_told_by_the_content_whatever_the_name(tmp_path):
    plain = write(tmp_path, table(*ROWS), name="recordings.csv.gz")
    packed = tmp_path / "recordings.csv"
    packed.write_bytes(gzip.compress(table(*ROWS).encode()))
    assert len(read_recordings(plain)) == len(read_recordings(packed)) == 3


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"PK\x03\x04" + bytes(range(200)), ["Excel", "Save the sheet as CSV"]),
        (b"MATLAB 5.0 MAT-file" + bytes(200), ["MATLAB file", "armscope import"]),
        (table(*ROWS).encode("utf-16"), ["UTF-16", "Save it as UTF-8"]),
        (b"\x80\x04\x95", ["never loaded"]),
        (b"\x93NUMPY\x01\x00", ["never loaded"]),
        (table(*ROWS, "4,0.1,0.2,\u00b0,2,3").encode("latin-1"), ["line 5", "0xb0", "UTF-8"]),
    ],
)
def test_another_kind_of_file_is_named_by_what_it_is(tmp_path, content, words):
    file = tmp_path / "recordings.csv"
    file.write_bytes(content)
    message = complaint(file)
    for word in words:
        assert word in message, message


def test_half_an_angle_unit_is_an_error(tmp_path):
    message = complaint(write(tmp_path, table(*ROWS, header=HEADER.replace("q1_rad", "q1"))))
    assert "q1_rad" in message


@pytest.mark.parametrize("second", ["q1_deg", "y_m"])
def test_one_quantity_in_two_units_is_ambiguous(tmp_path, second):
    text = table(*[row + ",5" for row in ROWS], header=f"{HEADER},{second}")
    assert f"{second}; one column" in complaint(write(tmp_path, text)).replace("'", "")


def test_nothing_of_this_touches_a_good_table(tmp_path):
    good = read_recordings(write(tmp_path, table(*ROWS)))
    assert len(good) == 3
    assert np.allclose(good.positions[0], [0.1, 0.2, 0.3])


def test_a_table_whose_motors_are_counted_from_zero_is_told_so(tmp_path):
    text = table(*ROWS).replace("q1_rad", "q0_rad").replace("q2_rad", "q1_rad")
    assert "call q0_rad q1_rad" in complaint(write(tmp_path, text), n_motors=2)


def test_utf_16_without_its_mark_is_told_what_it_is(tmp_path):
    assert "Save it as UTF-8" in complaint(write(tmp_path, table(*ROWS), encoding="utf-16-le"))


def test_a_column_with_a_slip_is_kept_and_said_to_be_like_a_known_one(tmp_path):
    header = HEADER + ",temprature_c,payload,colour"
    rows = [f"{row},20,1,red" for row in ROWS]
    (note,) = read_recordings(write(tmp_path, table(*rows, header=header))).notes
    assert "temprature_c (did you mean temperature_c?)" in note
    assert "payload (did you mean payload_kg?)" in note
    assert note.endswith("colour")
    rows = [f"{row},1" for row in rows]
    both = read_recordings(write(tmp_path, table(*rows, header=header + ",payload_kg"))).notes[0]
    assert "payload_kg" not in both, "it is there"


@pytest.mark.parametrize(
    ("numbers", "cure"),
    [("2,0,0,0", "divide all four by it"), ("0,10,20,170", "Euler angles"), ("0,0,0,0", "leave all four empty")],
)
def test_four_numbers_that_are_no_quaternion_are_told_what_they_may_be(tmp_path, numbers, cure):
    rows = [f"{row},{numbers}" for row in ROWS]
    assert cure in complaint(write(tmp_path, table(*rows, header=HEADER + ",qw,qx,qy,qz")))


def test_a_run_of_a_table_without_runs_is_told_as_that(tmp_path):
    recordings = read_recordings(write(tmp_path, "q1_rad,q2_rad,x_mm,y_mm,z_mm\n0.1,0.2,1,2,3\n"))
    with pytest.raises(InputError, match=r"found 'nix'; no row has this run\. The table names no runs"):
        recordings.of_runs(["nix"])
