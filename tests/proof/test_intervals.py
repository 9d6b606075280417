"""Fitted numbers beside true ones: what is the same motion counts as the same number."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armscope.proof.intervals import compare_numbers
from tests.proof.cases import claim, concealed

angles = st.floats(-np.pi, np.pi)


def wobble(phase, direction, amplitude=1e-4):
    return concealed(
        "axis_wobble",
        "joint 3",
        parameters={
            "amplitude": (amplitude, "rad"),
            "phase": (phase, "rad"),
            "direction": (direction, "rad"),
            "per_turn": (1.0, "1/turn"),
        },
    )


def fitted(phase, direction, per_turn=1.0, amplitude=1e-4):
    values = {
        "amplitude": (amplitude, 1e-6),
        "phase": (phase, 0.01),
        "direction": (direction, 0.01),
        "per_turn": (per_turn, 0.0),
    }
    return claim("axis_wobble", "joint 3", parameters={n: (v, e, "") for n, (v, e) in values.items()})


def tilt(amplitude, phase, direction, angle):
    return amplitude * np.cos(angle - phase) * np.array([np.cos(direction), np.sin(direction)])


@given(angles, angles, st.integers(-2, 2), st.integers(-2, 2), st.booleans())
def test_whatever_makes_the_same_wobble_is_covered(phase, direction, turns, halves, flipped):
    amplitude, true_phase = (-1e-4, phase + np.pi) if flipped else (1e-4, phase)
    other_phase, other_direction = phase + 2 * np.pi * turns + np.pi * halves, direction + np.pi * halves
    for angle in (0.3, 2.0):
        same = tilt(1e-4, other_phase, other_direction, angle)
        assert tilt(amplitude, true_phase, direction, angle) == pytest.approx(same, abs=1e-12)
    numbers = compare_numbers(wobble(true_phase, direction, amplitude), [fitted(other_phase, other_direction)], None)
    assert all(number.covered for number in numbers if number.covered is not None)


@given(angles, angles)
def test_another_wobble_is_not_covered(phase, direction):
    numbers = {
        n.parameter: n for n in compare_numbers(wobble(phase, direction), [fitted(phase + 0.1, direction)], None)
    }
    assert numbers["amplitude"].covered
    assert not numbers["phase"].covered


def test_the_interval_is_196_standard_errors_wide_on_either_side():
    offset = concealed("joint_offset", "joint 1", parameters={"offset": (1.0, "rad")})
    for value, inside in ((1.195, True), (1.197, False), (0.805, True), (0.803, False)):
        said = claim("joint_offset", "joint 1", parameters={"offset": (value, 0.1, "rad")})
        assert compare_numbers(offset, [said], None)[0].covered is inside


def test_of_several_waves_the_one_with_the_true_count_is_compared():
    numbers = {
        n.parameter: n for n in compare_numbers(wobble(0.0, 0.0), [fitted(1.0, 1.0, 2.0), fitted(0.0, 0.0)], None)
    }
    assert numbers["per_turn"].right
    assert numbers["per_turn"].covered is None
    assert numbers["phase"].covered


@pytest.mark.parametrize(("found", "right"), [(20.0, True), (15.0, True), (10.0, True), (21.0, False), (9.0, False)])
def test_the_time_of_a_jump_is_right_within_its_two_recorded_rows(found, right):
    shift = concealed("base_shift", "base", parameters={"time": (16.0, "s")})
    said = claim("base_shift", "base", parameters={"time": (found, 0.0, "s")})
    (number,) = compare_numbers(shift, [said], pd.Series([0.0, 10.0, 20.0, 30.0]))
    assert number.right is right
