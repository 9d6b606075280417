"""The virtual SK120's measurements: test paths, identification poses, tracker, and the robots that are measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.config import Point
from armscope.core.types import Array
from armscope.paper.anchoring import AnchoredRobots, anchor
from armscope.paper.identification_poses import ChosenPoses, candidate_poses, choose_identification_poses, joint_ranges
from armscope.paper.measurements import Measurements, PoseSet, pose_arrays, pose_table
from armscope.paper.printed import IDENTIFICATION, TEST_TRAJECTORIES
from armscope.robot import Arm, chain, forward_kinematics
from armscope.robot.inverse import follow_path
from armscope.world.of_the_paper import Tracker, archimedes_spiral, rectangle
from armscope.world.tolerances import GeometricErrors, geometric_errors


@dataclass(frozen=True)
class Sizes:
    """One-sigma sizes of the geometric errors, m and rad."""

    link_m: float
    link_rad: float
    base_m: float
    base_rad: float

    def times(self, factor: float) -> Sizes:
        """All of them times a factor."""
        return Sizes(*(factor * size for size in (self.link_m, self.link_rad, self.base_m, self.base_rad)))


@dataclass(frozen=True, eq=False)
class StudyPlan:
    """What a study assumes."""

    arm: Arm
    sizes: Sizes  # of its geometric errors
    # paths, poses: where it is measured
    paths: PlannedPaths
    poses: PlannedPoses
    tracker: Tracker
    repeat_m: float  # how well the arm itself repeats, 1-sigma per axis and point, m
    ensemble: int  # how many robots are drawn besides the anchored one
    seed: int  # of poses, noise and robots

    @property
    def errors(self) -> GeometricErrors:
        """The possible geometric errors and their sizes."""
        return geometric_errors(
            self.arm, self.sizes.link_m, self.sizes.link_rad, self.sizes.base_m, self.sizes.base_rad
        )

    def follow(self) -> pd.DataFrame:
        """Pose table of the test paths. Raises InputError: a point that can't be reached; it names arm, path, point
        and reason."""
        return trajectory_poses(self.arm, self.paths.by_name())


def measured(plan: StudyPlan) -> tuple[VirtualStudy, ChosenPoses]:
    """The robots of a plan, measured at its poses, and what the choice of the identification poses is worth. Raises
    InputError: a path that can't be reached."""
    errors, trajectories = plan.errors, plan.follow()
    identification, choice = identification_poses(errors, trajectories, plan.poses, plan.seed)
    at = pd.concat([identification, trajectories], ignore_index=True)
    return measure_virtual(errors, at, plan.tracker, plan.ensemble, plan.seed, plan.repeat_m), choice


HELD = {4: 0.0, 5: 0.0}  # theta4 = theta5 = 0 throughout (below Eq. 14)


@dataclass(frozen=True, eq=False)
class VirtualStudy:
    """The anchored robot and its ensemble, measured."""

    robots: AnchoredRobots
    measurements: Measurements


@dataclass(frozen=True)
class PlannedPaths:
    """The three test trajectories (sections 7.1, 7.2), mm in the base frame."""

    corners_mm: tuple[Point, Point, Point, Point]  # of trajectory I, the first at (1100, 800, 600)
    points_per_side: int  # 50
    spiral_starts_mm: tuple[Point, Point]  # of II and III
    enlargement_mm: float  # W of Eqs. (21)-(22), 20
    turns_pi: float  # phi runs from 0 to this many times pi, 5
    spiral_points: int  # 200
    rise_mm: float  # change of the third coordinate (z of II, x of III) along the whole spiral

    def by_name(self) -> dict[str, Array]:
        """Name -> (N, 3) tool points in the base frame, mm."""
        (second, third), shape = self.spiral_starts_mm, (self.enlargement_mm, self.turns_pi, self.spiral_points)
        return {
            "test 1": rectangle(self.corners_mm, self.points_per_side),
            "test 2": archimedes_spiral(second, "xy", *shape, self.rise_mm),
            "test 3": archimedes_spiral(third, "yz", *shape, self.rise_mm),
        }


@dataclass(frozen=True)
class PlannedPoses:
    """The identification poses."""

    count: int  # 85
    candidates: int  # how many, spread evenly over the ranges, to choose from
    margin_rad: float  # by which the paths' joint ranges are widened to both sides
    motor_6_rad: float  # theta6 ranges over +- this instead (the paths hardly move it)


def trajectory_poses(arm: Arm, paths_mm: Mapping[str, Array]) -> pd.DataFrame:
    """The pose table (see `pose_table`) of paths followed with theta4 = theta5 = 0 and least motion, from angles 0.
    Raises InputError: a point that can't be reached; it names path, point and reason."""
    held = {motor: angle for motor, angle in HELD.items() if motor <= arm.n_motors}
    tables = []
    for name, path in paths_mm.items():
        solution = follow_path(arm, path * 1e-3, np.zeros(arm.n_motors), held)
        angles = solution.require_all(f"{arm.name}, trajectory {name}")
        tables.append(pose_table(name, angles, path))
    return pd.concat(tables, ignore_index=True)


def identification_poses(
    errors: GeometricErrors, trajectories: pd.DataFrame, planned: PlannedPoses, seed: int
) -> tuple[pd.DataFrame, ChosenPoses]:
    """Poses that cover the trajectories' joint ranges and show the geometric errors best.

    Args:
        errors: the geometric errors to be shown (`armscope.world.tolerances.geometric_errors`).
        trajectories: pose table of the test paths: only the range of each motor is taken from it.
        planned: how many, out of which.
        seed: of the candidates and of the random choices that the observability index is compared with.

    Returns:
        The pose table of "identification", and the choice with its observability index.
    """
    low, high = identification_ranges(errors, pose_arrays(trajectories)[0], planned)
    poses = candidate_poses(low, high, planned.candidates, seed)
    choice = choose_identification_poses(
        errors.jacobian(chain(errors.arm, poses)), planned.count, np.random.default_rng(seed)
    )
    chosen = poses[choice.rows]
    return pose_table(IDENTIFICATION, chosen, forward_kinematics(errors.arm, chosen) * 1e3), choice


def identification_ranges(errors: GeometricErrors, path_angles: Array, planned: PlannedPoses) -> tuple[Array, Array]:
    """(low, high) of the motors, (m,) rad: the ranges of the test paths (N, m), widened, theta6 by itself.

    Args:
        errors: the possible geometric errors, with their arm.
        path_angles: (N, m) rad along the test paths.
        planned: by how much the ranges are widened.

    Returns:
        Two arrays (m,), rad.
    """
    low, high = joint_ranges(path_angles, planned.margin_rad)
    if len(low) >= 6:
        low[5], high[5] = -planned.motor_6_rad, planned.motor_6_rad
    return np.maximum(low, errors.arm.limits[:, 0]), np.minimum(high, errors.arm.limits[:, 1])


def measure_virtual(
    errors: GeometricErrors, poses: pd.DataFrame, tracker: Tracker, ensemble: int, seed: int, repeat_m: float = 0.0
) -> VirtualStudy:
    """Anchor robots to the printed equations and measure them at all poses.

    Args:
        errors: the possible geometric errors.
        poses: pose table of "identification" and the test paths.
        tracker: measures each set of poses in a session of its own, with the same errors for every robot.
        ensemble: robots besides the anchored one.
        seed: of the tracker's errors and of the ensemble.
        repeat_m: how well the arm itself repeats, 1-sigma per axis and point, m.

    Returns:
        The robots and what was measured of them.
    """
    names = [IDENTIFICATION, *(name for name in TEST_TRAJECTORIES if name in set(poses["trajectory"]))]
    arrays = {name: pose_arrays(poses[poses["trajectory"] == name]) for name in names}
    for_tracker, for_ensemble, for_arm = np.random.default_rng(seed).spawn(3)
    noise = {
        name: tracker.measurement_errors(nominal * 1e-3, for_tracker)
        + repeat_m * for_arm.standard_normal(nominal.shape)
        for name, (_, nominal) in arrays.items()
    }
    robots = anchor(errors, arrays[IDENTIFICATION][0], noise[IDENTIFICATION], ensemble, for_ensemble)
    sets = []
    for name, (angles, nominal) in arrays.items():
        measured_mm = (errors.positions(angles, robots.in_sigmas) + noise[name]) * 1e3
        sets.append(PoseSet(name, angles, nominal, measured_mm - nominal))
    return VirtualStudy(robots, Measurements(robots.names, tuple(sets)))
