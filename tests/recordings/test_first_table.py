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
    assert (table.delimiter, table.decimal, table.skip, table.encoding) == (expected[0].strip(), *expected[1:])
    assert table.header
    assert table.values.tolist() == [[1.5, 2, 3, 4]]


def test_numbers_alone_have_no_header_and_old_encodings_are_read(tmp_path: Path) -> None:
    path = tmp_path / "raw.csv"
    path.write_bytes("1,2,3,4\n5,6,7,°\n".encode("latin-1"))
    table = first_table(path)
    assert (table.header, table.names, table.encoding) == (False, ["1", "2", "3", "4"], "latin-1")
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
