"""Sizes that real arms show: every term of the library has one, and it is in the term's own unit."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.physics.constants import PLAUSIBLE
from armscope.physics.drivers import follows
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from tests.physics.scenes import ARMS, arm_named, full_table

FREE = {"base_drift", "tool_shift", "unknown"}
"""Of these it is known by what they do at the tool only."""


@pytest.mark.parametrize("name", ARMS)
def test_every_term_of_the_library_has_a_plausible_size(name: str) -> None:
    arm = arm_named(name)
    for placed in library(arm, full_table(arm, 40, 1)):
        if placed.name not in FREE:
            assert all(0 < term.plausible < np.inf for term in placed.terms), placed


@pytest.mark.parametrize("name", ARMS)
def test_a_plausible_drive_turns_by_so_much_under_its_largest_load(name: str) -> None:
    arm = arm_named(name)
    table = full_table(arm, 40, 1)
    scene = Scene(arm, table)
    for placed in JOINT_COMPLIANCE.place(arm, table):
        for term in placed.terms:
            load = term.products[0].driver
            assert follows("load", load)
            assert term.plausible * np.abs(scene.driver(load)).max() == pytest.approx(PLAUSIBLE.drive_rad)
