"""Loads that rise and fall together: what each joint gives way can't be known, and must not be claimed."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose, judgement
from armscope.verdict.effects import INTERVAL, FoundEffect
from tests.diagnosis.planted import one_run, planted, recorded
from tests.physics.scenes import arm_named
from tests.seeds import seeds

QUICK = Settings(resamples=0, cross_validation=False)
TRUE = {"joint 2": 5e-6, "joint 4": 5e-6}
"""rad/(N m)."""


@functools.cache
def found_where_only_two_joints_move(seed: int) -> list[FoundEffect]:
    """Names in a stretched seven-axis arm of which joints 1 and 2 move: joints 2, 4 and 6 bear proportional loads."""
    arm = arm_named("seven-axis")
    table = one_run(arm, 150, seed)
    angles = np.zeros_like(table.motor_angles)
    rng = np.random.default_rng(seed)
    angles[:, 0], angles[:, 1] = rng.uniform(-1.5, 1.5, 150), rng.uniform(-1.2, 1.2, 150)
    table = replace(table, motor_angles=angles, payload=np.zeros(150), temperature=None, time=None, approach=None)
    springs = {("joint_compliance", place): [value] for place, value in TRUE.items()}
    return list(diagnose(arm, recorded(arm, table, springs, 0.03, seed), QUICK).effects)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_compliance_that_another_could_be_is_not_claimed_for_one_joint(seed: int) -> None:
    for effect in found_where_only_two_joints_move(seed):
        beside = {a.location for a in effect.alternatives if a.effect == "joint_compliance" and not a.excluded}
        (value,) = [p for p in effect.parameters if p.name == "compliance"] or [None]
        own = TRUE.get(effect.location, 0.0)
        holds = value is not None and abs(value.value - own) < INTERVAL * value.stderr
        assert holds or (effect.named_as != "effect" and beside)


def test_its_interval_owns_what_springs_elsewhere_might_do(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seed 4 had joint 4 here, seven times too soft; it has no name now, all give way a little."""
    (owned,) = found_where_only_two_joints_move(5)
    monkeypatch.setattr(judgement, "doubts", lambda search, best: {})
    (sure,) = found_where_only_two_joints_move.__wrapped__(5)  # anew, without the doubts
    assert owned.parameters[0].value == sure.parameters[0].value
    assert owned.parameters[0].stderr > 2 * sure.parameters[0].stderr


@pytest.mark.long
def test_where_the_rows_tell_them_apart_it_stays_narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    arm, table = planted("four-axis", {("joint_compliance", "joint 2"): [5e-7]}, 150, 0.02, seed=16)
    (owned,) = diagnose(arm, table, QUICK).effects
    monkeypatch.setattr(judgement, "doubts", lambda search, best: {})
    (sure,) = diagnose(arm, table, QUICK).effects
    assert owned.parameters[0].stderr < 1.2 * sure.parameters[0].stderr
