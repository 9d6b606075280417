"""Scatter is told from what a fit leaves that knows of it; one that does not spreads it over base and neighbours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Driver
from armscope.physics.scene import Scene
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named
from tests.seeds import seeds

QUICK = Settings(resamples=0, cross_validation=False)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
@pytest.mark.parametrize("grows", ["with warmth", "at a moment"])
def test_a_joint_whose_stiffness_changes_scatters_alone_or_it_is_said_that_its_neighbour_may(
    grows: str, seed: int
) -> None:
    """Joint 3 turns about an axis along joint 2's, with another lever; its drive is sound."""
    arm, rng = arm_named("six-axis"), np.random.default_rng(seed)
    table = one_run(arm, 180, seed)
    change = 0.06 * rng.uniform(-8, 16, 180) if grows == "with warmth" else 0.6 * (np.arange(180) >= 90)
    load = Scene(arm, table).driver(Driver("torque", (2,)))
    turned = table.motor_angles.copy()
    turned[:, 1] += 2.5e-6 * change * load
    plain = replace(table, temperature=None, time=None, approach=None, speed=None)
    soft = {("joint_compliance", "joint 2"): [2.5e-6]}
    measured = recorded(arm, replace(plain, motor_angles=turned), soft, 0.03, seed)
    verdict = diagnose(arm, replace(measured, motor_angles=table.motor_angles), QUICK)
    scattered = [e for e in verdict.effects if any(p.name == "scatter" for p in e.parameters)]
    assert scattered
    assert all(e.location == "joint 2" or ("joint 2" in e.title and e.named_as != "effect") for e in scattered)
    assert grows == "at a moment" or [e.location for e in scattered] == ["joint 2"]
    assert verdict.effects[0].effect == "joint_compliance"
    assert verdict.effects[0].location == "joint 2"
