"""A sheet of an Excel workbook is read as text is: drafted, imported, refused with a reason."""

import datetime
import gzip
import zipfile

import numpy as np
import openpyxl
import pandas as pd
import pytest
import yaml

from armscope.core.inputs import InputError
from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.importing.tables import import_recordings
from armscope.recordings.importing.workbooks import is_workbook, sheet_rows, sheets_of

RNG = np.random.default_rng(5)
ANGLES, POINTS = RNG.uniform(-120, 120, (12, 6)), RNG.uniform(-900, 900, (12, 3)) + np.array([1500, 0, 500])
NAMES = [*(f"J{j} [deg]" for j in range(1, 7)), *(f"{axis} [mm]" for axis in "XYZ")]


def book(path, *sheets):
    """A workbook of sheets: (name, rows)."""
    made = openpyxl.Workbook()
    made.remove(made.active)
    for name, rows in sheets:
        sheet = made.create_sheet(name)
        for row in rows:
            sheet.append(row)
    made.save(path)
    return path


def table(*head):
    return [*head, NAMES, *(list(map(float, row)) for row in np.hstack([ANGLES, POINTS]))]


def imported(folder, file, text):
    (folder / "mapping.yaml").write_text(text)
    import_recordings([file], folder / "mapping.yaml", folder / "rec.csv")
    return pd.read_csv(folder / "rec.csv")


def test_a_workbook_is_drafted_and_imported(tmp_path):
    file = book(tmp_path / "log.xlsx", ("Tabelle 1", table()))
    text = draft_mapping(file)
    assert yaml.safe_load(text)["format"] == {"kind": "workbook", "sheet": "Tabelle 1"}
    read = imported(tmp_path, file, text)
    np.testing.assert_allclose(read[["x_mm", "y_mm", "z_mm"]], POINTS, atol=1e-6)
    np.testing.assert_allclose(np.degrees(read[[f"q{j}_rad" for j in range(1, 7)]]), ANGLES, atol=1e-6)


def test_titles_and_a_cover_are_passed_over_and_the_other_sheets_are_named(tmp_path):
    rows = table(["Calibration of cell 4"], [None], [])
    file = book(tmp_path / "log.xlsx", ("Cover", [["Operator", "X"]]), ("Data", rows))
    text = draft_mapping(file)
    assert "others: 'Cover'" in text
    assert len(imported(tmp_path, file, text)) == len(POINTS)


def test_a_line_of_groups_above_the_names_says_units_too(tmp_path):
    groups = ["Joint angles [deg]", None, None, None, None, None, "Tracker [cm]", None, None]
    names = [*(f"J{j}" for j in range(1, 7)), "X", "Y", "Z"]
    rows = [groups, names, *(list(map(float, row)) for row in np.hstack([ANGLES, POINTS / 10]))]
    file = book(tmp_path / "log.xlsx", ("Data", rows))
    read = imported(tmp_path, file, draft_mapping(file))
    np.testing.assert_allclose(read[["x_mm", "y_mm", "z_mm"]], POINTS, atol=1e-6)


def test_cells_are_words_as_text_has_them(tmp_path):
    stamp = datetime.datetime(2026, 3, 1, 10, 0, 5)
    file = book(tmp_path / "log.xlsx", ("S", [[1.5, 2, stamp, " a ", None, True], [None], [1e-7, 0.1, None, "b", "c"]]))
    rows = list(sheet_rows(file, None, ","))
    assert rows[0] == (1, ["1,5", "2", "2026-03-01 10:00:05", "a", "", "True"])
    assert rows[2] == (3, ["1e-07", "0,1", "", "b", "c", ""])
    assert sheets_of(file) == ["S"]


def test_a_formula_counts_as_its_value(tmp_path):
    """As Excel saves it: the formula, and what it came to."""
    file = book(tmp_path / "plain.xlsx", ("S", [["a", "b"], [2.0, 7.25]]))
    with zipfile.ZipFile(file) as old, zipfile.ZipFile(tmp_path / "log.xlsx", "w") as new:
        for part in old.namelist():
            new.writestr(part, old.read(part).replace(b"<v>7.25</v>", b"<f>A2*3.625</f><v>7.25</v>"))
    assert list(sheet_rows(tmp_path / "log.xlsx", "S", "."))[1] == (2, ["2", "7.25"])


def test_a_gzipped_one_is_told_by_its_content(tmp_path):
    file = book(tmp_path / "log.xlsx", ("S", table()))
    (tmp_path / "packed.xlsx").write_bytes(gzip.compress(file.read_bytes()))
    assert len(list(sheet_rows(tmp_path / "packed.xlsx", "S", "."))) == 1 + len(POINTS)
    assert is_workbook(file.read_bytes()[:16])


SIMPLE = """format: {{kind: workbook{sheet}}}
columns:
  angles: {{columns: ['J1 [deg]', 'J2 [deg]'], unit: deg}}
  position: {{columns: ['X [mm]', 'Y [mm]', 'Z [mm]'], unit: mm}}
"""


@pytest.mark.parametrize(
    ("sheet", "words"),
    [
        ("", ""),
        (", sheet: Dat", "format.sheet: found 'Dat'; the workbook has no sheet of this name.*Did you mean 'Data'"),
        (", sheet: Empty", "sheet Empty: found nothing; a sheet with rows of values is needed.*Data, Empty"),
    ],
)
def test_the_sheet_is_the_first_or_the_named_one(sheet, words, tmp_path):
    file = book(tmp_path / "log.xlsx", ("Data", table()), ("Empty", []))
    if not words:
        assert len(imported(tmp_path, file, SIMPLE.format(sheet=sheet))) == len(POINTS)
        return
    with pytest.raises(InputError, match=words):
        imported(tmp_path, file, SIMPLE.format(sheet=sheet))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"PK\x03\x04" + bytes(200), "no readable Excel workbook.*Save the sheet as CSV"),
        (b"\xd0\xcf\x11\xe0" + bytes(200), "old Excel workbook, or one with a password.*Save the sheet as CSV"),
        (b"J1,J2\n1,2\n", "no Excel workbook.*leave `kind: workbook` out"),
        (b"", "no Excel workbook"),
    ],
)
def test_what_is_no_workbook_is_one_error(content, words, tmp_path):
    (tmp_path / "log.xlsx").write_bytes(content)
    with pytest.raises(InputError, match=words):
        imported(tmp_path, tmp_path / "log.xlsx", SIMPLE.format(sheet=""))


def test_a_wrong_cell_is_told_by_its_row_and_column(tmp_path):
    rows = table()
    rows[4][7] = "off"
    file = book(tmp_path / "log.xlsx", ("Data", rows))
    with pytest.raises(InputError, match=r"line 5, column Y \[mm\]: found 'off'"):
        imported(tmp_path, file, SIMPLE.format(sheet=""))
