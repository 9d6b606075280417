"""The five-bar linkage: ideal by the paper's Eqs. (1)-(2), perturbed by the lengths of its own bars."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from armscope.robot import chain, load_arm, load_description
from armscope.robot.parallelogram import Linkage, forearm_deviation
from tests.robot.arms import SK120

ANGLES = np.linspace(0.7, 2.4, 50)
IDEAL = Linkage(crank=0.35, rocker=0.35, rod=1.15, upper_arm=1.15)


def rod_length(linkage, elbow_angle, deviation):
    """From crank pin to rocker pin, by coordinates; upper arm along x, shoulder at the origin."""
    gamma = elbow_angle + linkage.crank_angle
    crank_pin = linkage.crank * np.array([np.cos(gamma), np.sin(gamma)])
    rocker = gamma + deviation
    rocker_pin = np.array([linkage.upper_arm + linkage.rocker * np.cos(rocker), linkage.rocker * np.sin(rocker)])
    return np.hypot(*(crank_pin - rocker_pin))


def test_equal_opposite_sides_keep_the_forearm_parallel_to_the_crank():
    assert np.abs(forearm_deviation(IDEAL, ANGLES)).max() < 1e-12


@settings(max_examples=100, deadline=None)
@given(errors=st.lists(st.floats(-2e-3, 2e-3), min_size=4, max_size=4), crank_angle=st.floats(-0.2, 0.2))
def test_a_perturbed_loop_closes_on_the_rods_length(errors, crank_angle):
    lengths = np.array([0.35, 0.35, 1.15, 1.15]) + errors
    linkage = Linkage(*lengths, crank_angle=crank_angle)
    deviation = forearm_deviation(linkage, ANGLES)
    assert np.abs(rod_length(linkage, ANGLES, deviation) - linkage.rod).max() < 1e-12
    assert np.abs(deviation).max() < 0.2


def test_small_errors_follow_the_linear_formula():
    """Closing the loop to first order: the rocker's turn makes up for what the bars' lengths lack along the rod."""
    d_crank, d_rocker, d_rod, d_arm = 1e-7, 3e-7, -2e-7, 4e-7
    linkage = Linkage(0.35 + d_crank, 0.35 + d_rocker, 1.15 + d_rod, 1.15 + d_arm)
    # pins differ by (l + k cos, k sin) - (c cos, c sin); its change along the rod (x) must be that of the rod
    expected = (d_arm - d_rod + (d_rocker - d_crank) * np.cos(ANGLES)) / (0.35 * np.sin(ANGLES))
    assert np.abs(forearm_deviation(linkage, ANGLES) - expected).max() < 1e-4 * np.abs(expected).min()


def test_the_sign_a_longer_rod_folds_the_rocker_back():
    deviation = forearm_deviation(Linkage(0.35, 0.35, 1.151, 1.15), np.array([np.pi / 2]))
    assert deviation[0] == pytest.approx(-0.001 / 0.35, rel=1e-2)


def test_a_loop_that_cannot_close_is_nan_and_not_a_number():
    assert np.isnan(forearm_deviation(Linkage(0.35, 0.35, 2.0, 1.15), ANGLES)).all()


def test_the_sk120s_linkage_is_an_ideal_parallelogram():
    stated = load_description(SK120).parallelogram
    linkage = Linkage.from_description(stated)
    q = np.array([[0.0, q2, q3, 0, 0, 0] for q2 in (-1, 0, 1) for q3 in (0.2, 1.0, 1.5) if 0.2 < q3 - q2 < 3])
    assert len(q) >= 5
    assert np.abs(forearm_deviation(linkage, q[:, 2] - q[:, 1])).max() < 1e-12


def test_the_forearm_keeps_its_direction_when_only_the_upper_arm_moves():
    """What a parallelogram is for: motor 2 turns the upper arm, the forearm (frame 3) only shifts."""
    arm = load_arm(SK120)
    q = np.zeros((5, 6))
    q[:, 2] = 0.4
    q[:, 1] = np.linspace(-0.5, 0.5, 5)
    frames = chain(arm, q)
    assert np.abs(frames.link_rotation[:, 2] - frames.link_rotation[0, 2]).max() < 1e-12
    assert np.ptp(frames.link_origin[:, 2], axis=0).max() > 0.5
