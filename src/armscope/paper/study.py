"""A virtual study from its assumptions: what stands in for the lost robot, poses and paths, and what is measured.

Everything that the paper's text leaves open is a field of `StudyPlan`, so that each can be varied (`sensitivity`).
"""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from armscope.core.types import Array
from armscope.paper.virtual import (
    VirtualStudy,
    identification_poses,
    measure_virtual,
    paper_paths_mm,
    trajectory_poses,
)
from armscope.robot import Arm
from armscope.world.poses import Choice
from armscope.world.tolerances import GeometricErrors, geometric_errors
from armscope.world.tracker import Tracker

Point = tuple[float, float, float]


@dataclass(frozen=True)
class PlannedPaths:
    """The three test trajectories, mm; see `armscope.paper.virtual.paper_paths_mm`."""

    corners_mm: tuple[Point, Point, Point, Point]
    points_per_side: int
    spiral_starts_mm: tuple[Point, Point]
    enlargement_mm: float
    turns_pi: float
    spiral_points: int
    rise_mm: float

    def by_name(self) -> dict[str, Array]:
        """Name -> (N, 3) tool points in the base frame, mm."""
        return paper_paths_mm(
            self.corners_mm,
            self.points_per_side,
            self.spiral_starts_mm,
            self.enlargement_mm,
            self.turns_pi,
            self.spiral_points,
            self.rise_mm,
        )


@dataclass(frozen=True)
class PlannedPoses:
    """The identification poses; see `armscope.paper.virtual.identification_poses`."""

    count: int
    candidates: int
    margin_rad: float
    motor_6_rad: float


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
    """What a study assumes.

    Attributes:
        arm: nominal.
        sizes: of its geometric errors.
        paths, poses: where it is measured.
        tracker: what measures it.
        repeat_m: how well the arm itself repeats, 1-sigma per axis and point, m.
        ensemble: how many robots are drawn besides the anchored one.
        seed: of poses, noise and robots.
    """

    arm: Arm
    sizes: Sizes
    paths: PlannedPaths
    poses: PlannedPoses
    tracker: Tracker
    repeat_m: float
    ensemble: int
    seed: int

    @property
    def errors(self) -> GeometricErrors:
        """The possible geometric errors and their sizes."""
        return geometric_errors(
            self.arm, self.sizes.link_m, self.sizes.link_rad, self.sizes.base_m, self.sizes.base_rad
        )

    def follow(self) -> pd.DataFrame:
        """Pose table of the test paths.

        Raises:
            InputError: a point that can't be reached; it names arm, path, point and reason.
        """
        return trajectory_poses(self.arm, self.paths.by_name())


def measured(plan: StudyPlan) -> tuple[VirtualStudy, Choice]:
    """The robots of a plan, measured at its poses, and what the choice of the identification poses is worth.

    Raises:
        InputError: a path that can't be reached.
    """
    errors, trajectories, poses = plan.errors, plan.follow(), plan.poses
    identification, choice = identification_poses(
        errors, trajectories, poses.count, poses.candidates, poses.margin_rad, poses.motor_6_rad, plan.seed
    )
    at = pd.concat([identification, trajectories], ignore_index=True)
    return measure_virtual(errors, at, plan.tracker, plan.ensemble, plan.seed, plan.repeat_m), choice
