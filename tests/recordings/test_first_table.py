"""How a foreign table is cut, and what is no table."""

from __future__ import annotations

from pathlib import Path

import pytest

from armscope.core.inputs import InputError
from armscope.recordings.importing.constants import LIMITS
from armscope.recordings.importing.first_table import first_table


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a;b;c;d\n1,5;2;3;4\n", ("; ", ",", 0, "utf-8-sig")),
        ("by hand\nä\tb\tc\td\n1.5\t2\t3\t4\n", ("tab", ".", 1, "utf-8-sig")),
        ("a  b c d\n1.5 2  3 4\n", ("whitespace", ".", 0, "utf-8-sig")),
    ],
)
def test_delimiter_decimal_sign_and_first_line_are_seen(
    text: str, expected: tuple[str, str, int, str], tmp_path: Path
) -> None:
    path = tmp_path / "raw.csv"
    path.write_text(text, encoding="utf-8")
    table = first_table(path)
    assert (table.cut.delimiter, table.cut.decimal, table.skip, table.cut.encoding) == (
        expected[0].strip(),
        *expected[1:],
    )
    assert table.header
    assert table.values.tolist() == [[1.5, 2, 3, 4]]


def test_numbers_alone_have_no_header_and_old_encodings_are_read(tmp_path: Path) -> None:
    path = tmp_path / "raw.csv"
    path.write_bytes("1,2,3,4\n5,6,7,°\n".encode("latin-1"))
    table = first_table(path)
    assert (table.header, table.names, table.cut.encoding) == (False, ["1", "2", "3", "4"], "latin-1")
    assert table.values[0].tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("text", "found"),
    [("a,b,c,d\n", "1 line"), ("a,b,c," + "d" * (LIMITS.name + 1) + "\n1,2,3,4\n", "ddd")],
)
def test_what_is_no_table_is_refused(text: str, found: str, tmp_path: Path) -> None:
    path = tmp_path / "raw.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=found):
        first_table(path)


def table_of(folder, text, encoding="utf-8"):
    (folder / "foreign.csv").write_bytes(text.encode(encoding))
    return first_table(folder / "foreign.csv")


def test_quotation_marks_hold_decimal_commas_together(tmp_path):
    table = table_of(tmp_path, '"J1","J2","X","Y"\n"-1,5","2,25","3,0","4,0"\n"-1,5","2,25","3,0","4,0"\n')
    assert (table.cut.delimiter, table.cut.decimal, table.cut.thousands) == (",", ",", "")
    assert table.values[0].tolist() == [-1.5, 2.25, 3, 4]


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ("1 800,851", (",", " ", 1800.851)),
        ("1\u202f800,851", (",", " ", 1800.851)),
        ("1.800,851", (",", ".", 1800.851)),
        ("1,800.851", (".", ",", 1800.851)),
        ("1'800.851", (".", "'", 1800.851)),
        ("1’800.851", (".", "'", 1800.851)),
    ],
)
def test_signs_between_thousands_are_seen(cell, expected, tmp_path):
    table = table_of(tmp_path, f"J1;J2;X;Y\n1;2;{cell};4\n1;2;3;4\n")
    assert (table.cut.decimal, table.cut.thousands, table.values[0, 2]) == expected


def test_what_is_another_numbers_decimal_sign_parts_no_thousands(tmp_path):
    table = table_of(tmp_path, "J1;J2;X;Y;server\n1.5;2;3;4;192.168.100.100\n1.25;2;3;4;192.168.100.100\n")
    assert (table.cut.decimal, table.cut.thousands) == (".", "")


def test_a_line_of_groups_stands_above_the_names(tmp_path):
    table = table_of(tmp_path, ";Joint angles [rad];;Tracker [in];;\nNo.;A1;A2;X;Y;Z\n1;2;3;4;5;6\n2;2;3;4;5;6\n")
    assert table.names == ["No.", "A1", "A2", "X", "Y", "Z"]
    assert table.skip == 1
    assert table.groups == ["", "rad", "rad", "in", "in", "in"]


def test_chinese_text_that_is_no_utf_8_is_read(tmp_path):
    table = table_of(tmp_path, "关节1,关节2,测量X,测量Y,测量Z\n1,2,3,4,5\n1,2,3,4,5\n", "gb18030")
    assert (table.cut.encoding, table.names[0], table.names[2]) == ("gb18030", "关节1", "测量X")
    german = table_of(tmp_path, "Größe,A1 [°],A2 [°],X\n1,2,3,4\n", "latin-1")
    assert german.cut.encoding == "latin-1"
