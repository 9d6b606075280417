"""Numbers in words: values with their intervals and units, evidence as odds, shares and counts."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.core.words import UNITS, rounded, shown_unit, size_of
from armscope.verdict.effects import Parameter
from armscope.verdict.wording import (
    evidence_in_words,
    odds_in_words,
    percent,
    read_parameter,
    spelled,
    times,
    with_prefix,
)


def test_a_compliance_is_also_told_as_a_stiffness_with_its_interval_turned_round():
    reading = read_parameter(Parameter("compliance", "rad/(N m)", 2e-7, 1e-8))
    assert reading.value == "0.200 µrad per N m"
    assert reading.interval == "0.180 … 0.220 µrad per N m"
    assert reading.also == "stiffness 5 MN m/rad (95 %: 4.55 MN m/rad … 5.54 MN m/rad)"


def test_a_compliance_that_may_be_zero_has_no_interval_as_a_stiffness():
    assert read_parameter(Parameter("compliance", "rad/(N m)", 2e-9, 1e-8)).also == "stiffness 500 MN m/rad"


def test_a_scanned_number_has_no_interval():
    assert read_parameter(Parameter("per_turn", "1/turn", 37.0, 0.0)).interval == "found by trying values"


def test_a_phase_is_told_in_degrees():
    reading = read_parameter(Parameter("phase", "rad", math.pi / 2, math.radians(1)))
    assert reading.value == "90.0°"
    assert reading.interval == "88.0 … 92.0°"


@given(
    unit=st.sampled_from(sorted(UNITS)),
    value=st.floats(1e-9, 1e3),
    relative=st.floats(1e-3, 0.3),
    sign=st.sampled_from([-1, 1]),
)
def test_the_printed_value_and_interval_are_the_parameters(unit, value, relative, sign):
    parameter = Parameter("x", unit, sign * value, value * relative)
    reading = read_parameter(parameter)
    factor, shown = shown_unit(unit, value)
    half = 1.96 * factor * parameter.stderr

    def number(text):
        return float(text.replace("−", "-").replace("°", ""))

    printed = number(reading.value.removesuffix(shown))
    low, high = (number(part) for part in reading.interval.removesuffix(shown).split("…"))
    assert printed == pytest.approx(factor * sign * value, abs=0.1 * half + 1e-6)
    assert low == pytest.approx(factor * sign * value - half, abs=0.1 * half + 1e-6)
    assert high == pytest.approx(factor * sign * value + half, abs=0.1 * half + 1e-6)


@given(st.floats(1e-5, 1e6))
def test_two_digits_are_kept_when_rounding_for_a_sentence(value):
    assert float(rounded(value)) == pytest.approx(value, rel=0.051)


def test_a_sign_stands_only_where_it_means_something():
    assert size_of(-2e-3, "rad", sign=True) == "−2.0 mrad"
    assert size_of(-2e-3, "rad") == "2.0 mrad"


@pytest.mark.parametrize(
    ("nats", "words"),
    [(0.3, "hardly"), (2.0, "some evidence: odds of about 7 to 1"), (4.0, "strong evidence: odds of about 55 to 1"),
     (8.0, "very strong evidence: odds of about 3000 to 1"), (300.0, "overwhelming evidence: odds far beyond")],
)  # fmt: skip
def test_evidence_is_told_as_odds(nats, words):
    assert evidence_in_words(nats).startswith(words)


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.553, "55 %"),
        (0.0949, "9.5 %"),
        (0.0123, "1.2 %"),
        (1e-5, "< 0.1 %"),
        (53.0, "over 100 %"),
        (math.nan, "–"),
        (0.9991, "99.9 %"),
        (0.99999, "99.9 %"),
        (0.9951, "99.5 %"),
        (0.9949, "99 %"),
        (1.0, "100 %"),
        (1.02, "100 %"),
    ],
)
def test_shares_carry_no_false_digits(share, text):
    assert percent(share) == text


def test_counts_are_words_while_words_exist():
    assert [spelled(n) for n in (0, 2, 12, 13)] == ["no", "two", "twelve", "13"]


def test_what_is_beyond_counting_is_told_without_digits() -> None:
    assert [times(each) for each in (2.24, 810.0, 568932420.0)] == ["2.2", "810", "more than a thousand"]
    assert [odds_in_words(each) for each in (2.5, 8.0, 18.4)] == ["12 to 1", "3000 to 1", "far beyond a thousand to 1"]


def test_large_numbers_have_a_prefix() -> None:
    assert [with_prefix(each, "N m") for each in (12.0, 2.5e4, 3e6)] == ["12 N m", "25 kN m", "3 MN m"]
