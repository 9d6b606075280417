"""A load that never changes is in every compliance: each says what it would be under another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.diagnosis.summary.stated_load import StatedLoad, stated_load, under_other_loads
from armscope.recordings import Recordings
from armscope.robot import Arm
from armscope.robot.arm import build_arm
from armscope.verdict.diagnosis import Diagnosis
from tests.diagnosis.planted import Wanted, one_run, recorded
from tests.physics.scenes import arm_named

QUICK = Settings(resamples=0, cross_validation=False)
SOFT: Wanted = {("joint_compliance", "joint 2"): [1e-6], ("joint_compliance", "joint 3"): [2e-6]}
STATED_KG, ROWS, NOISE_MM = 150.0, 100, 0.1


def carrying(true_kg: float, stated: Array | None, seed: int = 3) -> tuple[Arm, Recordings]:
    """A six-axis arm with soft drives that carried ``true_kg``, of which ``stated`` is written down."""
    arm = arm_named("six-axis")
    table = replace(one_run(arm, ROWS, seed), temperature=None, time=None)
    moved = recorded(arm, replace(table, payload=np.full(ROWS, true_kg)), SOFT, NOISE_MM, seed)
    return arm, replace(moved, payload=stated)


@pytest.fixture(scope="module")
def half_as_heavy_again() -> Diagnosis:
    return diagnose(*carrying(1.5 * STATED_KG, np.full(ROWS, STATED_KG)), QUICK)


def test_a_compliance_under_a_constant_load_says_what_it_would_be_under_another(half_as_heavy_again) -> None:
    soft = {e.location: e for e in half_as_heavy_again.effects if e.effect == "joint_compliance"}
    for (_, place), (true,) in SOFT.items():
        told = soft[place]
        low, high = told.parameters[0].interval
        value = told.parameters[0].value
        assert low < true < 0.85 * value, "it was fitted to too small a load, of which its interval knows"
        assert "holds for the 150 kg that payload_kg states" in told.confirm
        model = half_as_heavy_again.model
        (part,) = [p for p in model.parts if p.placed.key == ("joint_compliance", place)]
        more, less = under_other_loads(
            part, model.arm, half_as_heavy_again.recordings, StatedLoad(STATED_KG, 0.5 * STATED_KG, "")
        )
        assert (low + high) / 2 * (1 + more) == pytest.approx(true, rel=0.15), "one drive at a time"
        assert more < 0 < less
        assert f"50 % more, this would be about {-100 * more:.0f} % smaller" in told.confirm


def test_the_payload_is_an_alternative_of_what_a_wrong_one_would_make_softer(half_as_heavy_again) -> None:
    for effect in half_as_heavy_again.effects:
        if "holds for the 150 kg" in effect.confirm:
            assert "payload_error" in {other.effect for other in effect.alternatives}


def test_a_load_that_changes_tells_itself() -> None:
    stated = np.where(np.arange(ROWS) % 2, STATED_KG, 0.0)
    arm = arm_named("six-axis")
    table = replace(one_run(arm, ROWS, 3), temperature=None, time=None, payload=stated)
    verdict = diagnose(arm, recorded(arm, table, SOFT, NOISE_MM, 3), QUICK)
    assert {e.effect for e in verdict.effects} == {"joint_compliance"}
    assert not any("holds for the" in e.confirm for e in verdict.effects)


def test_of_an_arm_without_a_stated_load_a_kilogram_is_asked() -> None:
    arm, table = carrying(0.0, None)
    load = stated_load(arm, table)
    assert load is not None
    assert (load.kg, load.off_kg) == (0.0, 1.0)
    assert stated_load(arm, replace(table, payload=np.zeros(ROWS))) is None, "it is stated to carry nothing"
    assert stated_load(arm, replace(table, torque=np.zeros((ROWS, 6)))) is None, "torques tell the load"


def test_a_stated_tool_is_a_load_where_it_hangs() -> None:
    arm, table = carrying(0.0, None)
    tool = {"mass_kg": 6.0, "com_mm": (0.0, 0.0, 100.0)}
    content = arm.description.model_dump() | {"tool_load": tool}
    loaded = build_arm(type(arm.description).model_validate(content))
    load = stated_load(loaded, table)
    assert load is not None
    assert (load.kg, load.off_kg) == (6.0, 3.0)
    np.testing.assert_allclose(load.centre + loaded.tool, [0.0, 0.0, 0.1])
