"""Noise of the positions does not become torque of the model where torques are low-passed far above the motion."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.pipeline import diagnose_motion
from armscope.motion.samples.timing import stretches
from armscope.recordings.motions import as_motions
from tests.motion import moving
from tests.motion.moving import robot, table

NOISE = 0.004
"""Of the torques; that of the positions is a tenth of a milliradian, as of an encoder of 15 bits."""


SLOW = moving.path


def faster(times: int) -> Callable[[np.random.Generator, int, float, float], tuple[Array, Array, Array, Array]]:
    """The paths of the tests, so many times as fast."""

    def path(rng: np.random.Generator, joints: int, seconds: float, rate: float) -> tuple[Array, Array, Array, Array]:
        time, q, dq, ddq = SLOW(rng, joints, times * seconds, rate / times)
        return time / times, q, times * dq, times**2 * ddq

    return path


def test_each_run_is_low_passed_where_its_own_motion_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Noise of the acceleration of a slow run, in the band of a fast one, made inertias look small."""
    slow = table(robot(), 3, runs=1, noise=NOISE)
    monkeypatch.setattr(moving, "path", faster(6))
    fast = table(robot(), 4, runs=1, noise=NOISE).assign(run="fast")
    recorded = as_motions(pd.concat([slow, fast], ignore_index=True), "motions.csv", 3)
    how, _ = chosen_cutoff(robot(), list(stretches(recorded)), None)
    ((run, hz),) = how.of_runs
    assert run == "path 1"
    assert hz < 0.5 * how.position_cutoff
    assert f"({hz:.3g} Hz in the slowest run)" in how.words
    alone, _ = chosen_cutoff(robot(), list(stretches(as_motions(slow, "motions.csv", 3))), None)
    assert not alone.of_runs


@pytest.mark.long
def test_positions_noise_costs_little_beside_the_torques_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moving, "path", faster(3))
    recorded, rng = table(robot(), 3, noise=NOISE, seconds=15.0), np.random.default_rng(1)
    for j in range(3):
        recorded[f"q{j + 1}_rad"] += 1e-4 * rng.normal(size=len(recorded))
    found = diagnose_motion(robot(), as_motions(recorded, "motions.csv", 3))
    assert found.how.position_cutoff < 0.5 * found.how.cutoff
    assert not found.verdict.effects
    assert (
        found.verdict.held_out.model < 0.0047
    )  # 0.0050 where positions are low-passed at twice their highest frequency
