"""Friction that differs from run to run without a recorded reason is told; friction that is the same is not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.by_run import friction_by_run
from tests.motion.moving import COULOMB, VISCOUS, Plant, moved, robot

JOINT = 1


def warming(shares: Iterator[float], dry: bool = False) -> Plant:
    """Friction of joint 2 that is more by another share in each run."""

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        extra = np.zeros_like(q)
        own = COULOMB[JOINT] * np.sign(dq[:, JOINT]) if dry else VISCOUS[JOINT] * dq[:, JOINT]
        extra[:, JOINT] = next(shares) * own
        return extra

    return plant


def diagnosed(plant: Plant | None, temperature: bool = False) -> MotionDiagnosis:
    motions = moved(robot(), 3, plant, runs=3, seconds=15.0)
    if temperature:
        run = np.unique(motions.run, return_inverse=True)[1].astype(float)
        motions = replace(motions, temperature=np.tile(20.0 + 10.0 * run[:, None], motions.n_motors))
    return diagnose_motion(robot(), motions, MotionSettings(cutoff=10.0))


@pytest.mark.long
@pytest.mark.parametrize(("dry", "follows"), [(False, "speed"), (True, "direction")])
def test_friction_that_differs_by_run_is_told_at_its_joint(dry: bool, follows: str) -> None:
    verdict = diagnosed(warming(iter([0.6, 0.0, -0.6]), dry)).verdict
    assert verdict.answer == "cannot tell"
    assert verdict.unexplained.location == "joint 2"
    assert verdict.unexplained.driver is not None
    assert verdict.unexplained.driver.startswith(f"{follows}, otherwise in each run")
    assert f"following the {follows}, otherwise" in verdict.unexplained.description
    said = r"run: friction is (\d+) % (?:higher in run path 1|lower in run path 3) than in the middle one"
    (by,) = re.findall(said, verdict.unexplained.driver)
    assert 40 < float(by) < 80


@pytest.mark.long
def test_friction_that_is_the_same_in_all_runs_is_not() -> None:
    found = diagnosed(None)
    assert not friction_by_run(found.selected)
    assert found.verdict.answer == "nothing missing"


def less_near_rest(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction of joint 2, the same in all runs."""
    extra = np.zeros_like(q)
    extra[:, JOINT] = -0.6 * COULOMB[JOINT] * np.exp(-((dq[:, JOINT] / 0.1) ** 2)) * np.sign(dq[:, JOINT])
    return extra


def test_a_law_that_takes_part_of_dry_friction_in_each_run_otherwise_is_the_same_friction() -> None:
    """Dry friction alone was two thirds more in one run: the law beside it had as much less."""
    assert not friction_by_run(diagnosed(less_near_rest).selected)


@pytest.mark.long
def test_friction_that_follows_the_recorded_temperature_has_its_name() -> None:
    found = diagnosed(warming(iter([0.6, 0.0, -0.6])), temperature=True)
    assert [(each.effect, each.location) for each in found.verdict.effects] == [("thermal_friction", "joint 2")]
    assert not friction_by_run(found.selected)
