from collections import Counter

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.recordings.importing.formats import TextFormat
from armscope.recordings.importing.rawfiles import read_pieces
from armscope.recordings.importing.rawrows import TextRows, joined, sign_of_thousands, without_thousands


def pieces(tmp_path, text: str, name: str) -> list[TextRows]:
    (tmp_path / name).write_text(text)
    return list(read_pieces(tmp_path / name, TextFormat(), Counter()))


def test_pieces_of_a_file_become_one_with_their_lines(tmp_path):
    (whole,) = pieces(tmp_path, "a,b\n1,2\n3,4\n5,6\n", "whole.csv")
    first, second = whole.take(np.array([0, 1])), whole.take(np.array([2]))
    again = joined([first, second])
    assert again.numbers("b").tolist() == [2.0, 4.0, 6.0]
    assert again.lines.tolist() == whole.lines.tolist() == [2, 3, 4]
    assert again.numbers_of_rows.tolist() == [1, 2, 3]


def test_a_column_that_stands_twice_must_be_told_by_its_number(tmp_path):
    (rows,) = pieces(tmp_path, "a,a\n1,2\n", "twice.csv")
    with pytest.raises(InputError, match="2 times"):
        rows.numbers("a")
    assert rows.numbers(2).tolist() == [2.0]


@pytest.mark.parametrize(
    ("text", "style", "expected"),
    [
        ('a,b\n"1,5","-2,25"\n', {"decimal": ","}, [1.5, -2.25]),
        (
            "a;b\n1 800,851;-12 345 678,5\n",
            {"delimiter": ";", "decimal": ",", "thousands": " "},
            [1800.851, -12345678.5],
        ),
        ("a;b\n1\u202f800,851;2\n", {"delimiter": ";", "decimal": ",", "thousands": " "}, [1800.851, 2]),
        ("a;b\n1.800,5;0,25\n", {"delimiter": ";", "decimal": ",", "thousands": "."}, [1800.5, 0.25]),
        ('a,b\n"1,800.5",0.25\n', {"thousands": ","}, [1800.5, 0.25]),
    ],
)
def test_numbers_with_signs_between_thousands_are_read_where_they_are_declared(text, style, expected, tmp_path):
    (tmp_path / "raw.csv").write_text(text, encoding="utf-8")
    (rows,) = read_pieces(tmp_path / "raw.csv", TextFormat(**style), Counter())
    assert [rows.numbers(name)[0] for name in "ab"] == expected


def test_a_group_of_other_than_three_digits_is_no_thousand(tmp_path):
    (tmp_path / "raw.csv").write_text("a;b\n12 34,5;1\n")
    (rows,) = read_pieces(tmp_path / "raw.csv", TextFormat(delimiter=";", decimal=",", thousands=" "), Counter())
    with pytest.raises(InputError, match="found '12 34,5'"):
        rows.numbers("a")


def test_undeclared_signs_are_told_with_what_declares_them(tmp_path):
    (tmp_path / "raw.csv").write_text("a;b\n1 800,851;1\n")
    (rows,) = read_pieces(tmp_path / "raw.csv", TextFormat(delimiter=";", decimal=","), Counter())
    with pytest.raises(InputError, match=r"line 2, column a: found '1 800,851'.*declare `thousands: ' '`"):
        rows.numbers("a")


def test_what_may_be_a_decimal_sign_is_no_sign_of_thousands():
    assert sign_of_thousands(["1,234", "0.5"]) == ""
    assert sign_of_thousands(["1,234", "1,234.5"]) == ","
    assert without_thousands("n/a", ",") == "n/a"
