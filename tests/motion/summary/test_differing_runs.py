"""Torque that reads otherwise in some runs is told at its joint, with the run and by how much; else nothing is."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.differing_runs import _Runs, differing_runs
from tests.motion.moving import Plant, moved, robot

Reading = Callable[[int, Array, Array], Array]
"""(number of the run, share of its time (N,), torque (N,)) -> what is read beyond the torque (N,)."""


def in_runs(joint: int, reading: Reading) -> Plant:
    count = itertools.count()

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        extra = np.zeros_like(q)
        extra[:, joint] = reading(next(count), np.linspace(0, 1, len(q)), rigid[:, joint])
        return extra

    return plant


def diagnosed(joint: int, reading: Reading, runs: int = 3) -> MotionDiagnosis:
    return diagnose_motion(robot(), moved(robot(), 3, in_runs(joint, reading), runs=runs), MotionSettings(cutoff=10.0))


ZERO, GAIN = "a zero set anew", "another drive gain or other friction"
CASES: dict[str, tuple[int, Reading, list[str]]] = {
    "zero": (
        2,
        lambda run, at, torque: np.full_like(at, (0.0, 4.0, -3.0)[run]),
        ["4.0 N m higher in run path 2", "3.0 N m lower in run path 3", f"(as by {ZERO})"],
    ),
    "gain": (
        0,
        lambda run, at, torque: (0.0, 0.5, -0.4)[run] * torque,
        ["% larger in run path 2", GAIN],
    ),
    "gain of a torque of one sign": (
        1,
        lambda run, at, torque: (0.0, 0.1, -0.08)[run] * torque,
        ["in run path 2", "in run path 3", f"(as by {ZERO}, {GAIN})"],
    ),
    "jump": (2, lambda run, at, torque: 4.0 * ((run == 1) & (at > 0.5)), ["time in run path 2"]),
}


AGAIN = "gain of a torque of one sign"
"""What may be either of two that are asked for."""


@pytest.mark.long
@pytest.mark.parametrize("kind", [pytest.param(kind, marks=[pytest.mark.long] * (kind == AGAIN)) for kind in CASES])
def test_what_differs_in_some_runs_is_told_at_its_joint(kind: str) -> None:
    """It counted as noise that lasts, and nothing was missing: 8 of 8 simulated arms."""
    joint, reading, words = CASES[kind]
    found = diagnosed(joint, reading)
    (told,) = differing_runs(found.selected)
    assert told.joint == joint
    assert [each for each in words if each not in told.driver] == []
    assert found.verdict.answer == "cannot tell"
    assert found.verdict.unexplained.location == f"joint {joint + 1}"
    assert found.verdict.headline.startswith("Something lasts that has no law here")


@pytest.mark.long
def test_what_is_the_same_in_all_runs_differs_in_none() -> None:
    found = diagnosed(1, lambda run, at, torque: 0.1 * torque)
    assert not differing_runs(found.selected)
    named = [(each.effect, each.location) for each in found.verdict.effects if not each.minor]
    assert named == [("motor_constant", "joint 2")]


@pytest.mark.long
def test_of_a_single_run_nothing_differs() -> None:
    assert not differing_runs(diagnosed(2, lambda run, at, torque: 4.0 * (at > 0.5), runs=1).selected)


def lasting_noise(rng: np.random.Generator, rows: int, lasts: float) -> Array:
    """Of size one, forgotten over so many rows."""
    kept, found = np.exp(-1 / lasts), np.zeros(rows)
    for row in range(1, rows):
        found[row] = kept * found[row - 1] + np.sqrt(1 - kept**2) * rng.normal()
    return found


@pytest.mark.parametrize(("lasts", "most"), [(4.0, 0), (20.0, 10)])
def test_noise_that_lasts_is_no_drift_of_a_run(lasts: float, most: int) -> None:
    """Of 40 joints with noise that lasts 20 of a run's 200 rows, 19 were told to drift."""
    told = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        left = np.concatenate([lasting_noise(rng, 200, lasts) for _ in range(3)])
        runs = _Runs(
            left, 20 * rng.normal(size=600), np.repeat(["a", "b", "c"], 200), np.tile(np.arange(200.0), 3), "N m"
        )
        told += bool(runs.told())
    assert told <= most
