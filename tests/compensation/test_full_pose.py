"""Position and orientation together: planted errors are found, in mm and mrad, and corrected."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from armscope.cli import app
from armscope.compensation.black_box import load_error_model, save_error_model
from armscope.compensation.compensate import compensate_black_box
from armscope.compensation.fitting import fit_error_model
from armscope.compensation.forward import BlackBoxArm
from armscope.compensation.newton import Wanted
from armscope.compensation.path import as_path, nominal_branch
from armscope.compensation.task import Options
from armscope.core.inputs import InputError
from armscope.errormodels.features import FDP_CI, FOURIER_2_AI, SDP_AI, ModelSpec
from armscope.physics.model_file import save_model
from armscope.recordings.table import as_recordings
from armscope.robot import chain, forward_kinematics, tool_frames

from .arms import CONTEXT, identification_angles, physical, physical_path, sk120

MIDDLE = np.array([0.1, 0.2, 0.3, 0.2, 0.7, 0.0])
HALF = np.array([0.4, 0.3, 0.4, 0.4, 0.3, 0.6])
FRAME = Rotation.from_euler("xyz", [0.3, -0.2, 2.0])
MOUNTED = Rotation.from_euler("xyz", [0.5, 0.1, -1.0])
SHIFT = np.array([3.0, -1.0, 0.4])


def angles_of(count, seed):
    return MIDDLE + HALF * np.random.default_rng(seed).uniform(-1, 1, (count, 6))


def planted(angles):
    """(errors mm, turns rad) that an SDP(AI) describes exactly."""
    terms = SDP_AI.features(angles_of(60, 0)).matrix(angles)
    rng = np.random.default_rng(3)
    return terms @ rng.normal(0, 0.5, (13, 3)), terms @ rng.normal(0, 1e-3, (13, 3))


def true_pose(angles):
    """The real arm's tool point (m) and last frame in the base frame."""
    frames, (errors, turns) = chain(sk120(), angles), planted(angles)
    return frames.tool + errors * 1e-3, Rotation.from_rotvec(turns) * Rotation.from_matrix(frames.tool_rotation)


def recorded(angles, elsewhere=False):
    """Recordings in the base frame, or in a measurement frame elsewhere with a tool frame turned on the flange."""
    points, turned = true_pose(angles)
    if elsewhere:
        points, turned = FRAME.apply(points) + SHIFT, FRAME * turned * MOUNTED
    table = pd.DataFrame(angles, columns=[f"q{j}_rad" for j in range(1, 7)])
    table[["x_mm", "y_mm", "z_mm"]] = points * 1e3
    table[["qx", "qy", "qz", "qw"]] = turned.as_quat()
    return as_recordings(table, n_motors=6)


def turns_between(first, second):
    return (first * second.inv()).magnitude()


def test_planted_errors_of_position_and_orientation_are_found():
    model = fit_error_model(sk120(), recorded(angles_of(60, 1)), SDP_AI)
    assert np.abs(model.rms_mm).max() < 1e-9
    assert np.abs(model.turning.rms_mrad).max() < 1e-9
    points, rotations = model.tool_pose(angles_of(30, 2))
    true_points, true_turns = true_pose(angles_of(30, 2))
    np.testing.assert_allclose(points, true_points, atol=1e-12)
    assert turns_between(Rotation.from_matrix(rotations), true_turns).max() < 1e-9


@pytest.mark.parametrize(
    ("spec", "options"),
    [
        (ModelSpec("polynomial", 3, "angular"), {"products": True}),
        (FOURIER_2_AI, {}),
        (FOURIER_2_AI, {"method": "swarm"}),
        (FDP_CI, {"regions": 2}),
        (FDP_CI, {"regions": None}),
    ],
)
def test_every_family_takes_most_of_both_errors_off_held_out_poses(spec, options):
    model = fit_error_model(sk120(), recorded(angles_of(150, 1)), spec, **options)
    held_out = angles_of(50, 2)
    (errors, turns), (points, rotations) = planted(held_out), model.tool_pose(held_out)
    true_points, true_turns = true_pose(held_out)
    share = 0.8 if spec is FDP_CI else 0.2
    assert np.linalg.norm(points - true_points) * 1e3 < share * np.linalg.norm(errors - errors.mean(axis=0))
    left = turns_between(Rotation.from_matrix(rotations), true_turns)
    assert np.linalg.norm(left) < (1.0 if spec is FDP_CI else 0.2) * np.linalg.norm(turns)


def test_the_jacobian_of_the_pose_is_the_slope():
    arm, angles = BlackBoxArm(fit_error_model(sk120(), recorded(angles_of(60, 1)), SDP_AI)), angles_of(5, 4)
    rows, step = np.arange(5), 1e-6
    at = arm.at(angles, rows)
    for j in range(6):
        ahead, behind = (arm.at(angles + sign * step * np.eye(6)[j], rows) for sign in (1, -1))
        moved = (ahead.points - behind.points) / (2 * step)
        turned = Rotation.from_matrix(ahead.rotations @ np.swapaxes(behind.rotations, 1, 2)).as_rotvec() / (2 * step)
        np.testing.assert_allclose(at.jacobian[:, :3, j], moved, atol=1e-8)
        np.testing.assert_allclose(at.jacobian[:, 3:, j], turned, atol=2e-5)  # half a product of two errors is left out


@pytest.fixture(scope="module")
def wanted():
    """A short path of full poses on the nominal arm."""
    angles = MIDDLE + np.linspace(-0.3, 0.3, 25)[:, None] * HALF * np.array([1, -1, 0.5, 1, 0.5, -1])
    table = pd.DataFrame(angles, columns=[f"q{j}_rad" for j in range(1, 7)])
    return table, chain(sk120(), angles)


def test_the_arm_reaches_the_wanted_poses_in_closed_loop(wanted):
    table, nominal = wanted
    model = fit_error_model(sk120(), recorded(angles_of(60, 1)), SDP_AI)
    result = compensate_black_box(model, as_path(table, "path", sk120()), Options(pose=True))
    assert result.reached.all()
    points, turned = true_pose(result.commands)
    goal = Rotation.from_matrix(nominal.tool_rotation)
    assert np.abs(points - nominal.tool).max() < 1e-8
    assert turns_between(turned, goal).max() < 1e-7
    before_points, before_turned = true_pose(table.to_numpy())
    assert np.linalg.norm(before_points - nominal.tool, axis=1).min() > 1e-4
    told = result.to_table()
    np.testing.assert_allclose(told["uncorrected_mrad"] * 1e-3, turns_between(before_turned, goal), rtol=1e-6)
    assert told["residual_mrad"].max() < 1e-4
    assert told["uncorrected_mrad"].min() > 0.1


def test_without_measured_orientations_the_nominal_one_is_kept_and_that_is_said(wanted):
    """Negative control: the position comes right, the orientation keeps its error."""
    table, nominal = wanted
    rows = replace(recorded(angles_of(60, 1)), orientation=None)
    model = fit_error_model(sk120(), rows, SDP_AI)
    assert model.turning is None
    result = compensate_black_box(model, as_path(table, "path", sk120()), Options(pose=True))
    assert "positions only" in result.notes[-1]
    points, turned = true_pose(result.commands)
    assert np.abs(points - nominal.tool).max() < 1e-8
    assert turns_between(turned, Rotation.from_matrix(nominal.tool_rotation)).min() > 1e-4


def test_frames_and_the_tools_turn_are_fitted_where_asked(wanted, tmp_path):
    rows = recorded(angles_of(200, 1), elsewhere=True)
    with pytest.raises(InputError, match="--register"):
        fit_error_model(sk120(), rows, SDP_AI)
    model = fit_error_model(sk120(), rows, ModelSpec("polynomial", 3, "angular"), register=True, products=True)
    save_error_model(tmp_path / "m.json", model)
    read = load_error_model(tmp_path / "m.json")
    held_out = angles_of(40, 2)
    points, turned = true_pose(held_out)
    predicted, rotations = read.as_measured(held_out)
    np.testing.assert_array_equal(predicted, model.as_measured(held_out)[0])
    assert np.abs(predicted - FRAME.apply(points) - SHIFT).max() < 3e-4
    assert turns_between(Rotation.from_matrix(rotations), FRAME * turned * MOUNTED).max() < 3e-4


def test_orientations_of_another_tool_frame_or_in_another_order_are_refused():
    rows = recorded(angles_of(60, 1))
    wrong = replace(rows, orientation=np.roll(rows.orientation, 1, axis=1))
    with pytest.raises(InputError, match="order wxyz"):
        fit_error_model(sk120(), wrong, SDP_AI)
    assert fit_error_model(sk120(), wrong, SDP_AI, orientation=False).turning is None
    few = rows.orientation.copy()
    few[10:] = np.nan
    with pytest.raises(InputError, match="10 rows with an orientation"):
        fit_error_model(sk120(), replace(rows, orientation=few), SDP_AI)


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_predict_writes_orientations_of_both_kinds_of_model(tmp_path):
    save_error_model(tmp_path / "m.json", fit_error_model(sk120(), recorded(angles_of(60, 1)), SDP_AI))
    angles = angles_of(7, 5)
    pd.DataFrame(angles, columns=[f"q{j}_rad" for j in range(1, 7)]).to_csv(tmp_path / "poses.csv", index=False)
    done = run("predict", tmp_path / "m.json", tmp_path / "poses.csv", "--pose", "-o", tmp_path / "p.csv")
    assert done.exit_code == 0, done.output
    table = pd.read_csv(tmp_path / "p.csv")
    points, turned = true_pose(angles)
    np.testing.assert_allclose(table[["x_mm", "y_mm", "z_mm"]], points * 1e3, atol=1e-6)
    assert turns_between(Rotation.from_quat(table[["qx", "qy", "qz", "qw"]]), turned).max() < 1e-7


def test_diagnosed_physics_predicts_how_the_tool_is_turned(tmp_path):
    """Planted: an offset of joint 3, compliance, warmth; the offset alone turns the tool by its angle."""
    model, _ = physical()
    offset = replace(model, parts=tuple(part for part in model.parts if part.placed.name == "joint_offset"))
    save_model(tmp_path / "model.yaml", offset)
    _, middle = physical_path()
    table = pd.DataFrame(middle[None], columns=[f"q{j}_rad" for j in range(1, 7)]).assign(run="monday", **CONTEXT)
    table.assign(target="ball").to_csv(tmp_path / "poses.csv", index=False)
    done = run("predict", tmp_path / "model.yaml", tmp_path / "poses.csv", "--pose", "-o", tmp_path / "p.csv")
    assert done.exit_code == 0, done.output
    turned = Rotation.from_quat(pd.read_csv(tmp_path / "p.csv")[["qx", "qy", "qz", "qw"]])
    moved = middle + 8e-4 * np.eye(6)[2]
    expected = Rotation.from_matrix(model.bases["monday"].rotation @ chain(model.arm, moved[None]).tool_rotation)
    assert turns_between(turned, expected).max() < 1e-8
    nominal = Rotation.from_matrix(model.bases["monday"].rotation @ chain(model.arm, middle[None]).tool_rotation)
    assert turns_between(turned, nominal) == pytest.approx(8e-4)


def test_a_position_model_has_no_orientation_to_predict(tmp_path):
    angles = identification_angles()
    rows = as_recordings(
        pd.DataFrame(
            np.column_stack([angles, forward_kinematics(sk120(), angles) * 1e3 + 1.0]),
            columns=[*(f"q{j}_rad" for j in range(1, 7)), "x_mm", "y_mm", "z_mm"],
        )
    )
    save_error_model(tmp_path / "m.json", fit_error_model(sk120(), rows, FDP_CI))
    pd.DataFrame(angles[:2], columns=[f"q{j}_rad" for j in range(1, 7)]).to_csv(tmp_path / "poses.csv", index=False)
    done = run("predict", tmp_path / "m.json", tmp_path / "poses.csv", "--pose", "-o", tmp_path / "p.csv")
    assert "positions only" in str(done.exception)


def test_poses_that_are_no_path_may_each_have_a_branch_of_their_own():
    arm = sk120()
    angles = np.array(
        [[0.2, 0.3, 0.1, 0.2, 0.7, 0.0], [-2.4, -0.4, 0.5, 1.2, -0.9, 0.4], [1.9, 0.5, -0.3, -1.0, 1.1, 2.0]]
    )
    frames = tool_frames(arm, angles)
    wanted = Wanted(*frames)
    path = nominal_branch(arm, wanted, angles[0])
    assert [reason[:4] for reason in path.reasons] == ["", "jump", "jump"]
    separate = nominal_branch(arm, wanted, angles[0], largest_step=np.inf)
    assert separate.reached.all()
    for found, asked in zip(tool_frames(arm, separate.motor_angles), frames, strict=True):
        np.testing.assert_allclose(found, asked, atol=1e-8)
