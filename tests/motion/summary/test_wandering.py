"""Torque that is off for seconds at a time is told at its joint; noise, short or long, and clean arms are not."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable

import numpy as np
import pytest
from scipy.signal import lfilter

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary.wandering import DRIVER, slow_power, wandering_torques
from tests.motion.moving import Plant, moved, robot
from tests.seeds import seeds

RATE = 200.0
JOINT = 1


def beside(extra: Callable[[int, Array], Array]) -> Plant:
    """Something at one joint, of the number of the run and its speed (N,)."""
    count = itertools.count()

    def plant(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
        found = np.zeros_like(q)
        found[:, JOINT] = extra(next(count), dq[:, JOINT])
        return found

    return plant


def dragging(run: int, speed: Array) -> Array:
    """A brake that is on for some three seconds, now and then, in the second run."""
    at = np.arange(len(speed)) / RATE
    return np.where((at % 7 < 3) & (run == 1), 14.0 * np.tanh(speed / 0.01), 0.0)


def wandering(run: int, speed: Array) -> Array:
    return np.asarray(np.cumsum(np.random.default_rng(run).normal(0, 0.25, len(speed))))


def lasting_noise(run: int, speed: Array) -> Array:
    """Noise of a fiftieth of the joint's torque that lasts half a second."""
    keep = float(np.exp(-1 / (0.5 * RATE)))
    noise = np.random.default_rng(10 + run).normal(0, np.sqrt(1 - keep**2), len(speed))
    return np.asarray(0.6 * lfilter([1.0], [1.0, -keep], noise))


def diagnosed(extra: Callable[[int, Array], Array] | None, seed: int = 3) -> MotionDiagnosis:
    plant = None if extra is None else beside(extra)
    motions = moved(robot(), seed, plant, runs=3, seconds=14.0)
    return diagnose_motion(robot(), motions, MotionSettings(cutoff=10.0))


@pytest.mark.parametrize("extra", seeds(dragging, wandering))
def test_what_is_off_for_seconds_is_told_at_its_joint(extra: Callable[[int, Array], Array]) -> None:
    found = diagnosed(extra)
    (told,) = wandering_torques(found.selected)
    assert told.joint == JOINT
    assert re.fullmatch(rf"{DRIVER}, by up to [\d.]+ N m in run path \d", told.driver)
    assert extra is not dragging or told.driver.endswith("in run path 2")
    verdict = found.verdict
    assert verdict.unexplained.location == f"joint {JOINT + 1}"
    assert verdict.answer != "nothing missing"
    assert f"of the torque of joint {JOINT + 1}, following the" in verdict.headline


@pytest.mark.parametrize("extra", seeds(lasting_noise, None))
def test_noise_is_not(extra: Callable[[int, Array], Array] | None) -> None:
    found = diagnosed(extra)
    assert not wandering_torques(found.selected)
    assert DRIVER not in found.verdict.headline


def test_the_power_of_what_is_slow_is_what_was_drawn() -> None:
    rng = np.random.default_rng(4)
    spell = np.repeat(np.arange(300), 40)
    noise, slow = rng.normal(0, 2.0, len(spell)), rng.normal(0, 0.7, 300)[spell]
    assert slow_power(noise + slow, spell) == pytest.approx(np.mean(slow**2), rel=0.15)
    assert slow_power(noise, spell) < 0.02 * np.mean(noise**2)
