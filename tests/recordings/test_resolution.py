"""Steps in which angles stand are seen in degrees and radians, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.recordings.constants import READING
from armscope.recordings.resolution import angle_steps, step_in_words

ANGLES = np.random.default_rng(1).uniform(-3, 3, (80, 2))


@given(decimals=st.integers(0, 4), unit=st.sampled_from(["deg", "rad"]), seed=st.integers(0, 2**32 - 1))
def test_the_step_to_which_angles_were_rounded_is_found(decimals: int, unit: str, seed: int) -> None:
    angles = np.random.default_rng(seed).uniform(-300, 300, (80, 3))
    rounded = np.round(angles, decimals)
    steps = angle_steps(np.radians(rounded) if unit == "deg" else rounded)
    step = 10.0**-decimals
    assert steps == pytest.approx(np.full(3, np.radians(step) if unit == "deg" else step), rel=1e-12)


def test_every_motor_has_its_own_step_and_unrounded_angles_have_none() -> None:
    angles = ANGLES.copy()
    angles[:, 1] = np.round(angles[:, 1], 2)
    assert angle_steps(angles) == pytest.approx([0, 0.01])


def test_one_odd_row_shows_that_nothing_was_rounded() -> None:
    angles = np.round(ANGLES, 2)
    angles[7, 0] += 2e-5
    assert angle_steps(angles)[0] < 1e-4


def test_a_joint_that_hardly_moves_tells_nothing() -> None:
    few = np.resize(np.arange(READING.fewest_values - 1) * 0.1, (80, 1))
    assert angle_steps(few)[0] == 0


@pytest.mark.parametrize("words", ["1 degrees", "0.001 degrees", "0.1 rad", "0.01 rad", "0.0001 rad"])
def test_a_step_is_told_in_the_unit_that_it_was_written_in(words: str) -> None:
    number, unit = words.split()
    assert step_in_words(float(number) * (np.pi / 180 if unit == "degrees" else 1.0)) == words
