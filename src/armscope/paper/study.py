"""A virtual study from its assumptions: what stands in for the lost robot, poses and paths, and what is measured.

Everything that the paper's text leaves open is a field of `StudyPlan`, so that each can be varied (`sensitivity`).
"""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from armscope.paper.identification_poses import ChosenPoses
from armscope.paper.virtual import (
    PlannedPaths,
    PlannedPoses,
    VirtualStudy,
    identification_poses,
    measure_virtual,
    trajectory_poses,
)
from armscope.robot import Arm
from armscope.world.tolerances import GeometricErrors, geometric_errors
from armscope.world.tracker import Tracker


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
