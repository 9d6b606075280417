"""The stand-in for the lost robot: it moves as the paper says and agrees with what the paper prints."""

import numpy as np
import pandas as pd
import pytest

from armscope.core.inputs import InputError
from armscope.errormodels.features import FDP_CI
from armscope.paper.anchoring import anchor
from armscope.paper.measurements import Measurements, pose_arrays
from armscope.paper.printed import printed_matrix
from armscope.paper.virtual import PlannedPaths, trajectory_poses
from armscope.robot import forward_kinematics
from tests.paper.conftest import CORNERS_MM, ENSEMBLE, STARTS_MM


def test_trajectories_are_reached_with_the_wrist_held(arm, trajectories):
    angles, nominal = pose_arrays(trajectories)
    assert len(trajectories) == 600
    assert np.all(angles[:, 3:5] == 0)
    assert np.abs(forward_kinematics(arm, angles) * 1e3 - nominal).max() < 1e-5
    for _, rows in trajectories.groupby("trajectory"):
        assert np.abs(np.diff(pose_arrays(rows)[0], axis=0)).max() < 0.1


def test_an_unreachable_trajectory_is_one_error_that_names_it(arm):
    paths = PlannedPaths(CORNERS_MM, 50, STARTS_MM, 20, 5, 200, 6000).by_name()
    with pytest.raises(InputError, match=r"trajectory test 2: point \d+: found '.* mm: beyond reach'"):
        trajectory_poses(arm, paths)


def test_identification_poses_cover_the_joint_ranges_and_show_more_than_chance(identification, trajectories):
    poses, choice = identification
    angles, _ = pose_arrays(poses)
    used, _ = pose_arrays(trajectories)
    assert angles.shape == (85, 6)
    assert np.all(angles[:, 3:5] == 0)
    for motor in (0, 1, 2, 5):
        span = np.ptp(used[:, motor])
        assert angles[:, motor].min() < used[:, motor].min() + 0.05 * span
        assert angles[:, motor].max() > used[:, motor].max() - 0.05 * span
    assert choice.index > 1.1 * choice.random_index


def test_identification_uses_the_ranges_of_the_trajectories_and_no_more(errors, trajectories, identification):
    angles, _ = pose_arrays(identification[0])
    used, _ = pose_arrays(trajectories)
    for motor in (0, 1, 2):
        assert angles[:, motor].min() >= used[:, motor].min() - 0.1 - 1e-12
        assert angles[:, motor].max() <= used[:, motor].max() + 0.1 + 1e-12


def test_every_robot_s_least_squares_fit_is_the_printed_equations(study):
    rows = study.measurements.identification
    terms = FDP_CI.features(rows.nominal_mm).matrix(rows.nominal_mm)
    scale = np.linalg.norm(terms, axis=0)
    for errors_mm in rows.errors_mm:
        fitted = (np.linalg.lstsq(terms / scale, errors_mm, rcond=None)[0] / scale[:, None]).T
        assert np.abs(terms @ (fitted - printed_matrix("FDP(CI)")).T).max() < 1e-5
    assert len(rows.errors_mm) == 1 + ENSEMBLE


def test_the_anchored_robot_is_the_most_likely_one(study):
    squares = np.sum(study.robots.in_sigmas**2, axis=1)
    assert np.all(squares[1:] > squares[0])
    assert np.abs(study.robots.in_sigmas[0]).max() < 3  # tolerances explain the printed equations without strain


def test_the_anchored_robot_is_likelier_than_its_neighbours_that_agree_too(errors, study):
    """A minimum under constraints has no part in the directions that leave the fit unchanged."""
    anchored, *others = study.robots.in_sigmas
    for other in others:
        along = (other - anchored) / np.linalg.norm(other - anchored)
        assert abs(along @ anchored) < 0.1  # exactly 0 if the arm were linear in its errors


def test_the_ensemble_is_the_prior_conditioned_on_the_equations(errors, identification):
    """Of K standard normal errors, 12 combinations are fixed: K - 12 degrees of freedom are left to chance."""
    angles, _ = pose_arrays(identification[0])
    robots = anchor(errors, angles, np.zeros((85, 3)), 150, np.random.default_rng(5))
    free = robots.in_sigmas[1:] - robots.in_sigmas[0]
    expected = len(errors.names) - 12
    assert np.sum(free**2, axis=1).mean() == pytest.approx(expected, rel=0.1)
    assert robots.information.sum() == pytest.approx(12)
    assert free.std(axis=0) ** 2 == pytest.approx(1 - robots.information, abs=0.35)
    assert robots.disagreement_mm.max() < 1e-6


def test_a_prior_that_cannot_follow_says_so(identification, arm):
    from armscope.world.tolerances import geometric_errors

    angles, _ = pose_arrays(identification[0])
    wild = geometric_errors(arm, link_m=0.5, link_rad=1.0, base_m=1.0, base_rad=1.0)
    with pytest.raises(RuntimeError, match="anchoring stopped"):
        anchor(wild, angles, np.zeros((85, 3)), 5, np.random.default_rng(0))


def test_the_anchoring_table_has_units(study):
    table = study.robots.to_table().set_index("error")
    assert table.loc["a2", "unit"] == "mm"
    assert table.loc["alpha2", "unit"] == "mrad"
    assert table.loc["base x", "tolerance"] == pytest.approx(3)
    assert table.loc["a2", "anchored"] == pytest.approx(table.loc["a2", "anchored_in_sigmas"])
    assert table["information"].between(-1e-9, 1 + 1e-9).all()


def test_tables_and_back(study):
    poses, errors = study.measurements.to_tables()
    again = Measurements.from_tables(poses, errors)
    assert again.robots == study.measurements.robots
    for one, two in zip(again.sets, study.measurements.sets, strict=True):
        assert one.name == two.name
        assert np.array_equal(one.errors_mm, two.errors_mm)
        assert np.array_equal(one.motor_angles, two.motor_angles)


def test_equal_seeds_give_equal_measurements(errors, identification, trajectories, study):
    from armscope.paper.virtual import measure_virtual
    from armscope.world.of_the_paper import Tracker

    poses = pd.concat([identification[0], trajectories], ignore_index=True)
    again = measure_virtual(errors, poses, Tracker((4.0, 0.0, 1.5)), ENSEMBLE, seed=2)
    assert np.array_equal(again.measurements["test 3"].errors_mm, study.measurements["test 3"].errors_mm)
    other = measure_virtual(errors, poses, Tracker((4.0, 0.0, 1.5)), 1, seed=3)
    assert not np.array_equal(other.measurements["test 3"].errors_mm[0], study.measurements["test 3"].errors_mm[0])
