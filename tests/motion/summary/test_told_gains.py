"""A drive's gain far from what is stated has its name, whatever else is off beside it."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.recordings.motions import Motions
from armscope.verdict.effects import Parameter
from tests.motion.moving import ROBOT, moved, robot
from tests.seeds import seeds

STATED, GAIN = 10.0, 0.93
"""N m/A of all drives; times which joint 2's torque is recorded."""


def by_currents(seed: int, gain: float) -> Motions:
    """Motions of an arm whose masses are all off a little, which hides a gain."""
    links: list[dict[str, Any]] = ROBOT["links"]  # type: ignore[assignment]
    shares = (1.1, 0.93, 1.08)
    true = [
        {**link, "mass_kg": share * link["mass_kg"], "com_mm": [1.05 * share * each for each in link["com_mm"]]}
        for link, share in zip(links, shares, strict=True)
    ]
    motions = moved(robot(links=true), seed, noise=0.01)
    return dataclasses.replace(motions, kind="current", effort=motions.effort * [1.0, gain, 1.0] / STATED)


def told_gain(motions: Motions, uncertainty: float) -> Parameter | None:
    arm = robot(drives=[{"gain_nm_per_a": STATED, "gain_uncertainty": uncertainty}] * 3)
    verdict = diagnose_motion(arm, motions, MotionSettings(cutoff=10.0)).verdict
    named = [each for each in verdict.effects if each.effect == "motor_constant"]
    assert all(each.location == "joint 2" for each in named)
    return named[0].parameters[0] if named else None


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_gain_beyond_what_is_stated_is_told(seed: int) -> None:
    found = told_gain(by_currents(seed, GAIN), 0.015)
    assert found is not None
    low, high = found.interval
    assert low < GAIN - 1 < high


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
@pytest.mark.parametrize(("gain", "unsure"), [pytest.param(1.0, 0.015, marks=pytest.mark.long), (0.98, 0.03)])
def test_gains_within_what_is_stated_have_no_name(seed: int, gain: float, unsure: float) -> None:
    assert told_gain(by_currents(seed, gain), unsure) is None
