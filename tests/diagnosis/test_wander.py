"""Time: a slow wander of the set-up is background, a jump and a steady drift keep their names, look-alikes are told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.fitting.transfer import transfer
from armscope.physics.model import predict
from armscope.physics.model_file import load_model, save_model
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.robot.arm import build_arm
from armscope.verdict.diagnosis import Diagnosis
from tests.seeds import seeds

from ..physics.scenes import arm_named
from .planted import one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
ROWS = 100


def session(name: str = "four-axis") -> tuple[Arm, Recordings]:
    """An arm measured for three hours with noise of 0.02 mm, row after row; the temperature stays what it is."""
    arm = arm_named(name)
    table = replace(one_run(arm, ROWS, seed=5), time=np.linspace(0.0, 10800.0, ROWS), temperature=None)
    return arm, recorded(arm, table, {}, 0.02, seed=9)


def wandering(table: Recordings, size_mm: float) -> Recordings:
    """The table measured from an instrument that settled exponentially and breathed: neither a line nor a step."""
    hours = table.time / 3600
    way = np.exp(-hours / 0.5) + 0.5 * np.sin(2.2 * hours)
    shape = np.outer((way - way.mean()) / way.std(), [0.8, -0.5, 0.33])
    return replace(table, positions=table.positions + 1e-3 * size_mm * shape)


def warming(arm: Arm, table: Recordings, kelvin: float, only: int | None = None) -> Recordings:
    """The table of a steel arm that warmed up in its first hours, without anybody's measuring how warm it was.

    The whole arm, or one link (1-based) only.
    """
    dh, share = arm.description.dh, 1.001
    rows = [
        row.model_copy(update={"a_mm": row.a_mm * share, "d_mm": row.d_mm * share}) if only in (None, j) else row
        for j, row in enumerate(dh.joints, start=1)
    ]
    longer = build_arm(arm.description.model_copy(update={"dh": dh.model_copy(update={"joints": tuple(rows)})}))
    growth = forward_kinematics(longer, table.motor_angles) - forward_kinematics(arm, table.motor_angles)
    warmth = kelvin * (1 - np.exp(-table.time / 4000))
    return replace(table, positions=table.positions + growth * (12e-6 / 1e-3 * (warmth - warmth.mean()))[:, None])


def drift_of(verdict: Diagnosis) -> float:
    """RMS of the wander that was allowed for, mm."""
    return next(family.rms_at_tool_mm for family in verdict.background_families if family.family == "drift")


@pytest.fixture(scope="module")
def wandered() -> Diagnosis:
    """What is said of a set-up that wanders as far as the noise goes."""
    arm, table = session()
    return diagnose(arm, wandering(table, 0.02), QUICK)


def test_a_slow_wander_is_background_and_no_jump(wandered: Diagnosis) -> None:
    verdict = wandered
    assert verdict.effects == ()
    assert drift_of(verdict) == pytest.approx(0.02 / np.sqrt(3), rel=0.3)
    assert "slow drift of base and instrument" in verdict.headline
    assert next(cause for cause in verdict.causes if cause.family == "drift").cure.startswith("Fasten the instrument")


@pytest.mark.long
@pytest.mark.parametrize("link", seeds(2, 4))
def test_a_link_that_warms_up_by_itself_is_told_as_that_and_no_loose_base(link: int) -> None:
    """What was bolted down was to be fastened, and the error stayed."""
    arm, table = session()
    verdict = diagnose(arm, warming(arm, table, 60.0, link), QUICK)
    drift = next(cause for cause in verdict.causes if cause.family == "drift")
    assert drift.text.startswith(f"link {link} grows and shrinks slowly")
    assert "temperature_c" in drift.cure
    assert "base" not in drift.text


@pytest.mark.long
def test_a_link_that_warms_up_is_background_and_no_jump_of_the_tool() -> None:
    arm, table = session()
    verdict = diagnose(arm, warming(arm, table, 8.0), QUICK)
    assert verdict.effects == ()
    assert drift_of(verdict) == pytest.approx(0.028, rel=0.2)


@pytest.mark.long
@pytest.mark.parametrize("in_order", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_wander_that_is_surely_seen_stays_though_poses_came_in_order(in_order: bool) -> None:
    """Along the order of rows a wander says nothing of other rows: only what is barely seen must foretell better."""
    arm, table = session()
    if in_order:
        table = table.rows(np.argsort(table.motor_angles[:, 0]))
        table = replace(table, time=np.linspace(0.0, 10800.0, ROWS))
    moved = wandering(table, 0.05)
    verdict = diagnose(arm, replace(moved, time=None, number=np.arange(1.0, ROWS + 1)), QUICK)
    assert drift_of(verdict) == pytest.approx(0.05 / np.sqrt(3), rel=0.4)


def test_where_nothing_wanders_none_is_allowed_for() -> None:
    verdict = diagnose(*session(), QUICK)
    assert verdict.answer == "nothing missing"
    assert drift_of(verdict) == 0


def test_a_steady_drift_keeps_its_name() -> None:
    arm, table = session()
    steady = np.outer(np.linspace(-1, 1, ROWS), [0.05, -0.03, 0.02]) * 1e-3
    (found,) = diagnose(arm, replace(table, positions=table.positions + steady), QUICK).effects
    assert found.effect == "base_drift"


def test_a_jump_keeps_its_name_beside_a_wander() -> None:
    arm, table = session()
    table = wandering(table, 0.015)
    table.positions[60:] += [2e-4, -1e-4, 1e-4]
    jumps = [effect for effect in diagnose(arm, table, QUICK).effects if effect.effect == "base_shift"]
    assert [effect.location for effect in jumps] == ["base"]
    moment = {p.name: p.value for p in jumps[0].parameters}["time"]
    assert moment == pytest.approx(table.time[60], abs=400)


@pytest.mark.long
@pytest.mark.parametrize("in_step", [True, False])
def test_growth_with_a_temperature_that_rises_with_time_may_be_a_drift(in_step: bool) -> None:
    arm, table = session(
        "four-axis-modified"
    )  # its first link stands upright: growing, it lifts all that the base carries
    warm = np.linspace(20.0, 28.0, ROWS)
    if not in_step:
        warm = np.random.default_rng(2).permutation(warm)
    table = recorded(arm, replace(table, temperature=warm), {("thermal_expansion", "link 1"): [4e-5]}, 0.01, seed=4)
    (found,) = diagnose(arm, table, QUICK).effects
    assert (found.effect, found.location) == ("thermal_expansion", "link 1")
    assert (("base_drift", "base") in {(a.effect, a.location) for a in found.alternatives}) == in_step


def test_a_wander_belongs_to_its_session(wandered: Diagnosis, tmp_path) -> None:
    """Rows without a time are of now, where the recording left the set-up; another recording starts without it."""
    _, table = session()
    moved = wandering(table, 0.02)
    save_model(tmp_path / "model.yaml", wandered.model)
    model = load_model(tmp_path / "model.yaml")
    assert {part.placed.name for part in model.background} == {"base_wander", "link_wander"}
    left = predict(model, moved) - moved.positions
    assert np.sqrt(np.mean(left**2)) < 0.021e-3
    of_now = predict(model, replace(moved, time=None))
    np.testing.assert_allclose(of_now, predict(model, replace(moved, time=np.full(ROWS, moved.time[-1]))), atol=1e-12)
    assert np.abs(of_now - predict(model, moved)).max() > 0.02e-3
    assert transfer(model, table).applied == ()
