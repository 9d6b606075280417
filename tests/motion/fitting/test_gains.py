"""Columns are recorded by the gain that is fitted to them."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.inference.evidence import Hypothesis
from armscope.inference.search import Search
from armscope.motion.constants import NOISE
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.gains import gain_of, meeting_gain, torque_of
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import at_own_gain, select_causes, weighed_anew
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.pipeline import MotionSettings, diagnose_motion
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


def test_torques_that_are_all_read_a_little_wrong_are_no_masses() -> None:
    """Shares of the links' masses stood for that, so wide that beside them no single link had a name."""
    recorded = moved(robot(), 6, runs=3)
    off = np.array([0.03, -0.03, 0.03])
    wrong = replace(recorded, effort=recorded.effort * (1 + off))
    selected = diagnose_motion(robot(), wrong, MotionSettings(cutoff=10.0)).selected
    families = [family.name for family in selected.space.families]
    masses, weights, gains = (families.index(name) for name in ("masses", "link masses", "gains"))
    search = Search.on(selected.problem)

    def best_without(*held: int) -> Hypothesis:
        """No name, and the sizes of the backgrounds that suit best, none of some of them."""
        sizes = [range(1 if n in held else family.sizes) for n, family in enumerate(selected.space.families)]
        tried = (search.evaluated((), selected.best, background) for background in itertools.product(*sizes))
        return max(tried, key=lambda each: each.log_posterior)

    by_gains, by_masses = best_without(masses, weights), best_without(gains)
    assert by_gains.log_posterior > by_masses.log_posterior + 50
    layout = selected.rows.layout
    fitted = by_gains.means(layout.gains) / selected.problem.scale[layout.gains]
    assert fitted == pytest.approx(off, abs=0.01)
