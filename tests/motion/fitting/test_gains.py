"""Columns are recorded by the gain that is fitted to them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.constants import NOISE
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.gains import gain_of, meeting_gain
from armscope.motion.fitting.rows import torque_of
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain, select_causes, weighed_anew
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.timing import stretches
from tests.motion.moving import ROBOT, moved, robot

STATED_GAIN, TRUE_GAINS = 10.0, np.array([9.0, 9.5, 8.0])
*INNER, LAST = ROBOT["links"]  # type: ignore[misc]
LIGHT = {**LAST, "mass_kg": 0.5, "inertia_kg_m2": [0.001, 0.004, 0.004, 0, 0, 0]}


@pytest.fixture(scope="module")
def start() -> SelectedCauses:
    """An arm by currents whose last link is ten times as heavy as stated: columns as if gains were those stated."""
    arm = robot(drives=[{"gain_nm_per_a": STATED_GAIN}] * 3, links=[*INNER, LIGHT])
    recorded = moved(robot(links=[*INNER, {**LIGHT, "mass_kg": 5.5}]), 6, runs=3)
    currents = replace(recorded, kind="current", effort=recorded.effort / TRUE_GAINS)
    train = [replace(each, effort=torque_of(arm, each.effort, "current")) for each in stretches(currents)]
    how, first = chosen_cutoff(arm, train, 10.0)
    layout = TorqueLayout(arm, tuple(place_causes(seen_in(arm, train, 0.02))), True)
    selected = select_causes(layout, train, how, currents.runs, lambda text, share: None, first.model)
    return weighed_anew(replace(selected.rows, gain=np.ones(3)), selected)


def fitted(selected: SelectedCauses) -> Array:
    return gain_of(selected.rows.layout, selected.coefficients)


def apart(selected: SelectedCauses) -> float:
    """By how much the fitted gain and that of the columns differ."""
    return float(np.max(np.abs(fitted(selected) - selected.rows.gain)))


def at(selected: SelectedCauses, gain: Array) -> SelectedCauses:
    return weighed_anew(replace(selected.rows, gain=gain), selected)


@pytest.mark.long
def test_the_fitted_gain_taken_as_it_is_swings_ever_farther(start: SelectedCauses) -> None:
    """Else the next test shows nothing."""
    assert apart(at(start, fitted(start))) > apart(start) > 1


def test_columns_and_fit_meet(start: SelectedCauses) -> None:
    selected = at_own_gain(start)
    assert apart(selected) < 10 * NOISE.same_gain
    assert selected.rows.gain / selected.rows.gain[0] == pytest.approx(TRUE_GAINS[0] / TRUE_GAINS, rel=0.01)


def test_a_step_from_nearby_leaves_a_hundredth_of_the_way(start: SelectedCauses) -> None:
    near = at(start, at_own_gain(start).rows.gain * [1.03, 0.98, 1.02])
    assert apart(at(near, meeting_gain(near))) < 0.01 * apart(near)
