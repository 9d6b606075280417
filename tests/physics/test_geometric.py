"""A parallelogram whose bars nobody stated: its columns against the loop closed exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.form_constants import FORM
from armscope.physics.geometric import PARALLELOGRAM_GEOMETRY, finer_bars, is_parallelogram
from armscope.physics.scene import Scene
from armscope.robot import Arm
from armscope.robot.arm import build_arm
from armscope.robot.parallelogram import Linkage, forearm_deviation
from tests.physics.scenes import arm_named, full_table


def unstated() -> Arm:
    """The parallelogram arm, of which only the motors' actuation is told."""
    arm = arm_named("parallelogram-120kg")
    return build_arm(arm.description.model_copy(update={"parallelogram": None}))


@pytest.mark.parametrize(("rod", "rocker"), [(0.6e-3, 0.0), (0.0, 0.4e-3), (0.5e-3, -0.3e-3)])
def test_shares_of_the_rocker_turn_the_forearm_as_the_closed_loop_does(rod: float, rocker: float) -> None:
    arm = unstated()
    table = full_table(arm, 60, 3)
    scene = Scene(arm, table)
    for placed in PARALLELOGRAM_GEOMETRY.place(arm, table):
        angle = np.radians(placed.scanned[0][2])
        true = Linkage(crank=0.35, rocker=0.35, rod=1.1, upper_arm=1.1, crank_angle=float(angle))
        wrong = replace(true, rod=true.rod + rod, rocker=true.rocker + rocker)
        expected = forearm_deviation(wrong, scene.elbow_angle) - forearm_deviation(true, scene.elbow_angle)
        part = Part(placed, np.array([rod, rocker]) / true.rocker)
        (_, turn), *_ = PARALLELOGRAM_GEOMETRY.exact(scene, part)  # type: ignore[misc]
        # the columns are its slope: what is left is of second order, most where the linkage is nearly flat
        flattest = np.abs(np.sin(scene.elbow_angle + angle)).min()
        assert flattest > FORM.flat
        np.testing.assert_allclose(turn, expected, atol=0.01 * np.abs(expected).max() / flattest)


def test_directions_of_the_rocker_are_tried_so_densely_that_little_is_left_between_them() -> None:
    """A twentieth of the bars' effect is a slope that would pass for a gear's ratio or a coupling."""
    arm = unstated()
    table = full_table(arm, 60, 3)
    scene = Scene(arm, table)
    true = Linkage(crank=0.35, rocker=0.35, rod=1.1, upper_arm=1.1, crank_angle=float(np.radians(94.6)))
    wrong = replace(true, rod=true.rod - 4e-4, rocker=true.rocker - 4e-4)
    turn = forearm_deviation(wrong, scene.elbow_angle) - forearm_deviation(true, scene.elbow_angle)
    left = []
    for placed in PARALLELOGRAM_GEOMETRY.place(arm, table):
        shares = np.column_stack([scene.driver(term.products[0].driver) for term in placed.terms])
        columns = np.column_stack([np.ones(len(turn)), shares])
        left.append(np.std(turn - columns @ np.linalg.lstsq(columns, turn)[0]))
    assert min(left) < 0.02 * np.std(turn)


def test_finer_directions_lie_about_those_of_bars_that_nobody_stated() -> None:
    scene = Scene(unstated(), full_table(unstated(), 60, 3))
    coarse = {p.scanned[0][2]: p for p in PARALLELOGRAM_GEOMETRY.place(scene.arm, scene.recordings)}
    finer = [p.scanned[0][2] for p in finer_bars(scene, coarse[90.0])]
    assert len(finer) == 11
    assert min(finer) == 87.5
    assert max(finer) == 92.5
    stated = arm_named("parallelogram-120kg")
    (bars,) = PARALLELOGRAM_GEOMETRY.place(stated, full_table(stated, 60, 3))
    assert not finer_bars(Scene(stated, full_table(stated, 60, 3)), bars)


def test_a_serial_arm_has_no_linkage() -> None:
    assert is_parallelogram(unstated())
    assert not is_parallelogram(arm_named("six-axis"))
    assert not list(PARALLELOGRAM_GEOMETRY.place(arm_named("six-axis"), full_table(arm_named("six-axis"), 30, 1)))
