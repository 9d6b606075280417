"""Commands bring the real arm to the wanted points, judged by other forward models than the solver's own."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.compensation.compensate import compensate_black_box, compensate_physical
from armscope.compensation.forward import BlackBoxArm, PhysicalArm
from armscope.compensation.path import as_path
from armscope.compensation.task import Options
from armscope.core.inputs import InputError
from armscope.physics.model import predict
from armscope.recordings.table import as_recordings
from armscope.robot import chain, forward_kinematics
from armscope.robot.inverse import follow_path

from .arms import CONTEXT, MIDDLE, black_box, physical, physical_path, sk120, table_of, wanted_points


def error_mm(model, angles):
    """The black-box error by its definition."""
    nominal = forward_kinematics(sk120(), angles) * 1e3
    inputs = nominal if model.space == "cartesian" else angles
    return model.features.matrix(inputs) @ model.coefficients[0].T


@pytest.mark.parametrize("space", ["cartesian", "angular"])
def test_error_at_the_corrected_command_counts_not_at_the_wanted_point(space):
    model, wanted = black_box(space), wanted_points()
    result = compensate_black_box(model, as_path(table_of(wanted), "path", sk120()))
    assert result.reached.all()
    real = forward_kinematics(sk120(), result.commands) * 1e3 + error_mm(model, result.commands)
    left = np.linalg.norm(real - wanted * 1e3, axis=1)
    assert left.max() < 1e-5
    nominal = follow_path(sk120(), wanted, MIDDLE, {4: 0.0, 5: 0.0}).require_all("path")
    missed = np.linalg.norm(error_mm(model, nominal), axis=1)
    assert missed.min() > 0.1
    # the false target of a single step: wanted minus the error there
    once = follow_path(sk120(), wanted - error_mm(model, nominal) * 1e-3, MIDDLE, {4: 0.0, 5: 0.0}).require_all("path")
    left_once = np.linalg.norm(forward_kinematics(sk120(), once) * 1e3 + error_mm(model, once) - wanted * 1e3, axis=1)
    assert left_once.max() > 100 * left.max()


def test_false_targets_are_where_a_nominal_controller_must_be_sent():
    model = black_box()
    result = compensate_black_box(model, as_path(table_of(wanted_points()), "path", sk120()))
    np.testing.assert_allclose(result.false_targets, forward_kinematics(sk120(), result.commands), atol=1e-12)


def test_a_joint_path_wants_the_points_of_the_nominal_arm():
    model = black_box()
    angles = MIDDLE + np.linspace(-0.2, 0.2, 30)[:, None] * np.array([1, 0.5, -0.5, 0, 0, 1])
    table = pd.DataFrame(np.degrees(angles), columns=[f"q{j}_deg" for j in range(1, 7)])
    result = compensate_black_box(model, as_path(table, "path", sk120()))
    real = forward_kinematics(sk120(), result.commands) * 1e3 + error_mm(model, result.commands)
    np.testing.assert_allclose(real, forward_kinematics(sk120(), angles) * 1e3, atol=1e-5)
    assert np.abs(result.commands - angles).max() < 0.01


def test_motors_that_stood_still_at_identification_keep_still():
    result = compensate_black_box(black_box("angular"), as_path(table_of(wanted_points()), "path", sk120()))
    assert np.abs(result.commands[:, 3:5]).max() < 1e-12


def physical_angles(model, table, commands, context):
    columns = {f"q{j}_rad": commands[:, j - 1] for j in range(1, 7)}
    rows = as_recordings(pd.DataFrame(columns).assign(**context), measured=False)
    return replace(rows, run=np.full(len(rows), "monday"), target=np.full(len(rows), "ball"))


def test_physics_reaches_the_points_that_the_instrument_reads():
    model, identified = physical()
    points, middle = physical_path()
    measured = model.to_measurement(points, np.full(len(points), "monday"))
    path = as_path(table_of(measured, **CONTEXT), "path", model.arm)
    result = compensate_physical(model, identified, path, Options("measurement", start_rad=middle))
    assert result.reached.all(), set(result.reasons)
    rows = physical_angles(model, path, result.commands, CONTEXT)
    assert np.abs(predict(model, rows) - measured).max() < 2e-9
    assert np.sqrt(np.mean(result.uncorrected**2)) > 5e-4
    np.testing.assert_allclose(result.predicted, measured, atol=2e-9)


def test_in_the_base_frame_the_registration_does_not_matter():
    model, identified = physical()
    points, middle = physical_path()
    path = as_path(table_of(points, **CONTEXT), "path", model.arm)
    near = compensate_physical(model, identified, path, Options(start_rad=middle))
    measured = model.to_measurement(points, np.full(len(points), "monday"))
    far_path = as_path(table_of(measured, **CONTEXT), "path", model.arm)
    far = compensate_physical(model, identified, far_path, Options("measurement", start_rad=middle))
    np.testing.assert_allclose(near.commands, far.commands, atol=1e-8)


def test_another_load_asks_for_other_commands():
    model, identified = physical()
    points, middle = physical_path()
    light, heavy = (
        compensate_physical(
            model, identified, as_path(table_of(points, payload_kg=load, temperature_c=24.0), "p", model.arm),
            Options(start_rad=middle),
        )
        for load in (0.0, 10.0)
    )  # fmt: skip
    assert np.abs(light.commands - heavy.commands).max() > 1e-5


def test_full_pose_keeps_the_orientation_too():
    model, identified = physical()
    points, middle = physical_path()
    turn = chain(model.arm, middle[None]).tool_rotation[0]
    x, y, z, w = Rotation.from_matrix(turn).as_quat()
    path = as_path(table_of(points, qw=w, qx=x, qy=y, qz=z, **CONTEXT), "path", model.arm)
    result = compensate_physical(model, identified, path, Options(pose=True, start_rad=middle))
    assert result.reached.all(), set(result.reasons)
    rows = physical_angles(model, path, result.commands, CONTEXT)
    frames = model.posture(model.scene(rows)).frames
    assert Rotation.from_matrix(frames.tool_rotation @ turn.T).magnitude().max() < 1e-8
    assert np.abs(frames.tool - points).max() < 2e-9
    free = compensate_physical(model, identified, path, Options(start_rad=middle))
    frames = model.posture(model.scene(physical_angles(model, path, free.commands, CONTEXT))).frames
    assert Rotation.from_matrix(frames.tool_rotation @ turn.T).magnitude().max() > 1e-3


def test_commands_of_a_long_path_do_not_jump():
    model, identified = physical()
    points, middle = physical_path(3000)
    path = as_path(table_of(points, **CONTEXT), "path", model.arm)
    result = compensate_physical(model, identified, path, Options(start_rad=middle))
    assert result.reached.all()
    few = compensate_physical(
        model, identified, as_path(table_of(points[::10], **CONTEXT), "p", model.arm), Options(start_rad=middle)
    )
    assert np.abs(np.diff(result.commands, axis=0)).max() < 3e-3
    # knots and interpolation lead along the same branch as every point by itself
    assert np.abs(result.commands[::10] - few.commands).max() < 0.02


@pytest.mark.parametrize("space", ["cartesian", "angular"])
def test_black_box_jacobian_is_exact(space):
    arm = BlackBoxArm(black_box(space))
    angles = MIDDLE + np.random.default_rng(0).uniform(-0.2, 0.2, (5, 6))
    rows = np.arange(5)
    exact = arm.at(angles, rows).jacobian[:, :3]
    for j in range(6):
        shift = 1e-6 * np.eye(6)[j]
        slope = (arm.at(angles + shift, rows).points - arm.at(angles - shift, rows).points) / 2e-6
        np.testing.assert_allclose(exact[:, :, j], slope, atol=1e-8)


def test_physical_jacobian_differs_from_the_exact_one_by_the_errors_size_only():
    model, _ = physical()
    rows = physical_angles(model, None, MIDDLE[None] + np.zeros((4, 1)), CONTEXT)
    arm = PhysicalArm(model, rows, True)
    angles = MIDDLE + np.random.default_rng(0).uniform(-0.2, 0.2, (4, 6))
    jacobian = arm.at(angles, np.arange(4)).jacobian[:, :3]
    for j in range(6):
        shift = 1e-5 * np.eye(6)[j]
        slope = (arm.at(angles + shift, np.arange(4)).points - arm.at(angles - shift, np.arange(4)).points) / 2e-5
        assert np.abs(jacobian[:, :, j] - slope).max() < 5e-3


def test_a_table_of_commands_has_every_row_of_the_path_and_no_command_where_refused():
    wanted = wanted_points(20)
    wanted[7] = [9.0, 0, 0]
    wanted[12] += [0.0, 0.0, 0.9]
    result = compensate_black_box(black_box(), as_path(table_of(wanted), "path", sk120()))
    table = result.to_table()
    assert len(table) == 20
    assert table["status"].tolist().count("refused") == (~result.reached).sum() >= 2
    assert "beyond reach" in table["reason"][7]
    pieces = [result.to_table(rows) for rows in (slice(0, 8), slice(8, 20))]  # so a long path is written
    pd.testing.assert_frame_equal(pd.concat(pieces, ignore_index=True), table)
    refused = table[table["status"] == "refused"]
    assert refused.filter(regex="^q._rad$").isna().all(axis=None)
    assert table[table["status"] == "ok"].filter(regex="^q._rad$").notna().all(axis=None)
    with pytest.raises(InputError, match=r"line 9.*beyond reach"):
        result.require_all("job.mod")


def test_given_angles_choose_the_branch_they_need_not_be_exact():
    model, wanted = black_box(), wanted_points(20)
    alone = compensate_black_box(model, as_path(table_of(wanted), "path", sk120()))
    rough = {f"q{j}_rad": alone.commands[:, j - 1].round(1) for j in (1, 2, 3, 6)} | {"q4_rad": 0.0, "q5_rad": 0.0}
    result = compensate_black_box(model, as_path(table_of(wanted, **rough), "path", sk120()))
    assert result.reached.all(), set(result.reasons)
    real = forward_kinematics(sk120(), result.commands) * 1e3 + error_mm(model, result.commands)
    np.testing.assert_allclose(real, wanted * 1e3, atol=1e-5)
    np.testing.assert_allclose(result.uncorrected, alone.uncorrected, rtol=0.05)
