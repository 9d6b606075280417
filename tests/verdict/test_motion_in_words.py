"""Turns and shifts over the recorded rows, as sentences with signs."""

import re

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.registry import library
from armscope.physics.scene import Scene
from armscope.verdict.motion_in_words import correction_in_words, motion_in_words
from tests.physics.scenes import arm_named, full_table


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene(arm_named("six-axis"), full_table(arm_named("six-axis"), 40, 1))


def part(scene: Scene, effect: str, place: str, *values: float) -> Part:
    placed = next(p for p in library(scene.arm, scene.recordings) if p.key == (effect, place))
    return Part(placed, np.array(values))


def numbers(text: str) -> list[float]:
    """Those in mrad, before the degrees in brackets."""
    return [float(each.replace("−", "-")) for each in re.findall(r"[+−]\d+\.?\d*", text.partition("(")[0])]


def test_a_correction_is_the_opposite_of_the_motion_over_the_same_rows(scene: Scene) -> None:
    turned = (part(scene, "gear_ratio", "joint 2", 2e-3),)
    angle = scene.recordings.motor_angles[:, 1]
    ends = [2 * angle.min(), 2 * angle.max()]
    assert numbers(motion_in_words(scene, turned)) == pytest.approx(ends, abs=1e-3)
    assert numbers(correction_in_words(scene, turned)) == pytest.approx([-ends[1], -ends[0]], abs=1e-3)


def test_about_a_zero_the_mean_is_that_zero(scene: Scene) -> None:
    turned = (part(scene, "gear_ratio", "joint 2", 2e-3),)
    angle = scene.recordings.motor_angles[:, 1]
    about = 2 * (angle - angle.mean()) + 0.5
    assert numbers(motion_in_words(scene, turned, 5e-4)) == pytest.approx([about.min(), about.max()], abs=1e-3)


def test_what_is_the_same_in_all_rows_is_one_number(scene: Scene) -> None:
    assert "…" not in motion_in_words(scene, (part(scene, "joint_offset", "joint 3", 1e-3),))


def test_what_no_motor_does_is_left_to_the_command(scene: Scene) -> None:
    placed = next(p for p in library(scene.arm, scene.recordings) if p.key == ("link_geometry", "link 2"))
    moved = (Part(placed, np.full(len(placed.terms), 1e-4)),)
    assert correction_in_words(scene, moved) == "compensate for it in the command"
