"""A load that one run carries and the table does not tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.effect import Part
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.model import Base, FittedModel, predict
from armscope.physics.payload_change import payload_changes
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

from .scenes import arm_named, full_table

QUICK = Settings(resamples=0, cross_validation=False)
RUNS, SOFT, CARRIED_KG = ("1", "2", "3"), 2e-6, 6.0


def of_three_runs(arm: Arm, rows: int) -> Recordings:
    table = replace(full_table(arm, rows, seed=3), run=np.repeat(RUNS, rows // 3), payload=None, time=None)
    return replace(table, temperature=None, approach=None, torque=None)


def drive(arm: Arm, table: Recordings) -> Part:
    soft = next(p for p in JOINT_COMPLIANCE.place(arm, table) if p.location == "joint 2" and not p.variant)
    return Part(soft, np.array([SOFT]))


def with_load(table: Recordings, runs: tuple[str, ...]) -> Recordings:
    return replace(table, payload=np.where(np.isin(table.run, runs), CARRIED_KG, 0.0))


@pytest.mark.parametrize(("told", "runs"), [("in run 2 alone", ("2",)), ("from run 2 on", ("2", "3"))])
def test_a_load_in_some_runs_moves_the_arm_as_that_payload_does(told: str, runs: tuple[str, ...]) -> None:
    arm = arm_named("six-axis")
    table = of_three_runs(arm, 30)
    part = drive(arm, table)
    (change,) = (placed for placed in payload_changes(table, [part]) if placed.variant == told)
    found = Scene(arm, table).posture([part, Part(change, np.array([CARRIED_KG]))]).tool
    true = Scene(arm, with_load(table, runs)).posture([part]).tool
    moved = np.abs(true - Scene(arm, table).posture([part]).tool)
    assert moved[np.isin(table.run, runs)].max() > 1e-4
    np.testing.assert_allclose(found, true, rtol=0, atol=1e-2 * moved.max())


def test_runs_of_one_load_and_arms_that_do_not_give_way_show_none() -> None:
    arm = arm_named("six-axis")
    table = of_three_runs(arm, 30)
    assert [p.variant for p in payload_changes(table, [drive(arm, table)])] == [
        "in run 2 alone", "from run 2 on", "in run 3 alone",
    ]  # fmt: skip
    assert not list(payload_changes(table, []))
    assert not list(payload_changes(replace(table, run=np.full(30, "1")), [drive(arm, table)]))


def test_a_load_that_nobody_recorded_is_no_zero_that_slipped() -> None:
    arm = arm_named("six-axis")
    table = of_three_runs(arm, 120)
    bases = dict.fromkeys(RUNS, Base(np.eye(3), np.zeros(3)))
    truth = FittedModel(arm, bases, (), (drive(arm, table),))
    points = predict(truth, with_load(table, ("3",)))
    noise = 3e-5 * np.random.default_rng(1).normal(size=points.shape)
    table = replace(table, positions=points + noise)
    told = diagnose(arm, table, QUICK)
    assert {e.effect for e in told.effects} == {"joint_compliance", "payload_change"}
    (change,) = [effect for effect in told.effects if effect.effect == "payload_change"]
    (mass,) = change.parameters
    assert abs(mass.value - CARRIED_KG) < 3 * mass.stderr
    assert "in run 3 alone" in told.headline
    stated = np.where(table.run == "3", mass.value, 0.0)
    again = diagnose(arm, replace(table, payload=stated), QUICK)
    assert [effect.effect for effect in again.effects] == ["joint_compliance"], "as the cure says"
