"""Which effects can't stand side by side at one place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import clash
from armscope.physics.freeform import UNKNOWN
from armscope.physics.registry import library
from armscope.physics.transmission import mesh

from .scenes import arm_named, full_table


@pytest.mark.parametrize(
    ("rows", "held", "apart"),
    [(200, 20, 21), (800, 40, 41), (3000, 72, 73)],
    ids=["a coarse curve", "one that a finer form follows", "the finest"],
)
def test_a_free_curve_holds_a_gears_line_only_as_far_as_its_own_waves_go(rows: int, held: int, apart: int) -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, rows, 1)
    table = replace(table, motor_angles=np.random.default_rng(3).uniform(-np.pi, np.pi, table.motor_angles.shape))
    angle_curves = [p for p in library(arm, table) if p.effect is UNKNOWN and p.variant == "angle"]
    curve = next(p for p in angle_curves if p.location == "joint 2")
    for per_turn, clashes in ((held, True), (apart, False)):
        line = mesh(2, per_turn)
        assert clash(curve, line) == clash(line, curve) == clashes
