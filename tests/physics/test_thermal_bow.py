"""A link that bows as it gets warmer, in an arm whose kinematics stand in NumPy alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.diagnosis import diagnose
from armscope.physics.effect import Part
from armscope.physics.scene import Scene
from armscope.physics.thermal import THERMAL_BOW
from armscope.recordings import Recordings
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription

from ..diagnosis.numpy_arms import QUICK, UR5E, reached
from .scenes import arm_named, full_table

ROWS, NOISE_M, BOW, LINK = 120, 3e-5, 6e-5, 2


def points(angles: np.ndarray, temperature: np.ndarray) -> np.ndarray:
    """Row by row, each with the skew of its temperature."""
    errors = np.zeros((len(angles), len(UR5E), 4))
    errors[:, LINK - 1, 3] = BOW * (temperature - 20)
    return np.vstack([reached(UR5E, error, row[None]) for error, row in zip(errors, angles, strict=True)])


def recorded(rng: np.random.Generator) -> Recordings:
    angles, temperature = rng.uniform(-2, 2, (ROWS, 6)), rng.uniform(20, 34, ROWS)
    read = points(angles, temperature) + NOISE_M * rng.normal(size=(ROWS, 3))
    one = np.full(ROWS, "1")
    rows = np.arange(1, ROWS + 1).astype(str)
    return Recordings(angles, read, run=one, target=np.full(ROWS, ""), id=rows, temperature=temperature)


def test_a_link_that_bows_with_temperature_is_told_with_its_axis_and_size() -> None:
    table = recorded(np.random.default_rng(4))
    joints = [{"a_mm": 1e3 * a, "alpha_deg": alpha, "d_mm": 1e3 * d} for a, alpha, d in UR5E]
    arm = build_arm(RobotDescription.model_validate({"name": "arm", "dh": {"joints": joints}}))
    told = diagnose(arm, table, QUICK)
    (bow,) = told.effects
    assert (bow.effect, bow.location) == ("thermal_bow", f"link {LINK}")
    x, y = bow.parameters
    assert abs(y.value - BOW) < 3 * y.stderr < 0.1 * BOW
    assert abs(x.value) < 3 * x.stderr


def test_nothing_bows_where_no_temperature_changed() -> None:
    arm = arm_named("six-axis")
    table = full_table(arm, 20, seed=3)
    assert list(THERMAL_BOW.place(arm, table))
    assert not list(THERMAL_BOW.place(arm, replace(table, temperature=np.full(20, 25.0))))
    assert not list(THERMAL_BOW.place(arm, replace(table, temperature=None)))


def test_at_20_degrees_a_link_is_as_stated() -> None:
    arm = arm_named("six-axis")
    table = replace(full_table(arm, 20, seed=3), temperature=np.linspace(20, 40, 20))
    placed = next(each for each in THERMAL_BOW.place(arm, table) if each.location == "link 2")
    part = Part(placed, np.array([0.0, BOW]))
    scene = Scene(arm, table)
    moved = scene.posture([part]).tool - scene.posture().tool
    assert np.abs(moved[0]).max() < 1e-12
    assert np.abs(moved[-1]).max() > 1e-4
