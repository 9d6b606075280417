"""The prepared on which effects are played: frames are those of the recordings, and geometry takes what it can make."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.core.averages import rms
from armscope.real.prepared_recordings import prepared_recordings
from armscope.real.simulated_effects import SimulatedEffects
from armscope.robot import forward_kinematics
from armscope.world.kinds import Concealed
from armscope.world.spec import KINDS
from tests.real.recorded import BASE, arm, table

LEVEL = 1e-4


@pytest.fixture(scope="module")
def simulated():
    return SimulatedEffects(prepared_recordings(arm(), table(), 1000))


def test_the_fitted_frames_are_those_of_the_recordings(simulated):
    assert np.allclose(simulated.prepared.rotations, BASE.as_matrix(), atol=1e-7)
    assert np.allclose(
        simulated.nominal, forward_kinematics(arm(), simulated.prepared.recordings.motor_angles), atol=1e-6
    )


def test_a_longer_scale_of_the_instrument_moves_points_in_proportion_and_turns_nothing(simulated):
    points = forward_kinematics(arm(), simulated.prepared.recordings.motor_angles)
    moved, turned = simulated.motion(Concealed(KINDS["instrument_scale"], "instrument", {"scale": 3e-4}))
    assert np.abs(moved - 3e-4 * points).max() < 1e-8
    assert Rotation.from_matrix(turned).magnitude().max() < 1e-12


def test_geometry_takes_what_it_can_make_at_its_price_and_leaves_what_it_cannot(simulated):
    # a zero off by 1.5 mrad is 1.5 sigma of one number: it costs 1.5^2, however small the noise is
    stays, train = np.zeros((len(simulated.nominal), 3)), simulated.prepared.train
    angles = simulated.prepared.recordings.motor_angles.copy()
    angles[:, 2] += 1.5e-3
    zero = simulated.left(forward_kinematics(arm(), angles) - simulated.nominal)
    assert simulated.beyond_geometry(stays, LEVEL) == 0
    assert 2.0 < simulated.beyond_geometry(zero, LEVEL / 10) <= 1.5**2 * 1.01  # it is no small turn to first order only
    assert rms(zero[train]) > 10 * LEVEL / 10
    # noise is no geometry: at most one of its 3 T numbers goes for each frame's and each link's
    noise = simulated.left(np.random.default_rng(4).normal(0, LEVEL, stays.shape))
    numbers = noise[train].size
    assert numbers - 9 - 31 - 2 * np.sqrt(2 * numbers) < simulated.beyond_geometry(noise, LEVEL) < numbers


def test_frames_take_all_of_a_rigid_motion_and_of_a_moved_tool(simulated):
    rigid = np.tile([1e-3, -2e-3, 5e-4], (len(simulated.nominal), 1)) + 1e-4 * np.cross([0, 0, 1], simulated.nominal)
    tool = np.einsum("nij,j->ni", simulated.turns, [1e-3, 0, 2e-3])
    assert np.abs(simulated.left(rigid + tool)).max() < 1e-9
