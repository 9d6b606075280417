"""Cells of D-H tables as papers print them: what is written is read whole, or not at all."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.robot.dh_cells import read_dh_cell, written_plainly

LESS_A_QUARTER = (
    *("q2-90", "q2 - 90", "-90+q2", "q_2-90", "q[2] - 90", "q(2)-90", "q2 + (-90)", "q2-90°", "q₂ − 90°", "θ2-90"),
    *("θ₂ − 90", "θ_{2} - 90º", "theta2 - 90 deg", "theta_2-90", "th2-90", "t2-90", "$\\theta_2 - 90^\\circ$"),
    *("q2-pi/2", "θ₂ − π/2", "-pi/2+q2", "q2 - 0.5pi", "q2 - 2pi/4", "-\\frac{\\pi}{2} + \\theta_{2}", "(q2 - 90)"),
)
"""All of them are the second joint's angle less a quarter turn, in a column of degrees."""


@pytest.mark.parametrize("text", LESS_A_QUARTER)
def test_an_offset_is_read_however_it_is_spelt(text):
    read = read_dh_cell(text)
    assert (read.turns, read.joint) == (1, 2)
    assert read.angle("deg") == pytest.approx(-90)


@pytest.mark.parametrize("text", ["-q3", "−θ₃", "-theta_3", "-(q3)", "0 - q3"])
def test_a_joint_that_is_taken_away_turns_the_other_way(text):
    assert (read_dh_cell(text).turns, read_dh_cell(text).joint) == (-1, 3)
    assert read_dh_cell(text).angle("deg") == 0


def test_a_bracket_hands_its_sign_on():
    assert read_dh_cell("-(q3 - 90)").turns == -1
    assert read_dh_cell("-(q3 - 90)").angle("deg") == 90
    assert read_dh_cell("pi/2 - q3").angle("deg") == pytest.approx(90)


@pytest.mark.parametrize("text", ["*", "θ", "q", "theta_i", "θᵢ"])
def test_a_joint_without_a_number_is_the_rows_own(text):
    assert (read_dh_cell(text).turns, read_dh_cell(text).joint, read_dh_cell(text).angle("deg")) == (1, None, 0)


@pytest.mark.parametrize(
    ("text", "degrees"),
    [
        ("-90", -90),
        ("1,5", 1.5),
        ("3pi/4", 135),
        ("3*π/4", 135),
        ("-π/2", -90),
        ("−90°", -90),
        ("pi*3/4", 135),
        ("1e1", 10),
    ],
)
def test_numbers_and_multiples_of_pi(text, degrees):
    assert read_dh_cell(text).angle("deg") == pytest.approx(degrees)
    assert read_dh_cell(text).turns == 0


def test_pi_is_radians_and_a_degree_sign_degrees_whatever_the_column_is_in():
    assert read_dh_cell("q2 - pi/2").angle("rad") == pytest.approx(-90)
    assert read_dh_cell("q2 - 90°").angle("rad") == pytest.approx(-90)
    assert read_dh_cell("q2 - 1.5").angle("rad") == pytest.approx(-math.degrees(1.5))


@pytest.mark.parametrize(
    "text",
    [
        "q1+q2",
        "2q1",
        "q2 90",
        "1 2",
        "sin(q1)",
        "d3",
        "a2",
        "q2-",
        "(q2",
        "q2)",
        "()",
        "",
        "0.1-0.2",
        "1/2",
        "pi/0",
        "1e999",
    ],
)
def test_what_cannot_be_read_whole_is_not_read(text):
    assert read_dh_cell(text) is None


def test_a_joint_and_an_offset_are_what_they_are_by_hand():
    assert written_plainly("θ₂ − 90º") == "θ2 - 90°"


@settings(max_examples=200, deadline=None, derandomize=True, database=None)
@given(st.integers(1, 9), st.integers(-360, 360), st.sampled_from(["+", "-"]), st.booleans(), st.booleans())
def test_a_sum_is_the_same_in_either_order(joint, offset, sign, blanks, first):
    between = " " if blanks else ""
    added = f"+{between}{offset}" if offset >= 0 else f"-{between}{-offset}"
    text = f"{offset}{between}{sign}{between}q{joint}" if first else f"{sign.strip('+')}q{joint}{between}{added}"
    read = read_dh_cell(text)
    assert (read.joint, read.turns, read.angle("deg")) == (joint, -1 if sign == "-" else 1, offset)
