"""Look-alikes are told: what the rows can't keep apart stands beside the name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from tests.diagnosis.planted import one_run, recorded
from tests.physics.scenes import arm_named

ROWS = 150


@pytest.mark.parametrize("in_step", [True, False])
def test_growth_with_a_temperature_that_rises_with_time_may_be_a_drift(in_step: bool) -> None:
    arm = arm_named("seven-axis")  # its first link stands upright: growing, it lifts all that the base carries
    warm = np.linspace(20.0, 28.0, ROWS)
    if not in_step:
        warm = np.random.default_rng(2).permutation(warm)
    table = replace(one_run(arm, ROWS, seed=5), time=np.linspace(0.0, 10800.0, ROWS), temperature=warm)
    table = recorded(arm, table, {("thermal_expansion", "link 1"): [4e-5]}, 0.01, seed=4)
    (found,) = diagnose(arm, table, Settings(resamples=0, cross_validation=False)).effects
    assert (found.effect, found.location) == ("thermal_expansion", "link 1")
    assert (("base_drift", "base") in {(a.effect, a.location) for a in found.alternatives}) == in_step
