"""Drives that are softer under small loads: allowed for in every arm, told as no play; play that is there is named."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from armscope.diagnosis import Settings, diagnose
from armscope.physics.backgrounds import ELASTIC
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm, chain
from armscope.robot.kinematics import joint_jacobian
from armscope.verdict.contributions import contributions
from armscope.verdict.schema import Verdict
from armscope.verdict.work_order import work_order
from tests.seeds import arms_and_seeds, seeds

from .planted import planted

QUICK = Settings(resamples=0, cross_validation=False)
NOISE_MM = 0.01
PLAY = {("backlash", "joint 2"): [4e-4]}
SHOULDER_ON = {"four-axis-modified": range(2, 5), "seven-axis": range(2, 7)}
"""Joints that bear a load."""


def names(verdict: Verdict) -> set[tuple[str, str]]:
    return {(effect.effect, effect.location) for effect in verdict.effects}


def wound(
    name: str, turns: Mapping[int, float], seed: int, wanted: Mapping[tuple[str, str], list[float]] | None = None
) -> tuple[Arm, Recordings]:
    """An arm whose motors (from 1) turn further by so much, rad, most of it in the first tenth or so of the load."""
    arm, table = planted(name, wanted or {}, 250, NOISE_MM, seed)
    rng, torques = np.random.default_rng(seed), Scene(arm, table).torques
    jacobian = joint_jacobian(chain(arm, table.motor_angles))
    moved = np.zeros_like(table.positions)
    for j, turn in turns.items():
        knee = rng.uniform(0.07, 0.15) * np.abs(torques[:, j - 1]).max()
        moved += jacobian[:, :, j - 1] * (turn * np.tanh(torques[:, [j - 1]] / knee))
    return arm, replace(table, positions=table.positions + moved)


@pytest.mark.long
@pytest.mark.parametrize(("arm", "seed"), arms_and_seeds("four-axis-modified", "seven-axis", 1, 2, 3))
def test_drives_that_harden_are_not_told_as_play(arm: str, seed: int) -> None:
    """Most of it at the tool is the shoulder's, which may be named: as what gives way."""
    verdict = diagnose(*wound(arm, dict.fromkeys(SHOULDER_ON[arm], 4e-5), seed), QUICK)
    assert names(verdict) <= {("joint_compliance", f"joint {j}") for j in SHOULDER_ON[arm]}
    (springs,) = [family for family in verdict.background_families if family.family == ELASTIC]
    assert springs.present
    assert verdict.residual_after_mm < 1.1 * NOISE_MM


@pytest.mark.long
@pytest.mark.parametrize(("arm", "seed"), arms_and_seeds("four-axis-modified", "seven-axis", 1, 2, 3))
@pytest.mark.parametrize("turn", [pytest.param(0.0, marks=pytest.mark.long), 4e-5])
def test_play_is_named_beside_drives_that_harden(turn: float, arm: str, seed: int) -> None:
    verdict = diagnose(*wound(arm, dict.fromkeys(SHOULDER_ON[arm][1:], turn), seed, PLAY), QUICK)
    assert names(verdict) == {("backlash", "joint 2")}
    (gap,) = verdict.effects[0].parameters
    assert abs(gap.value - 4e-4) < 3 * gap.stderr


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_one_drive_that_is_far_softer_under_small_loads_is_told_by_its_joint(seed: int) -> None:
    verdict = diagnose(*wound("seven-axis", {4: 2e-4}, seed), QUICK)
    assert {location for _, location in names(verdict)} == {"joint 4"}
    largest = verdict.effects[0]
    assert largest.effect == "joint_compliance"
    (turn,) = largest.parameters
    assert turn.name == "soft_turn"
    assert abs(turn.value - 2e-4) < 0.15 * 2e-4  # its knee is as it comes
    assert "under small loads" in verdict.headline
    assert "soft_turn x tanh(10 x load" in largest.cure
    tasks = [task for task in work_order(verdict, contributions(verdict)).tasks if task.place == "joint 4"]
    (load,) = re.findall(r"tanh\(10 x load / (\S+) N m\)", largest.cure)
    assert sum(f"rad × tanh(10 × load / {load} N m))" in task.instruction for task in tasks) == 1
    (rule,) = (task.cure for task in tasks if "soft_turn" in task.cure)
    assert f"tanh(10 x load / {load} N m)" in rule
    assert "Here soft_turn = +0.01" in rule, "degrees and mrad of 0.2 mrad"
    assert "do not determine" not in rule


@pytest.mark.long
@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_a_drive_that_gives_way_and_hardens_has_one_name(seed: int) -> None:
    """Its soft start is in the background then, and its compliance is as if there were none."""
    gives = {("joint_compliance", "joint 4"): [5e-6]}
    verdict = diagnose(*wound("seven-axis", {4: 2e-4}, seed, gives), QUICK)
    assert [(e.effect, e.location) for e in verdict.effects].count(("joint_compliance", "joint 4")) == 1
    (compliance,) = next(e for e in verdict.effects if e.effect == "joint_compliance").parameters
    assert compliance.name == "compliance"
    assert abs(compliance.value - 5e-6) < 3 * compliance.stderr
