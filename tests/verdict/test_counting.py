"""Digits of factors and odds stand only where they say something."""

from __future__ import annotations

from armscope.verdict.counting import odds_in_words, times, with_prefix


def test_what_is_beyond_counting_is_told_without_digits() -> None:
    assert [times(each) for each in (2.24, 810.0, 568932420.0)] == ["2.2", "810", "more than a thousand"]
    assert [odds_in_words(each) for each in (2.5, 8.0, 18.4)] == ["12 to 1", "3000 to 1", "far beyond a thousand to 1"]


def test_large_numbers_have_a_prefix() -> None:
    assert [with_prefix(each, "N m") for each in (12.0, 2.5e4, 3e6)] == ["12 N m", "25 kN m", "3 MN m"]
