"""An arm on a wedge: what gravity that leans does through soft joints has no bearing's name for sure."""

from __future__ import annotations

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose, pipeline
from armscope.diagnosis.summary.leaning_gravity import better_than_a_name
from armscope.robot import Arm
from armscope.robot.arm import build_arm
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.effects import Alternative
from armscope.verdict.schema import HeldOut
from tests.diagnosis.planted import Wanted, one_run, recorded
from tests.physics.scenes import arm_named
from tests.report import verdicts
from tests.seeds import seeds

QUICK = Settings(resamples=0, cross_validation=False)
SOFT: Wanted = {("joint_compliance", "joint 2"): [4e-6], ("joint_compliance", "joint 3"): [3e-6]}


def leaning(arm: Arm, degrees: float) -> Arm:
    """The arm with gravity that leans to the side."""
    g = 9.81 * np.array([np.sin(np.radians(degrees)), 0.0, -np.cos(np.radians(degrees))])
    return build_arm(arm.description.model_copy(update={"gravity_m_s2": tuple(g.tolist())}))


def told_upright(degrees: float, planted: Wanted, seed: int) -> Diagnosis:
    """The verdict on an arm that leans, of which it is stated that it stands upright."""
    upright = arm_named("six-axis")
    table = one_run(upright, 150, seed)
    return diagnose(upright, recorded(leaning(upright, degrees), table, planted, 0.03, seed), QUICK)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_gravity_that_betters_a_name_takes_its_place(seed: int) -> None:
    """A wobble stood in front, and beside it, 16 to 85 nats better, gravity that leans: nobody asked for that."""
    verdict = told_upright(3.0, SOFT, seed)
    assert {(e.effect, e.location) for e in verdict.effects} == set(SOFT)
    (told,) = [n.text for n in verdict.notices if n.kind == "gravity estimated"]
    assert float(told.split()[2]) == pytest.approx(3.0, abs=0.3)
    (why,) = [n.text for n in verdict.notices if n.kind == "gravity" and "would be named" in n.text]
    assert "see whether the base stands level" in why
    np.testing.assert_allclose(verdict.model.arm.gravity, leaning(arm_named("six-axis"), 3.0).gravity, atol=0.06)


def test_gravity_turned_round_is_used_where_joints_push_against_the_stated_one() -> None:
    """A little give "as any arm has" was told, and to enter it, of an arm that hung and was stated to stand."""
    verdict = told_upright(180.0, SOFT, 2)
    assert {(e.effect, e.location) for e in verdict.effects} == set(SOFT)
    assert verdict.model.arm.gravity[2] > 9.7
    assert any("springs that push" in n.text for n in verdict.notices)


@pytest.mark.parametrize(("after", "other", "which"), [(0.05, 0.04, 1), (0.05, 0.06, 0), (np.nan, np.nan, 1)])
def test_a_direction_nobody_asked_for_must_foretell_other_rows_no_worse(after: float, other: float, which: int) -> None:
    both = [verdicts.case(effects=(), held_out=HeldOut(0.4, each)).verdict for each in (after, other)]
    assert pipeline._better_of(*both) is both[which]


@pytest.mark.parametrize(("gap", "beaten"), [(-2.5, False), (-16.0, True)])
def test_only_clearly_better_gravity_takes_a_place(gap: float, beaten: bool) -> None:
    leans = Alternative("leaning_gravity", "base", "elastic", gap, "direction of gravity", 0.0)
    effects = verdicts.compliance(), verdicts.found("axis_wobble", "joint 1", alternatives=(leans,))
    told = better_than_a_name(verdicts.case(effects=effects).verdict)
    assert (told is effects[1]) == beaten == (told is not None)


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_what_a_wedge_does_has_no_other_name_for_sure(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Along gravity as it is stated."""
    monkeypatch.setattr(pipeline, "better_than_a_name", lambda verdict: None)
    for effect in told_upright(3.0, SOFT, seed).effects:
        if effect.effect != "joint_compliance" and effect.effect != "unknown":
            assert "leaning_gravity" in {other.effect for other in effect.alternatives}, effect.title
            assert effect.named_as != "effect"
            assert "leaning gravity" in effect.title
            assert effect.cure.startswith("Level the base")


@pytest.mark.parametrize("seed", seeds(1, 2))
def test_a_bearing_that_tilts_in_an_upright_arm_keeps_its_name(seed: int) -> None:
    wobble: Wanted = {**SOFT, ("axis_wobble", "joint 1"): [5e-5, 2e-5, -4e-5, 3e-5]}
    (found,) = [e for e in told_upright(0.0, wobble, seed).effects if e.effect == "axis_wobble"]
    assert found.named_as == "effect"
    assert "leaning_gravity" not in {other.effect for other in found.alternatives}


def test_an_arm_of_which_nothing_gives_way_tells_nothing_of_gravity() -> None:
    verdict = told_upright(0.0, {("gear_eccentricity", "joint 1"): [4e-4, 2e-4]}, 1)
    assert [e.effect for e in verdict.effects] == ["gear_eccentricity"]
    assert "leaning_gravity" not in {other.effect for e in verdict.effects for other in e.alternatives}
