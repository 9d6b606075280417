"""Bearings softer about one axis than about the other, against statics by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.physics.effect import Part
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.tilting import BEARING_COMPLIANCE
from armscope.physics.uneven_bearing import uneven_bearings
from armscope.robot import forward_kinematics
from tests.world.by_hand import HandArm

from .scenes import arm_named, full_table

ROWS = 20
ABOUT_X, ABOUT_Y, ACROSS = 3e-9, 1e-9, 0.4e-9


@pytest.mark.parametrize("joint", [2, 3, 5])
def test_mean_difference_and_across_are_a_symmetric_compliance_about_x_and_y(joint: int) -> None:
    arm, by_hand = arm_named("six-axis"), HandArm.named("six-axis")
    table = replace(full_table(arm, ROWS, seed=3), run=np.full(ROWS, "1"))
    place = f"joint {joint}"
    even = next(p for p in BEARING_COMPLIANCE.place(arm, table) if p.location == place)
    uneven = next(p for p in uneven_bearings(arm, table) if p.location == place)
    parts = (
        Part(even, np.array([(ABOUT_X + ABOUT_Y) / 2])),
        Part(uneven, np.array([(ABOUT_X - ABOUT_Y) / 2, ACROSS])),
    )
    bases = {"1": Base(np.eye(3), np.zeros(3))}
    moved = predict(FittedModel(arm, bases, (), parts), table) - predict(FittedModel(arm, bases), table)

    expected = []
    points = forward_kinematics(arm, table.motor_angles)
    for q, payload, point in zip(table.motor_angles, table.payload, points, strict=True):
        frame = by_hand.frames(by_hand.actuation @ q)[0][joint - 1]
        moment = by_hand.moment(q, payload, frame[:3, 3], joint - 1)
        x, y = frame[:3, 0], frame[:3, 1]
        tilt = (ABOUT_X * moment @ x + ACROSS * moment @ y) * x + (ACROSS * moment @ x + ABOUT_Y * moment @ y) * y
        expected.append(np.cross(tilt, point - frame[:3, 3]))
    np.testing.assert_allclose(moved, expected, atol=2e-3 * np.abs(expected).max())


def test_an_arm_without_masses_has_none() -> None:
    arm = arm_named("six-axis")
    light = replace(arm, masses=np.zeros_like(arm.masses))
    assert not list(uneven_bearings(light, full_table(arm, ROWS, seed=3)))
