"""Words in a row read as a sentence does."""

import pytest

from armscope.core.words import enumerated, or_less, rounded, size_of, table_lines, uncapitalised


def test_words_in_a_row() -> None:
    assert enumerated(["one", "two", "three"]) == "one, two and three"
    assert enumerated(["one", "two"], "or") == "one or two"
    assert enumerated(["one"]) == "one"
    assert enumerated([]) == ""


def test_a_name_keeps_its_capital() -> None:
    assert uncapitalised("The arm") == "the arm"
    assert uncapitalised("D-H rows") == "D-H rows"
    assert uncapitalised("") == ""


def test_a_table_has_a_rule_as_wide_as_its_head():
    lines = table_lines(["arm", ""], [("a", 1), ("b", 0.5)])
    assert lines == [
        "| arm | |",
        "|---|---|",
        "| a | 1 |",
        "| b | 0.5 |",
    ]


@pytest.mark.parametrize(("value", "said"), [(0.0123, "0.012"), (1e-3, "0.001"), (8.4e-8, "below 0.001")])
def test_what_has_converged_is_not_told_to_the_last_bit(value: float, said: str) -> None:
    assert or_less(value) == said


def test_sizes_have_two_digits_and_the_fields_unit() -> None:
    assert (size_of(6.3e-4, "rad"), size_of(-2e-4, "rad", sign=True)) == ("0.63 mrad", "−200 µrad")
    assert (rounded(0.0), rounded(float("nan"))) == ("0", "–")
