"""Scanned numbers that rest where the fit puts them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.refining import falling_over, refined
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import select_causes
from armscope.motion.fitting.torque_delay import Between
from armscope.motion.library import catalogue
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.timing import stretches
from tests.motion.moving import moved, robot

SPEED, EXTRA = 0.17, 6.0
"""rad/s, N m of friction near rest at joint 2; the scan has other speeds."""


def near_rest(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    """Friction that falls with the speed."""
    extra = np.zeros_like(q)
    extra[:, 1] = EXTRA * np.exp(-((dq[:, 1] / SPEED) ** 2)) * np.sign(dq[:, 1])
    return extra


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    arm = robot()
    train = list(stretches(moved(arm, 8, near_rest)))
    how, first = chosen_cutoff(arm, train, 15.0)
    layout = TorqueLayout(arm, tuple(place_causes(seen_in(arm, train, 0.02))), False)
    return select_causes(layout, train, how, ("path 1", "path 2"), lambda text, share: None, first.model)


def test_the_speed_of_a_stribeck_friction_rests_at_the_true_one(selected: SelectedCauses) -> None:
    placed = [selected.rows.layout.placed[number] for number in selected.best.candidates]
    (stribeck,) = [each for each in placed if each.cause is catalogue.STRIBECK]
    assert stribeck.location == "joint 2"
    assert stribeck.scanned[0][2] == pytest.approx(SPEED, rel=0.1)


def test_what_rests_is_refined_no_further(selected: SelectedCauses) -> None:
    assert refined(selected, Between()) is None


@given(now=st.floats(0.01, 5), step=st.floats(-50, 50), fastest=st.floats(0.05, 5))
def test_a_speed_that_no_motion_shows_is_never_run_into(now: float, step: float, fastest: float) -> None:
    better = falling_over(now, step, fastest)
    assert better <= max(fastest / 2, now)
    assert (better < now) == (step < 0 and now * np.exp(step) < now)
    assert falling_over(now, 0.0, fastest) == now


def test_a_speed_well_within_the_motion_takes_its_whole_step() -> None:
    assert falling_over(0.1, 0.2, 2.0) == pytest.approx(0.1 * np.exp(0.2))
