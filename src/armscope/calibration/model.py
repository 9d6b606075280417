"""One set-up: rows of measurements, their base frames and tools, the arm's constants; residuals and exact columns."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from armscope.calibration.geometry import (
    Constant,
    Posed,
    State,
    constant_columns,
    constants_of,
    corrected,
    turn_columns,
)
from armscope.core.grouping import by_label
from armscope.core.types import Array, Indices
from armscope.fitting.placement import frame_columns
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain, position_jacobian
from armscope.robot.gravity import gravity_torques

Level = Literal["nominal", "offsets", "geometric", "compliance"]
GRAVITY = "gravity of the mass table"
LEVELS: tuple[Level, ...] = ("nominal", "offsets", "geometric", "compliance")
"""What is free beyond base and tool: nothing; each joint's zero; all constants; and one compliance per motor."""


@dataclass(frozen=True, eq=False)
class SetUp:
    """What is fitted to what."""

    arm: Arm
    angles: Array  # (N, m) rad
    measured: Array  # (N, 3) m
    # base, tool: (N,) number of each row's base frame and tool
    base: Indices
    tool: Indices
    # base_names, tool_names: what these are called
    base_names: tuple[str, ...]
    tool_names: tuple[str, ...]
    constants: tuple[Constant, ...]  # the arm's constants
    # (N, m) N m, torque that turns each motor, recorded or from the mass table; None if neither is known
    loads: Array | None
    load_source: str  # "recorded torques", "gravity of the mass table" or ""
    # (N, 3, 3) measurement frame from tool frame, NaN where not measured; None uses positions only
    orientations: Array | None = None
    lever: float = 0.0  # m/rad, by which an orientation error counts beside a position error

    def __len__(self) -> int:
        return len(self.angles)

    @property
    def names(self) -> tuple[str, ...]:
        """Every parameter's name, in the order of columns and steps."""
        axes = ("x", "y", "z", "rx", "ry", "rz")
        base = [f"base{_of(name)} {axis}" for name in self.base_names for axis in axes]
        tool = [f"tool{_of(name)} {axis}" for name in self.tool_names for axis in "xyz"]
        motors = range(1, self.arm.n_motors + 1)
        turns = [f"tool{_of(name)} {axis}" for name in self.tool_names for axis in axes[3:]]
        compliances = [f"joint {j} compliance" for j in motors]
        return (*base, *tool, *(each.name for each in self.constants), *compliances, *turns)

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each parameter: m, rad or rad/(N m)."""
        base = ["m"] * 3 + ["rad"] * 3
        compliances = ["rad/(N m)"] * self.arm.n_motors
        tools, turns = ([unit] * 3 * len(self.tool_names) for unit in ("m", "rad"))
        constants = [each.unit for each in self.constants]
        return (*(base * len(self.base_names)), *tools, *constants, *compliances, *turns)

    @property
    def tiers(self) -> Indices:
        """Order of preference where parameters imitate each other.

        Bases, tools, compliances, joint zeros, the rest of the arm, turns about y: what a user can act upon comes
        first, and a tool point is stated where a base is not.
        """
        frames = [-1] * 6 * len(self.base_names) + [0] * 3 * len(self.tool_names)
        arm = [2 if constant.is_zero_offset else 4 if constant.kind == "beta" else 3 for constant in self.constants]
        return np.array(frames + arm + [1] * self.arm.n_motors + [0] * 3 * len(self.tool_names))

    def free(self, level: Level) -> NDArray[np.bool_]:
        """Which parameters a level lets free, identifiable or not."""
        n_frames = 6 * len(self.base_names) + 3 * len(self.tool_names)
        arm = [
            level in ("geometric", "compliance") or (level == "offsets" and constant.is_zero_offset)
            for constant in self.constants
        ]
        compliances = [level == "compliance" and self.loads is not None] * self.arm.n_motors
        turns = [self.orientations is not None] * 3 * len(self.tool_names)
        return np.array([True] * n_frames + arm + compliances + turns)

    def rows(self, which: NDArray[np.bool_] | Indices) -> SetUp:
        """The set-up with some of its rows; frames and names stay."""
        loads = None if self.loads is None else self.loads[which]
        return replace(
            self,
            angles=self.angles[which],
            measured=self.measured[which],
            base=self.base[which],
            tool=self.tool[which],
            loads=loads,
            orientations=None if self.orientations is None else self.orientations[which],
        )

    def frames(self, state: State) -> tuple[Arm, Chain]:
        """The corrected arm and its frames, the tool points those of each row's tool."""
        arm, frames = self.arm, self.nominal_frames
        if state.constants.any() or state.compliances.any():
            arm = corrected(self.arm, self.constants, state.constants)
            loads = 0.0 if self.loads is None else self.loads
            frames = chain(arm, self.angles + loads * state.compliances)
        offset = state.tools[self.tool] - arm.tool
        return arm, replace(frames, tool=frames.tool + np.einsum("nij,nj->ni", frames.tool_rotation, offset))

    @functools.cached_property
    def nominal_frames(self) -> Chain:
        """Of the nominal arm: finding base and tool moves no joint: the nominal arm's frames serve every step."""
        return chain(self.arm, self.angles)

    def residuals(self, state: State) -> Array:
        """(N, 3) measured minus predicted, in the measurement frame, m."""
        _, frames = self.frames(state)
        return self.measured - self._in_measured(state, frames)

    def predicted(self, state: State) -> Array:
        """(N, 3) predicted points in the measurement frame, m."""
        return self._in_measured(state, self.frames(state)[1])

    def _in_measured(self, state: State, frames: Chain) -> Array:
        turned: Array = np.einsum("nij,nj->ni", state.rotations[self.base], frames.tool)
        return turned + state.translations[self.base]

    def turn_residuals(self, state: State) -> Array:
        """(N, 3) rotation vectors from predicted to measured orientation, arm base axes, rad; 0 where not measured."""
        return self._turn_residuals(state, self.frames(state)[1])

    def _turn_residuals(self, state: State, frames: Chain) -> Array:
        from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

        assert self.orientations is not None
        known = np.isfinite(self.orientations).all(axis=(1, 2))
        seen = np.swapaxes(state.rotations[self.base[known]], 1, 2) @ self.orientations[known]
        expected = frames.tool_rotation[known] @ state.tool_rotations[self.tool[known]]
        turns = np.zeros((len(self), 3))
        turns[known] = Rotation.from_matrix(seen @ np.swapaxes(expected, 1, 2)).as_rotvec()
        return turns

    def posed(self, state: State) -> Posed:
        """The arm at a state, and what that leaves."""
        arm, frames = self.frames(state)
        back = np.swapaxes(state.rotations[self.base], 1, 2)
        left = np.einsum("nij,nj->ni", back, self.measured - state.translations[self.base]) - frames.tool
        if self.orientations is not None:
            left = np.concatenate([left, self.lever * self._turn_residuals(state, frames)], axis=1)
        return Posed(arm, frames, left)

    def jacobian(self, state: State, posed: Posed, free: NDArray[np.bool_]) -> Array:
        """Columns of the prediction at a state.

        Args:
            state: values of everything.
            posed: the arm there, see `posed`.
            free: (P,) which parameters' columns.

        Returns:
            (cN, free), m per unit of each parameter, in the axes of each row's arm base.
        """
        arm, frames = posed.arm, posed.frames
        counts = len(self.base_names), len(self.tool_names)
        n_frames = 6 * counts[0] + 3 * counts[1]
        columns = np.zeros((len(self), 3, len(free)))
        columns[:, :, :n_frames] = frame_columns(frames.tool, frames.tool_rotation, self.base, self.tool, counts)
        chosen = np.flatnonzero(free[n_frames : n_frames + len(self.constants)])
        columns[:, :, n_frames + chosen] = constant_columns(arm, frames, tuple(self.constants[each] for each in chosen))
        motors = slice(n_frames + len(self.constants), n_frames + len(self.constants) + arm.n_motors)
        if self.loads is not None and free[motors].any():
            columns[:, :, motors] = position_jacobian(arm, frames) * self.loads[:, None, :]
        columns = columns[:, :, free]
        if self.orientations is not None:
            turned = self._turn_columns(arm, frames, state)[:, :, free]
            columns = np.concatenate([columns, self.lever * turned], axis=1)
        return columns.reshape(posed.left.size, -1)

    def linearised(self, state: State, free: NDArray[np.bool_]) -> tuple[Array, Array]:
        """Residuals (cN,) and the columns (cN, free) of the prediction, both in the axes of each row's arm base.

        Each row has c = 3 numbers, or 6 where orientations are used: the position, and the turn times the lever.
        """
        posed = self.posed(state)
        return posed.left.ravel(), self.jacobian(state, posed, free)

    def _turn_columns(self, arm: Arm, frames: Chain, state: State) -> Array:
        """(N, 3, P) turn of the tool by a unit of each parameter, arm base axes; 0 where not measured."""
        assert self.orientations is not None
        n_rows, n_bases, n_constants = len(self), len(self.base_names), len(self.constants)
        n_frames = 6 * n_bases + 3 * len(self.tool_names)
        jacobian = np.zeros((n_rows, 3, len(self.names)))
        rows, expected = np.arange(n_rows), frames.tool_rotation @ state.tool_rotations[self.tool]
        for axis in range(3):
            jacobian[rows, axis, 6 * self.base + 3 + axis] = 1.0
            for tool_axis in range(3):
                column = n_frames + n_constants + arm.n_motors + 3 * self.tool + tool_axis
                jacobian[rows, axis, column] = expected[:, axis, tool_axis]
        jacobian[:, :, n_frames : n_frames + n_constants] = turn_columns(arm, frames, self.constants)
        if self.loads is not None:
            axes = np.swapaxes(frames.joint_rotation[..., 2], 1, 2) @ arm.actuation
            jacobian[:, :, n_frames + n_constants : -3 * len(self.tool_names)] = axes * self.loads[:, None, :]
        jacobian[~np.isfinite(self.orientations).all(axis=(1, 2))] = 0.0
        return jacobian


def _of(name: str) -> str:
    return f" of {name}" if name else ""


def set_up(
    arm: Arm, recordings: Recordings, one_base: bool = False, tool_per_run: bool = False, orientation: bool = False
) -> SetUp:
    """Recordings as a set-up of base frames (one per run) and tools (one per target).

    Args:
        arm: the nominal arm.
        recordings: measured points.
        one_base: one base frame for all runs, where nothing was moved between them.
        tool_per_run: a tool of its own for every run, where it was taken off in between.
        orientation: use measured orientations, where the table has them.

    Returns:
        Rows with their frames' numbers, poses and loads.

    Raises:
        InputError: another number of motors than the arm has.
    """
    recordings.check_motors(arm.name, arm.n_motors)
    base_names, base = by_label(np.full(len(recordings), "") if one_base else recordings.run)
    labels = recordings.target
    if tool_per_run:
        joined = [" in ".join(filter(None, pair)) for pair in zip(recordings.target, recordings.run, strict=True)]
        labels = np.array(joined)
    tool_names, tool = by_label(labels)
    loads, load_source = _loads(arm, recordings)
    return SetUp(
        arm=arm,
        angles=recordings.motor_angles,
        measured=recordings.positions,
        base=base,
        tool=tool,
        base_names=base_names,
        tool_names=tool_names,
        constants=constants_of(arm),
        loads=loads,
        load_source=load_source,
        orientations=_matrices(recordings.orientation) if orientation else None,
    )


def _matrices(quaternions: Array | None) -> Array | None:
    """(N, 3, 3) from (N, 4) wxyz, NaN where not measured; None without any."""
    if quaternions is None:
        return None
    from scipy.spatial.transform import Rotation  # slow to import, and few tables hold orientations

    known = np.isfinite(quaternions).all(axis=1)
    matrices = np.full((len(quaternions), 3, 3), np.nan)
    matrices[known] = Rotation.from_quat(quaternions[known], scalar_first=True).as_matrix()
    return matrices


def _loads(arm: Arm, recordings: Recordings) -> tuple[Array | None, str]:
    """Recorded torques where they are complete, otherwise gravity of the mass table."""
    if recordings.torque is not None and np.isfinite(recordings.torque).all():
        return recordings.torque, "recorded torques"
    if arm.has_masses:
        frames = chain(arm, recordings.motor_angles)
        return gravity_torques(arm, frames, recordings.payload), GRAVITY
    return None, ""
