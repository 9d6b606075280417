"""A first line that names no columns says what the file is; one that does, says nothing."""

import pytest

from armscope.recordings.other_formats import what_it_is


@pytest.mark.parametrize(
    ("line", "found", "cure"),
    [
        ("q\0001\0,x\0", "zero bytes", "UTF-8"),
        ('[{"q1_rad": 1},{"q1_rad": 2}]', "JSON", "Save it as CSV"),
        ("<!DOCTYPE html>", "HTML", "Save it as CSV"),
        ("q1_rad;q2_rad;x_mm", "q1_rad;", "armscope init log.txt"),
        ("q1_rad   q2_rad   x_mm", "q1_rad", "armscope init log.txt"),
        ("| q1_rad | x_mm |", "| q1_rad", "armscope init log.txt"),
        ("0.1,-2e-3,.5", "numbers", "Write a line q1_rad"),
        ("CONST robtarget p0:=[[1,2,3],[1,0,0,0]];", "a robot's program", "a row per pose"),
        ("E6AXIS XP0={A1 1.3,A2 0}", "a robot's program", "a row per pose"),
        ("movej([0,1,2,3,4,5], a=1)", "a robot's program", "a row per pose"),
        ("# exported by a tracker", "a comment", "Remove the lines above"),
        ("'q1_rad','x_mm'", "single quotes", "Remove the quotes"),
    ],
)
def test_a_line_without_columns_is_told_what_it_is(line: str, found: str, cure: str) -> None:
    told = what_it_is(line.split(","), "log.txt")
    assert told
    assert found in told[0]
    assert cure in told[2]


@pytest.mark.parametrize(
    "line",
    ["q1_rad,q2_rad,x_mm", "id, q1_rad ,a note,x_mm", "joint angle,x 1,y", "name", "def,q1_rad,x_mm", "#,q1_rad,x_mm"],
)
def test_a_line_that_may_name_columns_is_left_to_their_reader(line: str) -> None:
    assert what_it_is(line.split(","), "log.csv") is None
