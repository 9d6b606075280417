"""A draft mapping reads the foreign table that it was made from, as the table's author meant it."""

import numpy as np
import pandas as pd
import pytest
import yaml

from armscope.core.inputs import InputError
from armscope.recordings import read_recordings
from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.importing.tables import import_recordings

RNG = np.random.default_rng(0)
ANGLES, POINTS = RNG.uniform(-2, 2, (30, 6)), RNG.uniform(-900, 900, (30, 3)) + np.array([3000, 0, 500])
TORQUES = RNG.uniform(-50, 50, (30, 6))
UR_JOINTS = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", *(f"wrist_{n}_joint" for n in (1, 2, 3))]


def written(folder, columns, delimiter=",", decimal=".", head=""):
    table = pd.DataFrame(columns)
    file = folder / "foreign.csv"
    file.write_text(head + table.to_csv(sep=delimiter, decimal=decimal, index=False, lineterminator="\n"))
    return file


def names(pattern, values):
    return {pattern.format(j): values[:, k] for k, j in enumerate(range(1, 1 + values.shape[1]))}


def axes(pattern, values):
    return {pattern.format(axis): values[:, k] for k, axis in enumerate("xyz")}


CASES = {
    "degrees, millimetres": (names("J{}", np.degrees(ANGLES)) | axes("{}", POINTS), ",", ".", ""),
    "German": (names("Achse_A{}", np.degrees(ANGLES)) | axes("{} [mm]", POINTS), ";", ",", ""),
    "German units in brackets": (
        names("A{} [Grad]", np.degrees(ANGLES)) | axes("Mess_{}", POINTS),
        ";",
        ",",
        "",
    ),
    "words behind the number": (
        names("A{}_soll", np.degrees(ANGLES)) | names("A{}_ist", np.degrees(ANGLES) + 1) | axes("{}_ist", POINTS),
        ",",
        ".",
        "",
    ),
    "words and a unit behind the number": (
        names("Joint {} position (deg)", np.degrees(ANGLES)) | axes("TCP {} [mm]", POINTS),
        ",",
        ".",
        "",
    ),
    "joints of a URDF, in the table's order": (
        dict(zip(UR_JOINTS, ANGLES.T, strict=True))
        | {f"{name}_velocity": ANGLES[:, 0] / 9 for name in UR_JOINTS}
        | axes("{}", POINTS),
        ",",
        ".",
        "",
    ),
    "a UR's joints in the order of the alphabet, as ROS logs them": (
        dict(sorted(zip(UR_JOINTS, ANGLES.T, strict=True))) | axes("{}", POINTS),
        ",",
        ".",
        "",
    ),
    "a UR's joints without the word": (
        dict(zip((name.removesuffix("_joint") for name in UR_JOINTS), ANGLES.T, strict=True)) | axes("p{}", POINTS),
        ",",
        ".",
        "",
    ),
    "a UR's joints as the pendant names them": (
        dict(
            zip(
                ("Base", "Shoulder", "Elbow", *(f"Wrist {n} [deg]" for n in (1, 2, 3))),
                np.degrees(ANGLES).T,
                strict=True,
            )
        )
        | axes("{} [m]", POINTS / 1e3),
        ",",
        ".",
        "",
    ),
    "a maker's letters": (
        dict(zip("SLURBT", np.degrees(ANGLES).T, strict=True)) | axes("{}", POINTS),
        ",",
        ".",
        "",
    ),
    "radians, metres, tabs": (names("q_{}", ANGLES) | axes("meas_{}", POINTS / 1e3), "\t", ".", ""),
    "head of three lines": (names("joint_{}_deg", np.degrees(ANGLES)) | axes("p{}", POINTS), ",", ".", "a\nb\nc\n"),
    "commanded beside actual": (
        names("actual_q_{}", ANGLES + 0.1)
        | names("target_q_{}", ANGLES)
        | axes("target_{}", POINTS + 9)
        | axes("tracker_{}", POINTS),
        ",",
        ".",
        "",
    ),
    "torques and speeds beside": (
        names("theta{}", ANGLES) | names("torque{}", TORQUES) | names("vel{}", TORQUES / 100) | axes("X{}"[1:], POINTS),
        ",",
        ".",
        "",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_the_table_is_read_as_it_was_meant(case, tmp_path):
    columns, delimiter, decimal, head = CASES[case]
    file = written(tmp_path, columns, delimiter, decimal, head)
    draft = draft_mapping(file)
    assert "# guessed" in draft
    (tmp_path / "mapping.yaml").write_text(draft)
    import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "out.csv")
    table = read_recordings(tmp_path / "out.csv")
    np.testing.assert_allclose(table.motor_angles, ANGLES, atol=1e-8)
    np.testing.assert_allclose(table.positions, POINTS / 1e3, atol=1e-8)
    if "torque1" in columns:
        np.testing.assert_allclose(table.torque, TORQUES, atol=1e-8)


@pytest.mark.parametrize(
    ("stated", "below"), [("{} [in]", ""), ("{} (Zoll)", ""), ("{}", "deg," * 6 + "inch,inch,inch\n")]
)
def test_inches_are_read_where_the_table_states_them(stated, below, tmp_path):
    file = written(tmp_path, names("J{}", np.degrees(ANGLES)) | axes(stated, POINTS / 25.4))
    head, rows = file.read_text().split("\n", 1)
    file.write_text(f"{head}\n{below}{rows}")
    (tmp_path / "mapping.yaml").write_text(draft_mapping(file))
    import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "out.csv")
    np.testing.assert_allclose(read_recordings(tmp_path / "out.csv").positions, POINTS / 1e3, atol=1e-8)


def test_rows_without_a_value_are_left_out_and_said(tmp_path):
    rows = [
        ",".join(f"{value:.6f}" for value in (*angles, *point)) for angles, point in zip(ANGLES, POINTS, strict=True)
    ]
    rows[3] = rows[3].rsplit(",", 3)[0] + ",---,---,---"
    rows.append("Mittelwert" + "," * 5 + ",1,2,3")
    file = tmp_path / "foreign.csv"
    file.write_text("\n".join(["A1,A2,A3,A4,A5,A6,X,Y,Z", *rows, ""]))
    draft = draft_mapping(file)
    assert "guessed: 2 rows have none there" in draft
    assert "'Mittelwert': no value" in draft
    (tmp_path / "mapping.yaml").write_text(draft)
    import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "out.csv")
    np.testing.assert_allclose(
        read_recordings(tmp_path / "out.csv").positions, np.delete(POINTS, 3, 0) / 1e3, atol=1e-8
    )


def test_a_closing_line_of_means_is_no_row(tmp_path):
    """It has a number in every column of angles and points: only a column that counts rows tells it."""
    file = written(tmp_path, {"Nr": np.arange(1, 31)} | names("J{}", np.degrees(ANGLES)) | axes("{} [mm]", POINTS))
    whole = file.read_text()
    means = ",".join(["Mean", *(f"{value:.4f}" for value in (*np.degrees(ANGLES).mean(0), *POINTS.mean(0)))])
    for lines, rows in (("", 30), (f"{means}\n", 30), (f"{means}\n{means.replace('Mean', 'Max')}\n", 30)):
        file.write_text(whole + lines)
        draft = draft_mapping(file)
        assert ("drop_missing" in draft) == bool(lines)
        (tmp_path / "mapping.yaml").write_text(draft)
        import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "out.csv")
        assert len(read_recordings(tmp_path / "out.csv")) == rows


def test_context_without_a_value_now_and_then_is_read(tmp_path):
    file = written(
        tmp_path, names("J{}", np.degrees(ANGLES)) | axes("{} [mm]", POINTS) | {"Temp": ["---", *["21.5"] * 29]}
    )
    (tmp_path / "mapping.yaml").write_text(draft_mapping(file))
    import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "out.csv")
    temperature = read_recordings(tmp_path / "out.csv").temperature
    assert np.isnan(temperature[0])
    assert (temperature[1:] == 21.5).all()


def test_a_spoilt_number_is_no_missing_value(tmp_path):
    file = tmp_path / "foreign.csv"
    file.write_text("A1,A2,X,Y,Z\n1,2,3,4,5\n1,2,3x1,4,5\n1,2,3,4,5\n")
    assert "missing" not in yaml.safe_load(draft_mapping(file))["format"]


def test_a_table_without_names_is_read_by_its_place(tmp_path):
    file = tmp_path / "bare.txt"
    np.savetxt(file, np.column_stack([ANGLES, POINTS]), fmt="%.9f")
    columns = yaml.safe_load(draft_mapping(file))["columns"]
    assert columns["angles"] == {"columns": [1, 2, 3, 4, 5, 6], "unit": "rad"}
    assert columns["position"] == {"columns": [7, 8, 9], "unit": "mm"}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a,b,c,d\n1,2,3,4\n", "motor angles"),
        ("q1,q2,q3,q4\n1,2,3,4\n", "measured x, y, z"),
        ("", "lines"),
        ("q1,q2,x,y,z\n", "'1 line'"),
        ("theta d a alpha\n0 0.13 0 90\n0 0 -0.6 0\n", "D-H rows.*armscope init -"),
    ],
)
def test_what_looks_like_no_recordings_is_one_error(text, words, tmp_path):
    file = tmp_path / "foreign.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=words):
        draft_mapping(file)


def test_another_encoding_and_other_files_are_named(tmp_path):
    file = tmp_path / "foreign.csv"
    whole = "Achse 1;Achse 2;X;Y;Z\n1;2;3;4;5\n".encode("utf-16")
    file.write_bytes(whole)
    assert yaml.safe_load(draft_mapping(file))["format"]["encoding"] == "utf-16"
    file.write_bytes(whole[:-1])
    with pytest.raises(InputError, match="UTF-16"):
        draft_mapping(file)
    file.write_bytes(b"PK\x03\x04" + bytes(40))
    with pytest.raises(InputError, match="workbook"):
        draft_mapping(file)


def test_motors_are_known_by_other_words_too(tmp_path):
    file = tmp_path / "foreign.csv"
    file.write_text("Achse 1;Achse 2;X [m];Y [m];Z [m]\n10,5;20,5;0,3;0,4;0,5\n")
    columns = yaml.safe_load(draft_mapping(file))["columns"]
    assert columns["angles"] == {"columns": ["Achse 1", "Achse 2"], "unit": "deg"}
    assert columns["position"] == {"columns": ["X [m]", "Y [m]", "Z [m]"], "unit": "m"}


def test_a_column_of_runs_becomes_runs_and_what_is_not_used_is_said(tmp_path):
    """A base that jumped between two sessions of one file is found only where the sessions are known."""
    session = {"session": ["morning"] * 12 + ["after lunch"] * 18, "humidity": np.arange(30.0)}
    file = written(tmp_path, session | names("q{}_rad", ANGLES) | axes("{}_mm", POINTS))
    draft = draft_mapping(file)
    assert "# not used: 'humidity'\n" in draft
    (tmp_path / "mapping.yaml").write_text(draft)
    report = import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "out.csv")
    assert "30 rows, 2 run(s)" in report.text()
    assert read_recordings(tmp_path / "out.csv").run.tolist() == session["session"]


def test_a_column_that_counts_rows_is_no_run(tmp_path):
    file = written(tmp_path, {"Run": np.arange(1, 31)} | names("q{}_rad", ANGLES) | axes("{}_mm", POINTS))
    assert "run:" not in draft_mapping(file)
    assert "# not used: 'Run'" in draft_mapping(file)


def test_a_name_that_is_not_used_ends_no_comment(tmp_path):
    file = written(tmp_path, {"a\u2028rows: []": ANGLES[:, 0]} | names("q{}_rad", ANGLES) | axes("{}_mm", POINTS))
    assert "# not used: 'a?rows: []'" in draft_mapping(file)


def test_several_points_of_a_row_are_reflectors_with_rows_of_their_own(tmp_path):
    """As a tracker with three reflectors, or motion capture, writes them; what has an orientation has one point."""
    other = POINTS + np.array([0.0, 80.0, 0.0])
    seen = np.where(np.arange(30)[:, None] == 4, np.nan, other)  # the second one was hidden once
    turned = {f"q{part}": np.full(30, float(part == "w")) for part in "wxyz"}
    columns = names("q{}_rad", ANGLES) | axes("{}1", POINTS) | axes("{}2", seen) | turned
    file = written(tmp_path, columns)
    (tmp_path / "mapping.yaml").write_text(draft_mapping(file))
    import_recordings([file], tmp_path / "mapping.yaml", tmp_path / "recordings.csv")
    table = read_recordings(tmp_path / "recordings.csv")
    assert len(table) == 59
    for name, points, rows in (("p1", POINTS, np.arange(30)), ("p2", other, np.delete(np.arange(30), 4))):
        own = table.rows(table.target == name)
        assert own.id.tolist() == (rows + 1).astype(str).tolist()
        np.testing.assert_allclose(1e3 * own.positions, points[rows], atol=1e-6)
        np.testing.assert_allclose(own.motor_angles, ANGLES[rows], atol=1e-9)


def test_a_commanded_and_a_measured_point_are_no_two_reflectors(tmp_path):
    columns = names("q{}_rad", ANGLES) | axes("{}_cmd", POINTS + 1) | axes("{}_meas", POINTS)
    content = yaml.safe_load(draft_mapping(written(tmp_path, columns)))
    assert content["columns"]["position"]["columns"] == ["x_meas", "y_meas", "z_meas"]
