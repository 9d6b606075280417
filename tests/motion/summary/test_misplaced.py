"""Masses that are off without a name go where they leave more at a joint than masses as stated do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.search import Search
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import chosen
from armscope.motion.fitting.space import OF_MASSES
from armscope.motion.pipeline import MotionSettings, diagnose_motion
from armscope.motion.summary.misplaced import without_misplaced_masses
from tests.motion.moving import moved, robot

UNHEARD = 30.0
"""Times its noise that joint 2 is taken to have: it counts for nothing."""


def read_across(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """The reading of joint 3 takes some of joint 2's torque."""
    return np.asarray(0.2 * rigid[:, [1]] * [0, 0, 1])


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    """By which masses say what joint 3 reads, and joint 2, which they leave badly met, counts for nothing."""
    found = diagnose_motion(robot(), moved(robot(), 1, read_across), MotionSettings(cutoff=10.0)).selected
    weights = replace(found.weights, sigma=found.weights.sigma * [1, UNHEARD, 1])
    unheard = chosen(found.rows, weights, found.block, found.space, (found.best, ()), found)
    sizes = [int(family.name == "masses") * (family.sizes - 1) for family in found.space.families]
    return replace(unheard, best=Search.on(unheard.problem).evaluated((), unheard.best, tuple(sizes)))


def test_masses_that_leave_more_at_a_joint_go_and_it_counts_again(selected: SelectedCauses) -> None:
    found = without_misplaced_masses(selected)
    assert found.best.chosen == selected.best.chosen
    families = [family.name for family in found.space.families]
    assert not any(found.best.background[families.index(name)] for name in OF_MASSES & set(families))
    assert found.weights.sigma[1] < 0.5 * selected.weights.sigma[1]
    assert np.std(found.residuals[:, 1]) < np.std(selected.residuals[:, 1])


def test_masses_that_leave_less_everywhere_stay() -> None:
    of_links = moved(robot(), 1, lambda q, dq, ddq, rigid: 0.1 * rigid)
    found = diagnose_motion(robot(), of_links, MotionSettings(cutoff=10.0)).selected
    sizes = [int(family.name == "masses") * (family.sizes - 1) for family in found.space.families]
    off = replace(found, best=Search.on(found.problem).evaluated((), found.best, tuple(sizes)))
    assert without_misplaced_masses(off) is off


def test_masses_as_stated_are_left_alone() -> None:
    found = diagnose_motion(robot(), moved(robot(), 1), MotionSettings(cutoff=10.0)).selected
    assert without_misplaced_masses(found) is found
