"""What a D-H table's column theta says of its joints: which turns which row, which way, from where."""

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.robot import forward_kinematics
from armscope.robot.arm import build_arm
from armscope.robot.dh_cells import read_dh_cell
from armscope.robot.dh_joints import ThetaCell, motors_of_rows
from armscope.robot.dh_table import parse_dh_table

HEAD = "a [mm],alpha [deg],d [mm],theta\n"


def rows(*thetas):
    return [
        ThetaCell(line, text, read_dh_cell(text), read_dh_cell(text).angle("deg") if text else 0.0)
        for line, text in enumerate(thetas, 2)
    ]


def step(a, alpha, d, theta):
    """One standard D-H row by its formula."""
    (ct, st), (ca, sa) = (np.cos(theta), np.sin(theta)), (np.cos(alpha), np.sin(alpha))
    return np.array([[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]])


@pytest.mark.parametrize(
    ("turned", "angle"), [("q2-90", lambda q: q - np.pi / 2), ("90 - θ₂", lambda q: np.pi / 2 - q)]
)
def test_the_arm_stands_where_the_rows_formula_says(turned, angle):
    described = parse_dh_table(HEAD + f"0,-90,290,q1\n270,0,0,{turned}\n70,-90,0,-q3\n10,0,302,q4\n", "arm")
    for q in np.random.default_rng(0).uniform(-2, 2, (5, 4)):
        by_hand = (
            step(0, -np.pi / 2, 0.29, q[0]) @ step(0.27, 0, 0, angle(q[1])) @ step(0.07, -np.pi / 2, 0, -q[2])
        ) @ step(0.01, 0, 0.302, q[3])
        np.testing.assert_allclose(forward_kinematics(build_arm(described), q[None])[0], by_hand[:3, 3], atol=1e-12)


def test_what_was_made_of_each_row_is_told():
    source = {}
    motors = motors_of_rows(rows("q1", "q2 - 90", "-q3"), source)
    assert motors == ({"q1": 1.0}, {"q2": 1.0}, {"q3": -1.0})
    assert "'q2 - 90' is q2, -90 degrees added" in source["dh.joints[1]"]
    assert "'-q3' is q3, counted the other way" in source["dh.joints[2]"]
    assert "dh.joints[0]" not in source


def test_joints_as_they_are_counted_need_no_actuation_and_no_note():
    for thetas in (("q1", "q2"), ("*", "*"), ("0", "-90"), ("", "")):
        source = {}
        assert motors_of_rows(rows(*thetas), source) is None
        assert source == {}


def test_a_row_that_names_no_joint_beside_rows_that_do_is_turned_by_none():
    source = {}
    assert motors_of_rows(rows("q1", "q2", "0"), source) == ({"q1": 1.0}, {"q2": 1.0}, {})
    assert "no motor turns it" in source["dh.joints[2]"]
    arm = build_arm(parse_dh_table(HEAD + "0,-90,290,q1\n270,0,0,q2\n0,0,100,0\n", "arm"))
    assert arm.n_motors == 2


def test_numbers_that_count_the_rows_leave_a_bare_one_its_joint():
    source = {}
    assert motors_of_rows(rows("q1", "-90", "q3"), source) is None
    assert "q2 turns it, -90 degrees added" in source["dh.joints[1]"]


def test_joints_that_are_counted_from_zero_are_told():
    source = {}
    assert motors_of_rows(rows("q0", "q1", "q2"), source) is None
    assert "from 0" in source["dh joints"]


@pytest.mark.parametrize(
    ("thetas", "words"),
    [
        (("q1", "q3"), "line 3, column theta: found 'q3'; the joint of this row is number 2"),
        (("q1", "q1"), "line 3, column theta: found 'q1'"),
        (("q1", ""), "line 3, column theta: found nothing"),
    ],
)
def test_joints_that_are_not_the_rows_own_are_one_error(thetas, words):
    with pytest.raises(InputError, match=words):
        motors_of_rows(rows(*thetas), {})
