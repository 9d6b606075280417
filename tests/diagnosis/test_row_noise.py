"""Scatter is told from what a fit leaves that knows of it; one that does not spreads it over base and neighbours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Driver
from armscope.physics.scene import Scene
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import FoundEffect
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named
from tests.seeds import seeds

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, GIVE = 180, 2.5e-6


def softened(seed: int, change: Array) -> Diagnosis:
    """What is said of a joint 2 whose stiffness is another one in some rows; nothing is recorded that tells why.

    Joint 3 turns about an axis along joint 2's, with another lever; its drive is sound.
    """
    arm = arm_named("six-axis")
    table = one_run(arm, ROWS, seed)
    load = Scene(arm, table).driver(Driver("torque", (2,)))
    turned = table.motor_angles.copy()
    turned[:, 1] += GIVE * change * load
    plain = replace(table, temperature=None, time=None, approach=None, speed=None)
    soft = {("joint_compliance", "joint 2"): [GIVE]}
    measured = recorded(arm, replace(plain, motor_angles=turned), soft, 0.03, seed)
    verdict = diagnose(arm, replace(measured, motor_angles=table.motor_angles), QUICK)
    assert (verdict.effects[0].effect, verdict.effects[0].location) == ("joint_compliance", "joint 2")
    return verdict


def scattered(verdict: Diagnosis) -> list[FoundEffect]:
    return [e for e in verdict.effects if any(p.name == "scatter" for p in e.parameters)]


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_joint_whose_stiffness_changes_with_what_nobody_recorded_scatters_alone(seed: int) -> None:
    warmth = np.random.default_rng(seed).uniform(-8, 16, ROWS)
    found = scattered(softened(seed, 0.06 * warmth))
    assert [e.location for e in found] == ["joint 2"]
    assert [p.name for p in found[0].parameters] == ["scatter", "give"], "it grows with its load"


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_joint_whose_stiffness_changes_at_a_moment_is_told_so_and_nothing_scatters(seed: int) -> None:
    """It was scatter, in half of such arms at its sound neighbour."""
    verdict = softened(seed, 0.6 * (np.arange(ROWS) >= ROWS // 2))
    assert not scattered(verdict)
    (change,) = [e for e in verdict.effects if e.effect == "compliance_change"]
    assert change.location == "joint 2"
    sizes = {p.name: p for p in change.parameters}
    assert abs(sizes["give"].value - 0.6 * GIVE) < 3 * sizes["give"].stderr
    assert abs(sizes["row"].value - (ROWS // 2 + 1)) <= 2
