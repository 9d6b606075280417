"""Friction that changes while the arm runs, with no temperature recorded: told as that, no curve of the speed."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import savgol_filter

from armscope.core.types import Array
from armscope.motion.export import write_motion
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.predicting import predict_motions
from armscope.recordings.motions import as_motions
from armscope.verdict.effects import INTERVAL
from tests.motion.moving import VISCOUS, Plant, robot, table

SECONDS, PER_MINUTE = 10.0, -1.5
SETTINGS = MotionSettings(cutoff=10.0)


def warming(joint: int, slower: float = 1.0) -> Plant:
    """Viscous friction of a joint (from 0) that falls from one run to the next, which each go on where one ended."""
    ran = [0.0]

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        minutes = (ran[0] + np.arange(len(q)) / 200.0) / 60
        ran[0] += SECONDS
        on_top = np.zeros_like(q)
        on_top[:, joint] = slower * PER_MINUTE * minutes * dq[:, joint]
        return on_top

    return plant


@pytest.mark.parametrize("stated", [pytest.param(False, marks=pytest.mark.long), True])
def test_friction_that_falls_while_the_arm_runs_is_told_with_its_slope(stated: bool, tmp_path: Path) -> None:
    """What robot.yaml states of it, it has in the middle of the recording or not: that is a number of its own."""
    drives = {"drives": [{"viscous_nm_s_rad": float(each)} for each in VISCOUS]} if stated else {}
    rows = table(robot(), 3, warming(1), runs=2, seconds=SECONDS)
    found = diagnose_motion(robot(**drives), as_motions(rows), SETTINGS)
    (effect,) = found.verdict.effects
    assert (effect.effect, effect.location, effect.driver) == ("thermal_friction", "joint 2", "running time")
    slope = effect.parameters[0]
    assert slope.name == "per_minute"
    assert slope.value == pytest.approx(PER_MINUTE, abs=1.5 * INTERVAL * slope.stderr)
    assert slope.stderr < 0.1 * abs(PER_MINUTE)
    write_motion(found, tmp_path)
    rows.drop(columns=[name for name in rows if name.startswith("tau")]).to_csv(tmp_path / "other.csv", index=False)
    _, notes = predict_motions(tmp_path / "model.yaml", tmp_path / "other.csv")
    assert any("as at the end of the model's own motion: thermal friction at joint 2" in note for note in notes)


@pytest.mark.long
def test_who_takes_off_what_the_card_says_has_the_friction_that_was_stated() -> None:
    """Minutes counted over the runs of the table, one after the other."""
    arm = robot(drives=[{"viscous_nm_s_rad": float(each)} for each in VISCOUS])
    rows = table(robot(), 3, warming(1), runs=2, seconds=SECONDS)
    (effect,) = diagnose_motion(arm, as_motions(rows), SETTINGS).verdict.effects
    assert "Minutes are counted over the runs as they stand in the table" in effect.cure
    told = re.search(r"stated and (\S+) ± .* × \(minutes of running − (\S+)\) (\S+) ± .*, times the speed", effect.cure)
    assert told is not None
    slope, middle, constant = (float(each.replace("−", "-")) for each in told.groups())
    ran = rows["time_s"] + SECONDS * (rows["run"] == "path 2")
    speed = rows.groupby("run")["q2_rad"].transform(lambda q: savgol_filter(q, 21, 3, deriv=1, delta=1 / 200.0))
    rows["tau2_nm"] -= (slope * (ran / 60 - middle) + constant) * speed
    assert diagnose_motion(arm, as_motions(rows), SETTINGS).verdict.effects == ()


def in_steps(*more: float) -> Plant:
    """Viscous friction of joint 2 that differs from run to run, and not within one."""
    left = iter(more)

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        return next(left) * dq * [0, 1, 0]

    return plant


@pytest.mark.long
@pytest.mark.parametrize("steps", [(0, -0.6), (0, -0.6, 0), (0, -0.6, -0.2, -0.7)])
def test_friction_that_differs_from_run_to_run_does_not_surely_change_with_time(steps: tuple[float, ...]) -> None:
    """And what runs before and after say of a third makes its torque no less known than friction alone does."""
    rows = table(robot(), 3, in_steps(*steps), runs=len(steps), seconds=SECONDS)
    verdict = diagnose_motion(robot(), as_motions(rows), SETTINGS).verdict
    assert all(effect.doubt for effect in verdict.effects)
    assert verdict.held_out.model < 1.15 * verdict.held_out.background


def test_one_run_alone_does_not_tell_time_from_where_it_went() -> None:
    """Told by the first three fifths of a motion, it went on as it had: 2 % of the rest was missed, not 0.4 %."""
    found = diagnose_motion(robot(), as_motions(table(robot(), 3, warming(1), runs=1, seconds=SECONDS)), SETTINGS)
    assert "running time" not in {cause.driver for cause in found.selected.rows.layout.placed}


def test_friction_that_stays_says_nothing() -> None:
    found = diagnose_motion(robot(), as_motions(table(robot(), 4, seconds=SECONDS)), SETTINGS)
    assert found.verdict.effects == ()
