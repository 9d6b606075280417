"""A word where a number must stand, and four numbers that are no quaternion, say how to mend them."""

import numpy as np
import pytest

from armscope.recordings.column_reader import how_to_mend, how_to_scale


@pytest.mark.parametrize(
    ("word", "cure"),
    [
        ("x_mm", "second time"),
        ("mm", "holds units"),
        ("1'234.5", "between thousands"),
        ("12,5", "decimal point"),
        ("1.25D+02", "exponent with E"),
        ("01.Mrz", "took a number for a date"),
        ("Mar-01", "took a number for a date"),
        ("1.3.2024", "took a number for a date"),
        ("10:15:30", "Write seconds"),
        ("#DIV/0!", "formula"),
        ("12 mm", "number alone"),
        ("−12.5", "hyphen"),
        ("'1.33", "Remove the apostrophe"),
        ("12°30'00\"", "one decimal number"),
        ("-0.0019\0\000832", "zero bytes"),
        ("\uff11.33", "narrow"),
        ("wide", "Correct it"),
    ],
)
def test_a_word_says_how_to_mend_it(word: str, cure: str) -> None:
    assert cure in how_to_mend(word, "x_mm")


def test_four_numbers_are_scaled_read_as_angles_or_left_empty() -> None:
    assert how_to_scale(np.array([2.0, 0, 0, 0])) == "Its length is 2: divide all four by it."
    assert "Euler angles" in how_to_scale(np.array([0.0, 10, 20, 170]))
    assert "leave all four empty" in how_to_scale(np.zeros(4))
