"""Where the real arm goes: one interface to diagnosed physics, black-box error models and the nominal arm."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.compensation.black_box import ErrorModel
from armscope.core.types import Array, Indices
from armscope.physics.model import FittedModel
from armscope.recordings import Recordings
from armscope.robot import Arm, Chain, chain
from armscope.robot.kinematics import joint_jacobian

Rows = Indices


@dataclass(frozen=True, eq=False)
class ToolPose:
    """The tool at N commands, in base axes."""

    points: Array  # (N, 3) m
    rotations: Array  # (N, 3, 3) orientation of the last frame
    jacobian: Array  # (N, 6, m) displacement (m) and turn (rad) of the tool by unit turns of the motors


class Forward(Protocol):
    """An arm that can be commanded."""

    @property
    def arm(self) -> Arm:
        """The nominal arm."""

    def at(self, angles: Array, rows: Rows) -> ToolPose:
        """The tool at motor angles (N, m) rad for rows (N,) of the path: a row's context (load, ...) counts."""


@dataclass(frozen=True, eq=False)
class NominalArm:
    """The arm as its description says."""

    arm: Arm

    def at(self, angles: Array, rows: Rows) -> ToolPose:
        """See `Forward`."""
        frames = chain(self.arm, angles)
        return ToolPose(frames.tool, frames.tool_rotation, frame_jacobian(self.arm, frames))


@dataclass(frozen=True, eq=False)
class BlackBoxArm:
    """The nominal arm plus a fitted error of the tool point and, where it was measured, of the orientation."""

    model: ErrorModel

    @property
    def arm(self) -> Arm:
        """The nominal arm."""
        return self.model.arm

    def at(self, angles: Array, rows: Rows) -> ToolPose:
        """See `Forward`; the Jacobian is exact, but for half the product of the orientation's error and its slope."""
        frames = chain(self.arm, angles)
        error, slope = self.model.error_and_slope(angles, frames.tool)
        turn, turn_slope = self.model.turn_and_slope(angles, frames.tool)
        jacobian = frame_jacobian(self.arm, frames)
        slopes = np.concatenate([slope, turn_slope], axis=1)
        added = slopes @ jacobian[:, :3] if self.model.space == "cartesian" else slopes
        turned = Rotation.from_rotvec(turn).as_matrix()
        jacobian[:, 3:] = turned @ jacobian[:, 3:]
        return ToolPose(frames.tool + error, turned @ frames.tool_rotation, jacobian + added)


@dataclass(frozen=True, eq=False)
class PhysicalArm:
    """A diagnosed arm with all its effects in place, in the context of the path's rows."""

    model: FittedModel
    context: Recordings  # the path's rows: runs, targets, load, temperature, side of approach, ...
    as_measured: bool  # whether points are those that the instrument reads (its scale error included)

    @property
    def arm(self) -> Arm:
        """The nominal arm."""
        return self.model.arm

    def at(self, angles: Array, rows: Rows) -> ToolPose:
        """See `Forward`.

        The Jacobian is that of the deformed arm; how the deformation itself changes with the angles is left out: it is
        of the size of the errors, so Newton's method still gains about three digits per step.
        """
        posture = self.model.posture(self.model.scene(replace(self.context.rows(rows), motor_angles=angles)))
        jacobian = frame_jacobian(self.arm, posture.frames)
        if not self.as_measured:
            return ToolPose(posture.frames.tool, posture.frames.tool_rotation, jacobian)
        jacobian[:, :3] *= 1 + posture.stretch
        return ToolPose(posture.tool, posture.frames.tool_rotation, jacobian)


def frame_jacobian(arm: Arm, frames: Chain) -> Array:
    """(N, 6, m) displacement (m/rad) and turn (rad/rad) of the tool by unit turns of the motors, base axes."""
    turning = np.swapaxes(frames.joint_rotation[..., 2], 1, 2)
    return np.concatenate([joint_jacobian(frames), turning], axis=1) @ arm.actuation
