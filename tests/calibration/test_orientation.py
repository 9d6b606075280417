"""Measured orientations add what positions can't tell, weighed by their own noise."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.calibration.calibrate import calibrate
from armscope.calibration.fit import placed
from armscope.calibration.model import set_up
from armscope.robot import chain
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like

ON_AXIS = {"": [0.0, 0.0, 0.11]}  # on the axis of joint 6, which positions then can't see
TOOL_TURN = Rotation.from_rotvec([0.4, -1.2, 0.7])


def recorded(real, rng, angles, base, shift, turn):
    """Positions and orientations of a 6D probe with 1-sigma noise per axis ``shift`` m and ``turn`` rad."""
    recordings = measured(real, angles, base, ON_AXIS, shift, rng)
    true = Rotation.from_matrix(base[0] @ chain(real, angles).tool_rotation) * TOOL_TURN
    noisy = Rotation.from_rotvec(rng.normal(scale=max(turn, 1e-12), size=(len(angles), 3))) * true
    return replace(recordings, orientation=np.roll(noisy.as_quat(), 1, axis=1))


@pytest.fixture
def world():
    rng = np.random.default_rng(1)
    arm = ur_like()
    return arm, planted(arm, rng), far_away(rng), rng


def test_residuals_and_columns_are_derivatives_of_each_other(world):
    arm, real, base, rng = world
    recordings = recorded(real, rng, poses(rng, 12, 6), base, 0, 0)
    recordings = replace(recordings, torque=rng.normal(scale=30, size=(12, 6)))
    recordings.orientation[3] = np.nan
    rows = replace(set_up(arm, recordings, orientation=True), lever=0.7)
    state = placed(rows)
    free = rows.free("compliance")
    residual, jacobian = rows.linearised(state, free)
    assert len(residual) == 6 * 12
    for number, column in enumerate(np.flatnonzero(free)):
        step = np.zeros(len(free))
        step[column] = 1e-6
        forward, backward = (_in_start_axes(rows, state, sign * step) for sign in (1, -1))
        np.testing.assert_allclose(
            jacobian[:, number], (forward - backward) / 2e-6, atol=3e-5 * max(1, np.abs(jacobian[:, number]).max()),
            err_msg=rows.names[column],
        )  # fmt: skip


def _in_start_axes(rows, state, step):
    """What linearised predicts, by finite steps: positions and turns in the base axes of ``state``."""
    moved = state.moved(step)
    back = np.swapaxes(state.rotations[rows.base], 1, 2)
    points = np.einsum("nij,nj->ni", back, rows.predicted(moved) - state.translations[rows.base])

    def orientation(each):
        frames = rows.frames(each)[1]
        return each.rotations[rows.base] @ frames.tool_rotation @ each.tool_rotations[rows.tool]

    turned = back @ orientation(moved) @ np.swapaxes(back @ orientation(state), 1, 2)
    turns = Rotation.from_matrix(turned).as_rotvec()
    turns[~np.isfinite(rows.orientations).all(axis=(1, 2))] = 0
    return np.concatenate([points, rows.lever * turns], axis=1).ravel()


def test_orientations_show_the_joint_that_positions_do_not(world):
    arm, real, base, rng = world
    recordings = recorded(real, rng, poses(rng, 60, 6), base, 0, 0)
    blind = calibrate(arm, recordings, orientation=False)
    seeing = calibrate(arm, recordings)
    assert seeing.rms_distance < 1e-8
    assert np.abs(seeing.set_up.turn_residuals(seeing.state)).max() < 1e-8
    fresh = poses(rng, 40, 6)
    rows = set_up(arm, recorded(real, rng, fresh, base, 0, 0), orientation=True)
    assert np.abs(rows.turn_residuals(seeing.state)).max() < 1e-7
    # positions alone leave the turn about the last axis open, so the tool's orientation can't follow
    with_turn = replace(blind.state, tool_rotations=seeing.state.tool_rotations)
    assert np.abs(rows.turn_residuals(with_turn)).max() > 1e-4
    names = set(seeing.table["parameter"])
    assert {"tool rx", "tool ry", "tool rz"} <= names
    assert not {"tool rx", "tool ry", "tool rz"} & set(blind.table["parameter"])


def test_each_kind_weighs_as_much_as_its_noise_allows(world):
    arm, real, base, rng = world
    fresh = set_up(arm, measured(real, poses(rng, 100, 6), base, ON_AXIS))
    angles = poses(rng, 25, 6)

    def error(shift, turn, orientation):
        noise = np.random.default_rng(3)
        calibration = calibrate(arm, recorded(real, noise, angles, base, shift, turn), orientation=orientation)
        if orientation:
            assert calibration.set_up.lever == pytest.approx(shift / turn, rel=0.5)
        return float(np.sqrt(np.mean(fresh.residuals(calibration.state) ** 2)))

    # a good protractor helps a poor ruler, and a poor one does no harm
    assert error(3e-4, 5e-5, True) < 0.7 * error(3e-4, 5e-5, False)
    assert error(3e-5, 5e-2, True) < 1.1 * error(3e-5, 5e-2, False)


@pytest.mark.long
def test_orientations_are_left_out_where_they_make_positions_worse_and_this_is_said(world):
    arm, real, base, rng = world
    recordings = recorded(real, rng, poses(rng, 40, 6), base, 3e-4, 1e-5)
    assert calibrate(arm, recordings).set_up.orientations is not None
    # orientations that contradict positions: they turn about joint 3 by 5 mrad that no point moves by
    axis = chain(real, recordings.motor_angles).joint_rotation[:, 2, :, 2] @ base[0].T
    turned = Rotation.from_rotvec(5e-3 * axis) * Rotation.from_quat(recordings.orientation[:, [1, 2, 3, 0]])
    spoilt = replace(recordings, orientation=np.roll(turned.as_quat(), 1, axis=1))
    calibration = calibrate(arm, spoilt)
    assert calibration.set_up.orientations is None
    assert "orientations left out: held-out RMS distance" in calibration.text()
    assert calibrate(arm, spoilt, orientation=True).set_up.orientations is not None


def test_rows_without_orientation_still_count_by_their_position(world):
    arm, real, base, rng = world
    recordings = recorded(real, rng, poses(rng, 60, 6), base, 1e-5, 1e-5)
    recordings.orientation[::2] = np.nan
    calibration = calibrate(arm, recordings, robust=True)
    assert calibration.rms_distance < 5e-5
    assert np.isfinite(calibration.covariance).all()
