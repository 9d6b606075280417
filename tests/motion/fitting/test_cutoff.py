"""Noise of the positions does not become torque of the model where torques are low-passed far above the motion."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import diagnose_motion
from armscope.recordings.motions import as_motions
from tests.motion import moving
from tests.motion.moving import robot, table

NOISE = 0.004
"""Of the torques; that of the positions is a tenth of a milliradian, as of an encoder of 15 bits."""


def test_positions_noise_costs_little_beside_the_torques_own(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = moving.path

    def three_times_as_fast(
        rng: np.random.Generator, joints: int, seconds: float, rate: float
    ) -> tuple[Array, Array, Array, Array]:
        time, q, dq, ddq = slow(rng, joints, 3 * seconds, rate / 3)
        return time / 3, q, 3 * dq, 9 * ddq

    monkeypatch.setattr(moving, "path", three_times_as_fast)
    recorded, rng = table(robot(), 3, noise=NOISE), np.random.default_rng(1)
    for j in range(3):
        recorded[f"q{j + 1}_rad"] += 1e-4 * rng.normal(size=len(recorded))
    found = diagnose_motion(robot(), as_motions(recorded, "motions.csv", 3))
    assert found.how.position_cutoff < 0.5 * found.how.cutoff
    assert not found.verdict.effects
    assert (
        found.verdict.held_out.model < 0.0047
    )  # 0.0050 where positions are low-passed at twice their highest frequency
