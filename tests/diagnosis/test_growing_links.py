"""A hall that gets warmer: all links of an arm grow, which is no cause; one that grows by itself is."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from armscope import compensate
from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.physics.model import predict
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics
from armscope.robot.arm import build_arm
from armscope.verdict.diagnosis import Diagnosis

from ..physics.scenes import arm_named
from .planted import one_run, recorded

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, NOISE_MM = 200, 0.02
PER_K = np.array([16e-6, 12e-6, 14e-6, 20e-6])
"""Of steel, of aluminium, and of what is bolted together of both."""


def grown(arm: Arm, table: Recordings, per_k: Array) -> Array:
    """(N, 3) m by which the tool moves as links of these coefficients grow from 20 C: D-H lengths made longer."""
    dh, rows = arm.description.dh, []
    for row, share in zip(dh.joints, per_k, strict=True):
        rows.append(row.model_copy(update={"a_mm": row.a_mm * (1 + share), "d_mm": row.d_mm * (1 + share)}))
    longer = build_arm(arm.description.model_copy(update={"dh": dh.model_copy(update={"joints": tuple(rows)})}))
    growth = forward_kinematics(longer, table.motor_angles) - forward_kinematics(arm, table.motor_angles)
    return growth * (table.temperature - 20.0)[:, None]


def session(per_k: Array, seed: int = 5) -> tuple[Arm, Recordings]:
    """An arm measured while the hall warmed up from 20 to 30 C; nobody wrote down when."""
    arm = arm_named("four-axis")
    warming = 20.0 + 10.0 * np.linspace(0.0, 1.0, ROWS) ** 0.7
    table = replace(one_run(arm, ROWS, seed), time=None, temperature=warming)
    table = recorded(arm, table, {}, NOISE_MM, seed + 1)
    return arm, replace(table, positions=table.positions + grown(arm, table, per_k))


@functools.cache
def warmed_up() -> tuple[Arm, Recordings, Diagnosis]:
    """An arm all of whose links grow, and what is said of it."""
    arm, table = session(PER_K)
    return arm, table, diagnose(arm, table, QUICK)


@pytest.mark.long
def test_links_that_grow_with_the_hall_are_no_cause_and_foretell_a_warmer_day() -> None:
    arm, _, verdict = warmed_up()
    assert verdict.effects == ()
    thermal = next(family for family in verdict.background_families if family.family == "thermal")
    assert thermal.present
    assert verdict.headline.startswith("All links grow with temperature")
    warmer = replace(one_run(arm, 100, seed=77), time=None, temperature=np.full(100, 34.0))
    measured = recorded(arm, replace(warmer, number=np.full(100, np.nan)), {}, 0.0, seed=6)
    truth = measured.positions + grown(arm, warmer, PER_K)
    cold = replace(warmer, temperature=np.full(100, 25.0))
    missed = predict(verdict.model, replace(warmer, number=np.full(100, np.nan))) - truth
    as_cold = predict(verdict.model, replace(cold, number=np.full(100, np.nan))) - truth
    assert np.sqrt(np.mean(missed**2)) < 0.5 * np.sqrt(np.mean(as_cold**2))


@pytest.mark.long
def test_commands_for_the_temperature_of_the_day_take_the_growth_out() -> None:
    """The family's cure, as worded, by an arm whose growth is computed by hand."""
    arm, table, verdict = warmed_up()
    poses = replace(one_run(arm, 40, seed=91), temperature=np.full(40, 29.0))
    path = pd.DataFrame(poses.motor_angles, columns=[f"q{j}_rad" for j in range(1, 5)])
    path = path.assign(temperature_c=poses.temperature, payload_kg=poses.payload)
    wanted = forward_kinematics(arm, poses.motor_angles)

    def missed_mm(commands: Array) -> float:
        reached = forward_kinematics(arm, commands) + grown(arm, replace(poses, motor_angles=commands), PER_K)
        return float(1e3 * np.sqrt(np.nanmean((reached - wanted) ** 2)))

    found = compensate(verdict.model, path, table)
    assert np.isfinite(found.commands).all(axis=1).mean() > 0.9
    assert missed_mm(poses.motor_angles) > 0.1
    assert missed_mm(found.commands) < 0.01


@pytest.mark.long
def test_one_link_that_grows_by_itself_has_its_name() -> None:
    arm, table = session(np.array([0, 40e-6, 0, 0.0]))
    verdict = diagnose(arm, table, QUICK)
    assert [(effect.effect, effect.location) for effect in verdict.effects] == [("thermal_expansion", "link 2")]
    [coefficient] = verdict.effects[0].parameters
    assert coefficient.value == pytest.approx(40e-6, abs=2.5 * coefficient.stderr)


@pytest.mark.long
def test_a_hall_that_stays_as_it_is_makes_nothing_grow() -> None:
    arm, table = session(np.zeros(4))
    verdict = diagnose(arm, table, QUICK)
    assert verdict.effects == ()
    assert not verdict.mismatch
