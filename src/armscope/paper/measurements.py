"""What a study works on: for each set of poses the commanded angles, nominal positions and measured errors.

The errors are the paper's Eq. (8), measured minus nominal, in mm; angles in rad. Several robots may be measured at
the same poses (the anchored one and its ensemble); recordings of a real arm are a single robot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.errormodels.features import ModelSpec
from armscope.errormodels.swarm_fit import FitProblem
from armscope.paper.printed import IDENTIFICATION
from armscope.recordings.columns import AXES_MM, ERROR_COLUMNS, angle_columns


@dataclass(frozen=True, eq=False)
class PoseSet:
    """N poses of one trajectory, measured on R robots."""

    name: str  # "identification", "test 1", ..., or "held out" for real arms
    motor_angles: Array  # (N, m) commanded, rad
    nominal_mm: Array  # (N, 3) nominal tool points in the base frame, mm
    errors_mm: Array  # (R, N, 3) measured minus nominal, mm

    def inputs(self, spec: ModelSpec) -> Array:
        """What a model takes: nominal positions (N, 3) mm, or motor angles (N, m) rad."""
        return self.nominal_mm if spec.space == "cartesian" else self.motor_angles


@dataclass(frozen=True, eq=False)
class Measurements:
    """The sets of poses of a study; the first is the identification set."""

    robots: tuple[str, ...]
    sets: tuple[PoseSet, ...]

    def __getitem__(self, name: str) -> PoseSet:
        return next(each for each in self.sets if each.name == name)

    @property
    def identification(self) -> PoseSet:
        """The poses that models are fitted to."""
        return self[IDENTIFICATION]

    @property
    def held_out(self) -> tuple[PoseSet, ...]:
        """All other sets."""
        return tuple(each for each in self.sets if each.name != IDENTIFICATION)

    def fit_problems(self, specs: list[ModelSpec] | tuple[ModelSpec, ...], robots: list[str]) -> list[FitProblem]:
        """One problem per robot and model on the identification rows, labelled with the robot: for `fit_swarms`."""
        rows = self.identification
        return [
            FitProblem(spec, rows.inputs(spec), rows.errors_mm[self.robots.index(robot)], robot)
            for robot in robots
            for spec in specs
        ]

    def to_tables(self) -> tuple[pd.DataFrame, pd.DataFrame]:
        """(poses, errors): see `pose_table`; errors has columns robot, trajectory, point, dx_mm, dy_mm, dz_mm."""
        poses = pd.concat([pose_table(s.name, s.motor_angles, s.nominal_mm) for s in self.sets], ignore_index=True)
        keys = poses[["trajectory", "point"]]
        errors = np.concatenate([each.errors_mm for each in self.sets], axis=1)
        tables = [
            keys.assign(robot=robot, **dict(zip(ERROR_COLUMNS, errors[row].T, strict=True)))
            for row, robot in enumerate(self.robots)
        ]
        return poses, pd.concat(tables, ignore_index=True)[["robot", "trajectory", "point", *ERROR_COLUMNS]]

    @staticmethod
    def from_tables(poses: pd.DataFrame, errors: pd.DataFrame) -> Measurements:
        """The inverse of `to_tables`."""
        robots = tuple(str(name) for name in errors["robot"].unique())
        values = errors[ERROR_COLUMNS].to_numpy(dtype=float).reshape(len(robots), len(poses), 3)
        sets = []
        for name in poses["trajectory"].unique():
            rows = np.flatnonzero(poses["trajectory"] == name)
            angles, nominal = pose_arrays(poses.iloc[rows])
            sets.append(PoseSet(str(name), angles, nominal, values[:, rows]))
        return Measurements(robots, tuple(sets))


def pose_table(name: str, motor_angles: Array, nominal_mm: Array) -> pd.DataFrame:
    """Poses as a table: trajectory, point (from 1), q1_rad, ..., x_mm, y_mm, z_mm (nominal, base frame).

    Args:
        name: of the trajectory.
        motor_angles: (N, m) rad.
        nominal_mm: (N, 3) tool points in the base frame.

    Returns:
        The table.
    """
    columns = angle_columns(motor_angles) | dict(zip(AXES_MM, nominal_mm.T, strict=True))
    return pd.DataFrame({"trajectory": name, "point": np.arange(1, len(motor_angles) + 1), **columns})


def pose_arrays(poses: pd.DataFrame) -> tuple[Array, Array]:
    """(motor angles (N, m) rad, nominal positions (N, 3) mm) of a pose table."""
    motors = sum(name.startswith("q") and name.endswith("_rad") for name in poses.columns)
    angles = poses[[f"q{motor}_rad" for motor in range(1, motors + 1)]].to_numpy(dtype=float)
    return angles, poses[AXES_MM].to_numpy(dtype=float)
