"""A wrist whose torque is many times that of its own masses carries something: that is no other unit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.motion_load import with_a_load
from armscope.check.motions import _coarse as coarse
from armscope.check.motions import check_moving
from armscope.recordings.motions import Motions
from armscope.robot.dynamics import MovingArm
from tests.motion.moving import ROBOT, moved, robot
from tests.seeds import seeds

FIRST, SECOND, LAST = ROBOT["links"]  # type: ignore[misc]
LIGHT = {**LAST, "mass_kg": 0.2, "com_mm": [-280, 0, 0], "inertia_kg_m2": [0.001, 0.001, 0.001, 0, 0, 0]}


def light(**more: object) -> MovingArm:
    """An arm whose last link weighs next to nothing, and reaches far."""
    return robot(links=[FIRST, SECOND, LIGHT], **more)


def carrying(mass: float, seed: int) -> Motions:
    return moved(light(tool_load={"mass_kg": mass, "com_mm": [0, 0, 0]}), seed)


@pytest.mark.parametrize("seed", seeds(1, 3))
def test_a_load_that_nobody_stated_is_no_problem_of_the_table(seed: int) -> None:
    found = check_moving(carrying(3.0, seed), light())
    assert not found.has_problems
    (told,) = found.suspicions
    before, _, after = told.statement.partition(" kg")
    assert before.startswith("torques are those of the stated masses and a load of about ")
    assert after.startswith(" that is not stated")
    assert float(before.split()[-1]) == pytest.approx(3.0, rel=0.2)
    assert "tool_load" in told.cure


def test_a_payload_that_the_table_states_is_no_load_that_nobody_stated() -> None:
    motions = carrying(3.0, 1)
    stated = replace(motions, payload=np.full(len(motions), 3.0))
    assert not check_moving(stated, light(tool_mm=[0, 0, 0])).suspicions


@pytest.mark.parametrize("seed", seeds(1, 3))
def test_one_channel_in_another_unit_is_no_load(seed: int) -> None:
    good = moved(robot(), seed)
    for j in (1, 2):
        effort = good.effort.copy()
        effort[:, j] *= 40
        found = check_moving(replace(good, effort=effort), robot())
        assert found.has_problems
        assert not any("a load of" in each.statement for each in found.suspicions)


def test_masses_that_are_right_ask_for_no_load_and_a_turned_sign_comes_first() -> None:
    good, loaded = moved(light(), 1), carrying(3.0, 1)
    samples = coarse(good, "path 1")[1]
    assert with_a_load(samples, light()) is None
    turned = coarse(replace(loaded, effort=loaded.effort * np.array([1.0, -1.0, 1.0])), "path 1")[1]
    assert with_a_load(turned, light()) is None
    found = with_a_load(coarse(loaded, "path 1")[1], light())
    assert found is not None
    assert found[1] == pytest.approx(3.0, rel=0.2)
