"""A joint whose friction changes sides over a wide speed is no name; one with a law of friction near rest stays one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.side_widths import how_friction_turns
from armscope.motion.library.sides import sharp_width
from armscope.motion.model.file import load_motion_model, save_motion_model
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.samples.timing import stretches
from tests.motion.moving import COULOMB, Plant, moved, robot

WIDE, JOINT = 0.04, 1


def wide(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 comes to its size over a speed four times the usual one."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = COULOMB[JOINT] * (np.tanh(dq[:, JOINT] / WIDE) - np.sign(dq[:, JOINT]))
    return extra


def falling(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 is half as high again near rest."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = 0.5 * COULOMB[JOINT] * np.exp(-((dq[:, JOINT] / 0.15) ** 2)) * np.sign(dq[:, JOINT])
    return extra


def bending(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2 grows with the root of the speed besides."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = 3 * np.sqrt(np.abs(dq[:, JOINT])) * np.sign(dq[:, JOINT])
    return extra


def widths(plant: Plant | None) -> Array | None:
    arm = robot()
    every = list(stretches(moved(arm, 3, plant)))
    return how_friction_turns(arm, every, chosen_cutoff(arm, every, None)[0])[0]


def test_a_wide_change_of_sides_is_seen_at_its_joint_alone() -> None:
    found = widths(wide)
    assert found is not None
    assert found[JOINT] == WIDE
    others = np.arange(3) != JOINT
    np.testing.assert_array_equal(found[others], sharp_width(robot())[others])


@pytest.mark.parametrize("plant", [None, falling, bending], ids=["none", "falling", "bending"])
def test_nothing_else_of_friction_over_speed_is_a_wide_change(plant: Plant | None) -> None:
    assert widths(plant) is None


@pytest.mark.long
def test_a_wide_change_of_sides_has_no_name_and_is_in_the_model_file(tmp_path: Path) -> None:
    found = diagnose_motion(robot(), moved(robot(), 3, wide))
    assert found.verdict.answer == "nothing missing"
    assert not found.verdict.effects
    save_motion_model(tmp_path / "model.yaml", found.model)
    again = load_motion_model(tmp_path / "model.yaml")
    assert again.width_of_sides == pytest.approx([0.002, WIDE, 0.002])


def test_friction_that_falls_near_rest_keeps_its_name() -> None:
    found = diagnose_motion(robot(), moved(robot(), 3, falling)).verdict
    assert [(each.effect, each.location) for each in found.effects] == [("stribeck_friction", "joint 2")]
