"""The count of slow waves is found where the first look missed it, beside what the joint reads too much."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.motion.fitting.cutoff import chosen_cutoff
from armscope.motion.fitting.left_at_joint import LeftAtJoint
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import select_causes
from armscope.motion.fitting.wave_counts import followed_by_a_curve, nats_of_waves, recounted
from armscope.motion.library import catalogue
from armscope.motion.library.layout import TorqueLayout
from armscope.motion.library.placing import place_causes
from armscope.motion.library.recorded_ranges import seen_in
from armscope.motion.samples.timing import stretches
from tests.motion.moving import moved, robot

TRUE, MISSED_FOR = 5, (8, 11)
"""Waves per turn of joint 2, and those that a first look takes them for."""


def slow_waves(q: Array, dq: Array, ddq: Array, rigid: Array) -> Array:
    extra = np.zeros_like(q)
    extra[:, 1] = 2.0 * np.sin(TRUE * q[:, 1] + 0.3) + 2.0
    return extra


@pytest.fixture(scope="module")
def selected() -> SelectedCauses:
    arm = robot()
    train = list(stretches(moved(arm, 8, slow_waves)))
    how, first = chosen_cutoff(arm, train, 15.0)
    seen = replace(seen_in(arm, train, 0.02), waves={1: (MISSED_FOR, 50)})
    layout = TorqueLayout(arm, tuple(place_causes(seen)), False)
    return select_causes(layout, train, how, ("path 1", "path 2"), lambda text, share: None, first.model)


def test_waves_and_an_offset_are_told_and_no_cable(selected: SelectedCauses) -> None:
    placed = [selected.rows.layout.placed[number] for number in selected.best.candidates]
    assert sorted(each.cause.name for each in placed) == ["torque_offset", "torque_ripple"]
    (ripple,) = [each for each in placed if each.cause is catalogue.RIPPLE]
    assert (ripple.location, ripple.variant) == ("joint 2", str(TRUE))
    assert ripple.scanned == (("per_turn", "", float(TRUE)),)


def test_the_true_count_suits_best(selected: SelectedCauses) -> None:
    left = LeftAtJoint(selected, 1, selected.best.candidates)
    counts = followed_by_a_curve(left.angle)
    assert TRUE in counts
    assert counts[np.argmax(nats_of_waves(left, counts))] == TRUE


def test_where_no_curve_stands_for_waves_none_are_looked_for(selected: SelectedCauses) -> None:
    assert recounted(selected) == {}
