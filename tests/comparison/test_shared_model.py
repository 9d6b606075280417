"""Recordings count by their own noise, and what their rows cannot show is not seen to change."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.comparison.sets import stacked
from armscope.comparison.shared_model import SharedModel
from tests.comparison.test_changes import ARM, session


@pytest.fixture(scope="module")
def problem():
    noisy = session(52, noise_mm=0.3)
    held = replace(noisy, motor_angles=noisy.motor_angles.copy())
    held.motor_angles[:, 4] = 0.3 + 1e-6 * np.sin(np.arange(len(held)))  # stands still, but for an encoder's last bit
    return SharedModel(ARM, *stacked(ARM, {"quiet": session(51), "noisy": held}))


def test_a_noisy_recording_counts_by_its_noise(problem):
    """0.03 and 0.3 mm, and what the held joint leaves unsaid: its rows count for a tenth or less."""
    quiet, noisy = (np.median(problem.weight[problem.group == k]) for k in (0, 1))
    assert noisy < 0.15 * quiet


def test_a_joint_that_stands_still_shows_no_change_of_its_ratio(problem):
    possible = problem.possible_changes([((1,), (0,))])
    scores = problem.scores(possible, ())
    for each, score in zip(possible, scores, strict=True):
        if each.placed.name == "gear_ratio":
            assert (score.statistic.q == 0) == (each.placed.location == "joint 5")
