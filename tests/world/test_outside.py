"""What no library has turns its motor along the curve of its formula."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.world.outside import OUTSIDE
from tests.world.scenes import drawn, scene_of
from tests.world.test_effects import moved, on_motor, turned_by_hand

OUTSIDE_ERRORS = {
    "unknown/local_bump": lambda v, s, q, a, t: v["amplitude"] * np.exp(-0.5 * ((q - v["centre"]) / v["width"]) ** 2),
    "unknown/worn_hysteresis": lambda v, s, q, a, t: -a * v["amplitude"] * (1 + np.tanh((q - v["centre"]) / 0.3)),
    "unknown/loose_beyond": lambda v, s, q, a, t: v["amplitude"] * np.clip(q - v["centre"], 0, None),
    "unknown/tooth_jump": lambda v, s, q, a, t: v["amplitude"] * (q > v["centre"]),
    "unknown/warm_up": lambda v, s, q, a, t: v["amplitude"] * np.exp(-s.time / v["constant"]),
    "unknown/harmonic_product": lambda v, s, q, a, t: (
        v["amplitude"] * np.sin(2 * q) * np.sin(2 * s.commanded[:, int(v["neighbour"]) - 1])
    ),
    "unknown/load_dead_band": lambda v, s, q, a, t: (
        v["amplitude"] * np.sign(t) * np.clip(np.abs(t) - v["threshold"], 0, None) / (np.abs(t).max() - v["threshold"])
    ),
    "unknown/one_sided_spring": lambda v, s, q, a, t: v["amplitude"] * np.clip(t, 0, None) / np.abs(t).max(),
}


def test_no_effect_outside_the_library_goes_unchecked():
    assert set(OUTSIDE_ERRORS) == {kind.name for kind in OUTSIDE}


@pytest.mark.parametrize("kind", OUTSIDE_ERRORS)
def test_an_effect_outside_the_library_turns_its_motor_along_its_curve(kind):
    scene, _ = scene_of("six-axis")
    effect = drawn(scene, kind, "joint 3")
    s, j = scene.session, 2
    amount = OUTSIDE_ERRORS[kind](effect.values, s, s.commanded[:, j], s.approach[:, j], scene.torque[:, j])
    by_hand = turned_by_hand("six-axis", scene, on_motor(scene, j, amount))
    # curves of the load are followed to the equilibrium, where the load is a little different
    assert np.abs(moved(scene, effect) - by_hand).max() < 0.02 * np.abs(by_hand).max()
