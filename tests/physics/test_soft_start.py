"""Drives that harden, against a maker's three stiffnesses and hand calculations; where they are placed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.effect import Driver, Part
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.model_file import load_model, save_model
from armscope.physics.scene import Scene
from armscope.physics.soft_start import soft_starts
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.kinematics import joint_jacobian

from .scenes import arm_named, full_table

TURN = 1e-5


def setting(name: str = "six-axis") -> tuple[Arm, Recordings]:
    arm = arm_named(name)
    return arm, replace(full_table(arm, 60, seed=3), run=np.full(60, "1"))


def test_it_is_what_a_makers_first_section_turns_beyond_the_last_ones_line() -> None:
    """K1 = 0.6 K3 up to T1 = 0.15 of the rated torque: middle of what makers of strain wave gears state."""
    load = np.linspace(-1.0, 1.0, 2001)
    first, last, ends = 0.6, 1.0, 0.15
    wound = np.sign(load) * np.where(
        np.abs(load) < ends, np.abs(load) / first, ends / first + (np.abs(load) - ends) / last
    )
    beyond = wound - load / last
    assert beyond[-1] / (1.0 / last) == pytest.approx(PLAUSIBLE.soft_share)
    shape = np.tanh(load / PLAUSIBLE.knee_share)
    missed = np.abs(beyond / beyond[-1] - shape)
    assert missed.max() < 0.15
    assert np.sqrt(np.mean(missed**2)) < 0.05


def test_the_tool_moves_by_the_turn_times_its_lever_and_the_other_way_under_the_opposite_load() -> None:
    arm, table = setting()
    nominal = predict(FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}), table)
    lever = joint_jacobian(chain(arm, table.motor_angles))
    starts = list(soft_starts(arm, table))
    assert starts
    for placed in starts:
        j = int(placed.location.split()[1])
        torque = Scene(arm, table).gravity_torques[:, j - 1]
        knee = 0.1 * np.abs(torque).max()
        by_hand = TURN * lever[:, :, j - 1] * np.tanh(torque / knee)[:, None]
        model = FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, parts=(Part(placed, np.array([TURN])),))
        assert np.abs(predict(model, table) - nominal - by_hand).max() < 1e-3 * np.abs(by_hand).max()
        (product,) = placed.terms[0].products
        assert product.driver == Driver("soft start", (j, pytest.approx(knee)))
        recorded = Scene(arm, replace(table, torque=-Scene(arm, table).torques))
        np.testing.assert_allclose(recorded.driver(product.driver), -Scene(arm, table).driver(product.driver))


def test_it_is_as_large_as_a_tenth_of_what_a_drive_gives() -> None:
    for placed in soft_starts(*setting("seven-axis")):
        assert placed.terms[0].plausible == pytest.approx(0.1 * PLAUSIBLE.drive_rad)


def test_a_drive_that_is_loaded_from_one_side_has_none() -> None:
    """From one side it would be a constant, which is an offset of the joint."""
    arm, table = setting()
    torque = Scene(arm, table).torques.copy()
    placed = {each.location for each in soft_starts(arm, replace(table, torque=torque))}
    assert "joint 2" in placed
    torque[:, 1] = np.abs(torque[:, 1])
    left = {each.location for each in soft_starts(arm, replace(table, torque=torque))}
    assert left == placed - {"joint 2"}


def test_without_a_load_that_is_known_there_is_none() -> None:
    arm, table = setting()
    light = replace(arm, masses=np.zeros_like(arm.masses))
    assert not light.has_masses
    assert list(soft_starts(light, table)) == []
    assert list(soft_starts(light, replace(table, torque=Scene(arm, table).torques)))


def test_a_model_file_holds_it_and_refuses_a_knee_that_is_none(tmp_path: Path) -> None:
    arm, table = setting()
    placed = next(iter(soft_starts(arm, table)))
    model = FittedModel(arm, {"1": Base(np.eye(3), np.zeros(3))}, background=(Part(placed, np.array([TURN])),))
    path = tmp_path / "model.yaml"
    save_model(path, model)
    np.testing.assert_allclose(predict(load_model(path), table), predict(model, table), atol=1e-12)
    (product,) = placed.terms[0].products
    no_knee = replace(product, driver=Driver("soft start", (product.driver.arguments[0], 0.0)))
    bent = Part(replace(placed, terms=(replace(placed.terms[0], products=(no_knee,)),)), np.array([TURN]))
    save_model(path, replace(model, background=(bent,)))
    with pytest.raises(InputError, match="a knee is positive"):
        load_model(path)
