"""Which effects can't stand side by side at one place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Placed, clash
from armscope.physics.freeform import UNKNOWN, refined
from armscope.physics.registry import library
from armscope.physics.transmission import mesh

from .scenes import arm_named, full_table


@pytest.fixture(scope="module")
def curves() -> tuple[Placed, Placed]:
    """The free curve of joint 2's angle on all of a turn, and its finer form."""
    arm, table = arm_named("six-axis"), full_table(arm_named("six-axis"), 800, 1)
    table = replace(table, motor_angles=np.random.default_rng(3).uniform(-np.pi, np.pi, table.motor_angles.shape))
    coarse = next(
        p
        for p in library(arm, table)
        if p.effect is UNKNOWN and p.location == "joint 2" and p.variant == "angle" and not p.refinement
    )
    fine = refined(arm, table, coarse)
    assert fine is not None
    return coarse, fine


@pytest.mark.parametrize(
    ("per_turn", "in_coarse", "in_fine"), [(12, True, True), (30, False, True), (106, False, False)]
)
def test_a_free_curve_holds_a_gears_line_only_as_far_as_its_own_waves_go(
    curves: tuple[Placed, Placed], per_turn: int, in_coarse: bool, in_fine: bool
) -> None:
    coarse, fine = curves
    line = mesh(2, per_turn)
    assert clash(coarse, line) == clash(line, coarse) == in_coarse
    assert clash(fine, line) == in_fine
