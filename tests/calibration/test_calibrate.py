"""Planted geometry comes back; what the poses can't tell is held and said; covariance means what it says."""

from pathlib import Path

import numpy as np
import pytest
import scipy.optimize

from armscope.calibration.calibrate import calibrate
from armscope.calibration.geometry import constant_columns, constants_of, corrected
from armscope.calibration.held_out import held_out_levels, random_split
from armscope.calibration.model import set_up
from armscope.calibration.solve import Priors
from armscope.core.inputs import InputError
from armscope.recordings import read_recordings
from armscope.robot import chain, forward_kinematics, load_arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like, urdf_of_any_axes
from tests.robot.arms import STANDARD, as_modified, as_urdf, dh_arm

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "recordings"
TOOL = {"": [0.05, 0.1, 0.2]}
ARMS = ["standard", "modified", "parallel axes", "urdf", "urdf of any axes", "parallelogram"]


@pytest.fixture(params=ARMS)
def arm(request, tmp_path):
    if request.param == "urdf":
        (tmp_path / "arm.urdf").write_text(as_urdf(STANDARD))
        return build_arm(RobotDescription(name="urdf arm", urdf=str(tmp_path / "arm.urdf"), tip="flange"))
    if request.param == "urdf of any axes":
        (tmp_path / "arm.urdf").write_text(urdf_of_any_axes())
        hold = {"held": 0.3}
        return build_arm(RobotDescription(name="any", urdf=str(tmp_path / "arm.urdf"), tip="flange", hold_joints=hold))
    return {
        "standard": lambda: dh_arm(STANDARD),
        "modified": lambda: dh_arm(as_modified(STANDARD), "modified"),
        "parallel axes": ur_like,
        "parallelogram": lambda: load_arm(ROOT / "config" / "robots" / "sk120.yaml"),
    }[request.param]()


def test_columns_are_the_derivatives_of_the_exact_arm(arm):
    rng = np.random.default_rng(1)
    constants = constants_of(arm)
    start = np.zeros(len(constants))
    if arm.description.dh is not None:
        start = rng.normal(scale=0.02, size=len(constants))
    angles = poses(rng, 6, arm.n_motors)
    here = corrected(arm, constants, start)
    exact = constant_columns(here, chain(here, angles), constants)
    for column in range(len(constants)):
        step = np.zeros(len(constants))
        step[column] = 1e-6
        forward = forward_kinematics(corrected(arm, constants, start + step), angles)
        backward = forward_kinematics(corrected(arm, constants, start - step), angles)
        np.testing.assert_allclose(
            exact[:, :, column], (forward - backward) / 2e-6, atol=1e-7, err_msg=constants[column].name
        )


def test_planted_geometry_is_found_to_a_micrometre_on_poses_that_took_no_part(arm):
    rng = np.random.default_rng(2)
    real, base = planted(arm, rng), far_away(rng)
    calibration = calibrate(arm, measured(real, poses(rng, 80, arm.n_motors), base, TOOL))
    assert calibration.rms_distance < 1e-8
    fresh = measured(real, poses(rng, 50, arm.n_motors), base, TOOL)
    left = set_up(arm, fresh).residuals(calibration.state)
    assert np.linalg.norm(left, axis=1).max() < 1e-6
    assert calibration.reason == "the step became negligible"


def test_the_number_of_identifiable_constants_is_the_rank_of_the_columns(arm):
    rng = np.random.default_rng(4)
    recordings = measured(arm, poses(rng, 100, arm.n_motors), far_away(rng), TOOL)
    calibration = calibrate(arm, recordings)
    everything = calibration.set_up.free("geometric")
    _, jacobian = calibration.set_up.linearised(calibration.state, everything)
    unit = jacobian / np.linalg.norm(jacobian, axis=0).clip(1e-12)
    assert calibration.free.sum() == np.linalg.matrix_rank(unit, tol=1e-6)
    assert calibration.free.sum() == 27  # 4 per joint of six, and base and tool complete the rest
    assert calibration.free[:9].all()  # base and tool come first
    assert len(calibration.held) == everything.sum() - 27


def test_turns_about_y_are_fitted_between_parallel_axes_only():
    rng = np.random.default_rng(5)
    calibration = calibrate(ur_like(), measured(ur_like(), poses(rng, 100, 6), far_away(rng), TOOL))
    betas = [name for name in calibration.table["parameter"] if name.endswith("beta")]
    assert betas == ["joint 2 beta", "joint 3 beta"]
    crossing = dh_arm([row if row[1] else (row[0], 20, *row[2:]) for row in STANDARD])
    calibration = calibrate(crossing, measured(crossing, poses(rng, 100, 6), far_away(rng), TOOL))
    assert not [name for name in calibration.table["parameter"] if name.endswith("beta")]


def test_scipy_finds_the_same_minimum():
    rng = np.random.default_rng(6)
    arm = ur_like()
    recordings = measured(planted(arm, rng), poses(rng, 40, 6), far_away(rng), TOOL, 1e-4, rng)
    ours = calibrate(arm, recordings)
    rows = ours.set_up

    def residual(values):
        step = np.zeros(len(ours.free))
        step[ours.free] = values
        return rows.residuals(ours.state.moved(step)).ravel()

    start = rng.normal(scale=1e-3, size=ours.free.sum())
    theirs = scipy.optimize.least_squares(residual, start, x_scale="jac", xtol=1e-14, ftol=1e-14, gtol=1e-14)
    mine = float(np.sum(ours.residuals**2)) / 2
    assert mine == pytest.approx(theirs.cost, rel=1e-6)


def test_standard_errors_cover_the_truth_as_often_as_they_claim():
    arm, pulls = ur_like(), []
    for seed in range(30):
        rng = np.random.default_rng(100 + seed)
        recordings = measured(arm, poses(rng, 60, 6), far_away(rng), TOOL, 1e-4, rng)
        table = calibrate(arm, recordings).table
        constants = table[table["parameter"].str.startswith("joint")]
        pulls.append((constants["value"] / constants["stderr"]).to_numpy())
    assert np.std(pulls) == pytest.approx(1.0, abs=0.08)
    assert np.mean(np.abs(pulls) < 1.96) == pytest.approx(0.95, abs=0.025)


def test_bad_shots_are_named_and_lose_their_say_with_the_robust_option():
    rng = np.random.default_rng(7)
    arm, base = ur_like(), far_away(rng)
    real, angles = planted(arm, rng), poses(rng, 120, 6)
    recordings = measured(real, angles, base, TOOL, 1e-4, rng)
    bad = rng.choice(120, 6, replace=False)
    recordings.positions[bad] += rng.normal(scale=0.03, size=(6, 3))
    robust = calibrate(arm, recordings, robust=True)
    assert set(np.flatnonzero(robust.suspects)) == set(bad)
    assert "6 rows look like bad shots" in robust.text()
    fresh = set_up(arm, measured(real, poses(rng, 60, 6), base, TOOL))

    def error(calibration):
        return np.sqrt(np.mean(fresh.residuals(calibration.state) ** 2))

    assert error(robust) < 1e-4
    assert error(calibrate(arm, recordings)) > 10 * error(robust)


def test_compliance_under_recorded_torques_is_found():
    rng = np.random.default_rng(8)
    arm, base, angles = ur_like(), far_away(rng), poses(rng, 80, 6)
    torque, compliance = rng.normal(scale=40, size=(80, 6)), np.array([1, 5, 3, 0, 0, 0]) * 1e-6
    recordings = measured(arm, angles + torque * compliance, base, TOOL)
    import dataclasses

    recordings = dataclasses.replace(recordings, motor_angles=angles, torque=torque)
    calibration = calibrate(arm, recordings, "compliance")
    np.testing.assert_allclose(calibration.state.compliances[:5], compliance[:5], atol=1e-11)
    assert calibration.set_up.load_source == "recorded torques"
    assert calibrate(arm, recordings, "geometric").rms_distance > 1e-5


def test_priors_hold_what_the_poses_do_not_tell():
    rng = np.random.default_rng(9)
    arm = ur_like()
    recordings = measured(planted(arm, rng), poses(rng, 60, 6), far_away(rng), TOOL, 1e-4, rng)
    fixed, held = calibrate(arm, recordings), calibrate(arm, recordings, redundancy="priors")
    assert held.held == ()
    assert np.abs(held.residuals - fixed.residuals).max() < 5e-5
    stiff = calibrate(arm, recordings, redundancy="priors", priors=Priors(length=1e-9, angle=1e-9))
    nominal = calibrate(arm, recordings, "nominal")
    assert stiff.rms_distance == pytest.approx(nominal.rms_distance, rel=1e-3)


def test_too_few_rows_and_the_wrong_arm_are_clear_errors():
    rng = np.random.default_rng(10)
    arm = ur_like()
    recordings = measured(arm, poses(rng, 8, 6), far_away(rng), TOOL)
    with pytest.raises(InputError, match=r"8 rows.*parameters need more than"):
        calibrate(arm, recordings)
    with pytest.raises(InputError, match="right robot"):
        calibrate(dh_arm(STANDARD[:5]), recordings)


def test_a_split_keeps_the_targets_of_a_configuration_together_and_follows_the_protocol():
    rng = np.random.default_rng(11)
    recordings = measured(ur_like(), poses(rng, 20, 6), far_away(rng), {"p": [0, 0, 0], "q": [0, 0, 0.1]})
    train, test = random_split(recordings, seed=4)
    expected = np.random.default_rng(4).permutation(20)[:14] + 1
    assert set(recordings.id[train].astype(int)) == set(expected)
    assert len(train) == 28
    assert not set(recordings.id[train]) & set(recordings.id[test])


@pytest.mark.shared
@pytest.mark.parametrize(
    ("name", "run", "seeds", "reference"),
    [
        ("irb120-offsets", "cal", 10, {"nominal": 6.48, "offsets": 0.76, "geometric": 0.34}),
        (
            "iiwa7-payload",
            "2016-11-18",
            5,
            {"nominal": 1.226, "offsets": 0.980, "geometric": 0.628, "compliance": 0.320},
        ),
        ("panda-charuco", "charuco", 10, {"nominal": 3.34, "offsets": 1.94, "geometric": 1.45}),
    ],
)
def test_held_out_figures_of_real_arms_are_the_reference_ones(name, run, seeds, reference):
    if not SHARED.is_dir():
        pytest.skip("../shared/recordings is not here, so there is nothing to compare with")
    arm = load_arm(ROOT / "config" / "recordings" / name / "robot.yaml")
    recordings = read_recordings(SHARED / name / "recordings.csv.gz")
    recordings = recordings.rows(recordings.run == run)
    priors = Priors(noise=1e-3) if name.startswith("panda") else Priors()
    found = held_out_levels(arm, recordings, seeds=range(seeds), priors=priors)
    assert {each.level: each.mean * 1e3 for each in found} == pytest.approx(reference, abs=0.006)
