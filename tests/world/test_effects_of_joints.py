"""A drive whose compliance changes, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from tests.world.scenes import drawn, scene_of
from tests.world.test_effects import EXACT_M, moved, on_motor, turned_by_hand


@pytest.mark.parametrize("variant", ["", "/temperature"])
def test_a_drive_that_changes_turns_by_its_torque_and_what_it_changes_with(variant):
    scene, _ = scene_of("six-axis")
    effect = drawn(scene, f"compliance_change{variant}", "joint 2")
    v, session, torque = effect.values, scene.session, scene.torque[:, 1]
    later = torque * (session.time > v["time"]) * v["give"] if not variant else 0
    warmer = torque * (session.temperature - 20) * v["give_per_k"] if variant else 0
    by_hand = turned_by_hand("six-axis", scene, on_motor(scene, 1, later + warmer))
    assert np.abs(by_hand).max() > 1e-5
    assert np.abs(moved(scene, effect) - by_hand).max() < EXACT_M
