"""Fast ripple, as of strain-wave gears, is among the waves that are tried, however few are formed at a time."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.constants import LIBRARY
from armscope.motion.fitting import first_look as room
from armscope.motion.fitting.first_look import counts_shown, first_look
from armscope.motion.samples.preparation import preparation
from armscope.motion.samples.timing import Stretch, stretches
from tests.motion.moving import moved, robot

HOW = preparation(200.0, 30.0, "test")


def rippled(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Two waves per turn of a motor behind a gear of 80 to 1."""
    return np.column_stack([np.zeros(len(q)), 2 * np.cos(160 * q[:, 1] - 1), np.zeros(len(q))])


@pytest.fixture(scope="module")
def longest() -> Stretch:
    return next(stretches(moved(robot(), 3, rippled)))


@pytest.mark.long
def test_waves_of_a_strain_wave_gear_are_seen(longest: Stretch, monkeypatch: pytest.MonkeyPatch) -> None:
    counts, tried = first_look(robot(), longest, HOW).waves[1]
    assert 160 in counts
    assert tried > 200
    assert first_look(robot(), longest, HOW).waves[0][1] <= LIBRARY.few_waves  # nothing stands out among many there
    monkeypatch.setattr(room, "LIBRARY", dataclasses.replace(LIBRARY, waves_at_once=7))
    assert first_look(robot(), longest, HOW).waves[1] == (counts, tried)


def test_what_the_low_pass_takes_off_is_not_looked_for(longest: Stretch) -> None:
    both = [counts_shown(longest, preparation(200.0, cutoff, "test"), 1) for cutoff in (5.0, 20.0, 80.0)]
    most = [many[-1] for _, many in both]
    assert most[0] < most[1] <= most[2] == LIBRARY.most_waves
    assert all(few[-1] + 1 == many[0] for few, many in both)
    standing = dataclasses.replace(longest, q=np.zeros_like(longest.q))
    assert not any(len(counts) for counts in counts_shown(standing, HOW, 1))
