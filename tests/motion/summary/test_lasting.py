"""Torque that lasts and has no law is told where it comes back with the motion, and noise that lasts is not."""

import dataclasses

import numpy as np
import pytest
from scipy.signal import lfilter

from armscope.core.types import Array
from armscope.motion.pipeline import MotionDiagnosis, MotionSettings, diagnose_motion
from armscope.motion.summary import lasting
from armscope.motion.summary.constants import LASTING
from tests.motion.moving import Plant, moved, robot

SIZE = 2.5


def diagnosed(plant: Plant, **how: float) -> MotionDiagnosis:
    arm = robot()
    return diagnose_motion(arm, moved(arm, 1, plant, **how, seconds=10.0), MotionSettings(cutoff=10.0))


def between_two(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """At joint 2, of the angles of two joints at once: no law of the library has it."""
    return np.asarray(SIZE * np.sin(2 * q[:, [0]]) * np.sin(2 * q[:, [1]]) * [0, 1, 0])


def wandering(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """At joint 2, as large and for about a second each way, whatever the motion: noise that lasts."""
    kept, rng = np.exp(-1 / 200), np.random.default_rng(int(1e6 * abs(q[0, 0])))
    noise = lfilter([np.sqrt(1 - kept**2)], [1, -kept], rng.normal(size=len(q)))
    return np.asarray(SIZE / 2 * noise[:, None] * [0, 1, 0])


@pytest.mark.long
def test_smooth_torque_without_a_law_is_told_with_its_place_and_what_it_follows() -> None:
    found = diagnosed(between_two, runs=3)
    verdict, left = found.verdict, found.verdict.unexplained
    assert verdict.answer == "cannot tell"
    assert verdict.mismatch
    assert (left.location, left.driver) == ("joint 2", "angles of joints 1 and 2")
    said = "omething lasts that has no law here: "
    assert said in verdict.headline
    assert not any(said in notice.text for notice in verdict.notices)  # once is enough
    assert "% of the torque of joint 2, following the angles of joints 1 and 2" in verdict.headline
    (told,) = lasting.lasting_torques(found.selected)
    planted = between_two(found.selected.rows.q, *3 * [np.empty(0)])[:, 1]
    assert 0.3 * np.std(planted) < told.rms < 1.1 * np.std(planted)


@pytest.mark.long
def test_noise_that_lasts_is_not_told() -> None:
    found = diagnosed(wandering)
    assert max(found.selected.weights.correlated) > 20  # it lasts
    assert found.verdict.answer == "nothing missing"


def test_what_is_foretold_of_any_slow_torque_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    selected = diagnosed(wandering).selected
    which = np.flatnonzero(selected.weights.row[:, 1] > 0)
    interleaved = dataclasses.replace(selected, block=np.arange(len(selected.rows)) % 2)
    over_time = lasting.hats(which.astype(np.float64), 5)
    monkeypatch.setattr(lasting, "_maps", lambda *_: iter([("time", over_time)]))
    told = 0
    for seed in range(20):
        waves = np.random.default_rng(seed).normal(size=(3, 2)) @ np.array([1, 1j])
        slow = np.fft.irfft([0, *waves], len(which)) * len(which)
        gain = lasting._gains(over_time, slow[:, None], interleaved.block[which], 1.0)[0]
        assert gain > LASTING.repeats
        told += lasting._foretold(interleaved, 1, which, slow, 1.0)[0] > 0
    assert told <= 5  # a tenth by chance
