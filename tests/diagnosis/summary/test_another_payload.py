"""A payload heavier than stated, which masses of links that are off imitate: what gives way says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.another_payload import as_good_as_told
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import Parameter
from tests.diagnosis.planted import Wanted, one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
SOFT: Wanted = {("joint_compliance", "joint 2"): [1e-6], ("joint_compliance", "joint 3"): [2e-6]}
STATED_KG, ROWS, NOISE_MM = np.array([0.0, 60.0, 120.0]), 240, 0.03
HEAVIER = "Weigh the payload first"


def carrying(factor: float, seed: int = 3) -> Diagnosis:
    """The verdict on soft drives under a payload of which a share is stated."""
    arm = arm_named("six-axis")
    stated = np.resize(STATED_KG, ROWS)
    table = replace(one_run(arm, ROWS, seed), temperature=None, time=None, payload=factor * stated)
    return diagnose(arm, replace(recorded(arm, table, SOFT, NOISE_MM, seed), payload=stated), QUICK)


def soft(verdict: Diagnosis) -> dict[str, tuple[float, float, float]]:
    """By joint: the compliance and its interval."""
    told = [e for e in verdict.effects if e.effect == "joint_compliance"]
    return {e.location: (e.parameters[-1].value, *e.parameters[-1].interval) for e in told}


@pytest.mark.parametrize("factor", [1.2, 0.75])
def test_compliances_hold_under_the_payload_that_rows_ask_for(factor: float) -> None:
    verdict = carrying(factor)
    assert "payload_error" not in {e.effect for e in verdict.effects}, "masses that are off imitate it"
    for (_, place), (true,) in SOFT.items():
        value, low, high = soft(verdict)[place]
        assert (value > true) == (factor > 1), "told by the stated payload, it is off"
        assert low < true < high
    for effect in verdict.effects:
        assert HEAVIER in effect.confirm
        assert ("smaller" in effect.confirm) == (factor > 1)
        assert "payload_error" in {other.effect for other in effect.alternatives}


def test_a_payload_as_stated_leaves_intervals_as_they_are() -> None:
    verdict = carrying(1.0)
    for (_, place), (true,) in SOFT.items():
        value, low, high = soft(verdict)[place]
        assert low < true < high
        assert high - low < 0.3 * value
    assert not any(HEAVIER in effect.confirm for effect in verdict.effects)


@pytest.mark.parametrize(("change", "within"), [(-0.02, True), (0.19, True), (0.21, False), (-0.25, False)])
def test_a_payload_that_leaves_a_number_in_its_interval_need_not_be_weighed_for_it(change: float, within: bool) -> None:
    assert as_good_as_told(Parameter("compliance", "rad/(N m)", 1e-6, 1e-7), change) == within
