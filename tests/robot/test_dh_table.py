"""D-H tables as people paste them: the same arm comes out, and every guess is said."""

import contextlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.core.inputs import InputError
from armscope.robot import forward_kinematics
from armscope.robot.arm import build_arm
from armscope.robot.dh_table import parse_dh_table
from armscope.robot.library import nominal_description

UR5E = nominal_description("ur5e").dh.joints
PASTED = """
Joint\ttheta [rad]\ta [m]\td [m]\talpha [rad]
Joint 1\t0\t0\t0.1625\tπ/2
Joint 2\t0\t-0.425\t0\t0
Joint 3\t0\t-0.3922\t0\t0
Joint 4\t0\t0\t0.1333\tπ/2
Joint 5\t0\t0\t0.0997\t-π/2
Joint 6\t0\t0\t0.0996\t0
"""


def same(described):
    ours = build_arm(nominal_description("ur5e"))
    q = np.random.default_rng(0).uniform(-2, 2, (10, 6))
    np.testing.assert_allclose(forward_kinematics(build_arm(described), q), forward_kinematics(ours, q), atol=1e-9)


def rows(units=("mm", "deg"), separator=" ", comma=False):
    length, angle = 1e-3 if units[0] == "m" else 1.0, np.pi / 180 if units[1] == "rad" else 1.0
    values = [(r.a_mm * length, r.alpha_deg * angle, r.d_mm * length, r.theta_offset_deg * angle) for r in UR5E]
    text = "\n".join(separator.join(f"{value:.10g}" for value in row) for row in values)
    return text.replace(".", ",") if comma else text


def test_the_makers_own_table_is_read():
    described = parse_dh_table(PASTED, "UR5e")
    same(described)
    assert not any("lengths" in place or "angles" in place for place in described.source)


@pytest.mark.parametrize("units", [("mm", "deg"), ("m", "deg"), ("mm", "rad"), ("m", "rad")])
@pytest.mark.parametrize("separator", [" ", ", ", ";", "\t", " | "])
def test_units_and_signs_between_are_guessed_and_said(units, separator):
    described = parse_dh_table(rows(units, separator), "UR5e")
    same(described)
    assert f"guessed: {units[0]}," in described.source["dh lengths"]
    assert f"guessed: {units[1]}," in described.source["dh angles"]
    assert "a, alpha, d, theta" in described.source["dh columns"]


def test_decimal_commas_and_the_modified_convention():
    same(parse_dh_table(rows(separator=";", comma=True), "UR5e"))
    same(parse_dh_table(rows(separator=" ", comma=True), "UR5e"))
    assert parse_dh_table(rows(), "arm", "modified").dh.convention == "modified"


@pytest.mark.parametrize("text", ["0,1625,90,0,5,q1", "a,alpha,d,theta\n0,5,90,0,q1", "0,4,q1,90"])
def test_commas_that_part_cells_and_may_be_decimal_ones_are_named(text):
    with pytest.raises(InputError, match="With decimal commas, part the cells by ; or tabs"):
        parse_dh_table(text, "arm")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "rows of a, alpha, d, theta"),
        ("1 2 3 4\n1 2", "line 2"),
        ("a alpha d\n1 two 3", "line 2, column alpha: found 'two'"),
        ("a alpha q\n1 2 3", "line 1"),
        ("a alpha d", "header alone"),
        ("1e9 0 0", r"dh\.joints\[0\]\.a_mm"),
        ("a alpha theta\n1 2 3", "a, alpha and d are needed"),
        ("a,alpha,d,theta\n0,0,200,q1+q2", "line 2, column theta: found 'q1\\+q2'.*q2-90"),
        ("a,alpha,d,theta\n0,0,200,L1", "line 2, column theta: found 'L1'"),
        ("a,alpha,d,theta\n0,0,d3,0", "line 2, column d: found 'd3'; a number. A joint that slides"),
        ("a,alpha,d,theta\n0,0,q3+100,0", "line 2, column d: found 'q3\\+100'"),
        ("a,alpha,d,theta\na2,0,1,0", "line 2, column a: found 'a2'.*instead of its symbol"),
        ("a [rad],alpha,d\n1,0,1", "lengths are in mm"),
        ("a,a,alpha,d\n1,1,0,1", "is one column"),
        ("alpha_{i-1},a_{i-1},d_i,θ_i\n0,0,200,q1", "Add --modified"),
    ],
)
def test_what_is_no_table_is_one_error(text, words):
    with pytest.raises(InputError, match=words):
        parse_dh_table(text, "arm")


@settings(max_examples=150, deadline=None, derandomize=True, database=None)
@given(st.text(alphabet="0123456789.,;|\t\n -+eapith/π[]()mdrg°NaX#", max_size=120))
def test_any_text_is_an_arm_or_one_error(text):
    with contextlib.suppress(InputError):
        assert parse_dh_table(text, "arm").dh.joints


def test_a_quarter_turn_in_radians_beside_degrees_is_refused_with_its_line():
    mixed = "a alpha d theta\n0 1.5708 89 0\n-425 90 0 0\n"
    with pytest.raises(
        InputError, match=r"line 2, alpha: found '1\.5708'; this is 90 degrees.*of line 3, 90, is in deg"
    ):
        parse_dh_table(mixed, "arm")
    with pytest.raises(InputError, match=r"line 1, alpha: found '1\.5708'.*theta of line 2, -90"):
        parse_dh_table("0 1.5708 89 0\n425 0 0 -90\n", "arm")
    assert parse_dh_table("0 pi/2 89 0\n425 0 0 -90\n", "arm").dh.joints[0].alpha_deg == 90  # pi says its unit itself
    for sound in (mixed.replace("1.5708", "90"), mixed.replace("90", "0"), mixed.replace("1.5708", "1.51")):
        parse_dh_table(sound, "arm")
    parse_dh_table("a [mm];alpha [deg];d [mm]\n0;1.5708;89\n425;90;0\n", "arm")  # as it states


def test_rows_between_blanks_keep_a_joints_angle_whole():
    described = parse_dh_table("0 -90 290 q1\n270 0 0 q2 - 90\n70 -90 0 90 - q3\n", "arm")
    assert [row.theta_offset_deg for row in described.dh.joints] == [0, -90, 90]
    assert described.actuation[2] == {"q3": -1}


def test_headings_as_papers_print_them():
    latex = "joint & $\\theta_i$ & $d_i$ [cm] & a_i (mm) & α_i / rad\n1 & $\\theta_1$ & 29 & 0 & -1.5\n"
    row = parse_dh_table(latex, "arm").dh.joints[0]
    assert (row.d_mm, row.alpha_deg) == (290, pytest.approx(np.degrees(-1.5)))
    craig = parse_dh_table("α_{i-1},a_{i-1},d_i,θ_i\n0,0,200,q1\n-pi/2,0,0,q2\n", "arm", "modified")
    assert [row.alpha_deg for row in craig.dh.joints] == [0, -90]


def test_an_offset_in_a_column_of_its_own_is_added_wherever_the_column_stands():
    for head, row in (("theta,offset", "q2,-90"), ("offset,theta", "-90,q2")):
        joints = parse_dh_table(
            f"a,alpha,d,{head}\n0,90,200,{'q1,0' if row[0] == 'q' else '0,q1'}\n0,0,0,{row}\n", "arm"
        )
        assert joints.dh.joints[1].theta_offset_deg == -90


def test_numbers_of_the_rows_before_a_table_without_a_header_are_told_from_its_own():
    plain = parse_dh_table("0,90,89.2,q1\n-425,0,0,q2\n-392,0,0,q3\n", "arm")
    counted = parse_dh_table("1,0,90,89.2,q1\n2,-425,0,0,q2\n3,-392,0,0,q3\n", "arm")
    assert counted.dh == plain.dh
    assert counted.source["dh columns"] == "guessed: the row's number first, then a, alpha, d, theta"
    with pytest.raises(InputError, match="4 numbers in a row"):
        parse_dh_table("1,0,90,89.2,q1\n3,-425,0,0,q2\n", "arm")
