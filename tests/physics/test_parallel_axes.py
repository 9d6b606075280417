"""Lengths along parallel axes: rows do not tell them apart, and one of the named rows holds them all."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.physics.effect import Placed
from armscope.physics.geometric import LINK_GEOMETRY, row_terms
from armscope.physics.parallel_axes import lengths_told_once
from armscope.physics.scene import Scene
from armscope.robot import Arm
from armscope.robot.arm import build_arm
from armscope.robot.library import nominal_description
from tests.physics.scenes import arm_named, full_table


def link(arm: Arm, number: int) -> Placed:
    terms = tuple(row_terms(arm, number).values())
    return Placed(LINK_GEOMETRY, f"link {number}", terms, (1.0,) * len(terms), "constant")


def lengths_kept(arm: Arm, *numbers: int) -> list[int]:
    told = lengths_told_once(arm, [link(arm, number) for number in numbers])
    assert all(len(placed.terms) == len(placed.prior_scale) for placed in told)
    return [n for n, placed in zip(numbers, told, strict=True) if "d" in [term.name for term in placed.terms]]


def moved(arm: Arm, number: int) -> np.ndarray:
    """(N, 3) how far a millimetre along a joint's axis moves the tool in random poses, m."""
    posture = Scene(arm, full_table(arm, 20, 5)).posture()
    (length,) = [term for term in link(arm, number).terms if term.name == "d"]
    return np.asarray(1e-3 * posture.column(length))


@pytest.mark.parametrize("name", ["ur5e", "irb120", "panda"])
def test_only_what_moves_the_tool_alike_is_told_once(name: str) -> None:
    arm = build_arm(nominal_description(name))
    for one in range(1, arm.n_joints):
        alike = np.allclose(moved(arm, one), moved(arm, one + 1), atol=1e-9)
        assert lengths_kept(arm, one, one + 1) == ([one + 1] if alike else [one, one + 1])


def test_three_parallel_axes_have_one_length_even_where_the_middle_one_has_no_name() -> None:
    arm = build_arm(nominal_description("ur5e"))
    assert lengths_kept(arm, 4, 2) == [4]
    assert lengths_kept(arm, 2, 3, 4, 5) == [4, 5]
    assert lengths_kept(arm, 2) == [2]


def test_modified_rows_stand_before_their_joints() -> None:
    arm = arm_named("seven-axis")
    assert arm.is_modified_dh
    assert lengths_kept(arm, 1, 2, 3) == [1, 2, 3]
