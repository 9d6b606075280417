"""The arm as arrays: what kinematics and loads need, taken once from its pinocchio model."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin

from armscope.core.inputs import InputError
from armscope.core.told import InWords
from armscope.core.types import Array
from armscope.core.words import size_of
from armscope.robot.arm_type import ArmType
from armscope.robot.constants import ARMS
from armscope.robot.description import RobotDescription
from armscope.robot.description_file import load_description
from armscope.robot.model import TIP, dh_halves, pinocchio_model


@dataclass(frozen=True, eq=False, repr=False)
class Arm(InWords):
    """An arm of n chain joints moved by m motors; SI units.

    The chain is ``prod_j [before_j * Rz(theta_j)] * tip * tool``, with theta = actuation @ q for motor angles q.
    """

    description: RobotDescription
    model: pin.Model  # the pinocchio model that all arrays below come from
    before: Array  # (n, 4, 4) from the turned frame of joint j-1 to the frame of joint j, whose z is the axis
    behind: Array  # (n, 4, 4) from the turned frame of joint j to link frame j (the D-H frame; identity for a URDF)
    tip: Array  # (4, 4) from the turned frame of the last joint to the last frame
    tool: Array  # (3,) nominal tool point in the last frame, m
    masses: Array  # (n,) kg, tool load included; zeros where the description has no masses (see `has_masses`)
    centres: Array  # (n, 3) centres of mass in the turned frames of the joints, m
    gravity: Array  # (3,) in the base frame, m/s^2
    actuation: Array  # (n, m) chain angles by motor angles
    limits: Array  # (m, 2) motor angles, rad; infinite where not stated
    sigma: float | None  # 1-sigma noise per axis, m; None where not stated
    type: ArmType = field(default_factory=ArmType)  # what other arms of its type have shown

    def sentences(self) -> tuple[str, ...]:
        """Motors, reach, what is stated of masses and noise, and who takes it."""
        rows = "D-H rows" if self.description.dh else f"a URDF up to {self.description.tip!r}"
        masses = "masses stated" if self.has_masses else "no masses stated"
        noise = "noise not stated" if self.sigma is None else f"noise {size_of(self.sigma, 'm')} per axis"
        return (
            f"{self.name}: an arm of {self.n_motors} motors from {rows}.",
            f"Reach {self.reach:.3g} m, {masses}, {noise}.",
            "Next: armscope.check, diagnose or calibrate (recordings, arm); armscope.choose_poses(arm).",
        )

    @property
    def name(self) -> str:
        """The arm's name."""
        return self.description.name

    @property
    def n_joints(self) -> int:
        """Number of joints of the chain."""
        return len(self.before)

    @property
    def n_motors(self) -> int:
        """Number of motor angles."""
        return int(self.actuation.shape[1])

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The chain's joints from the base to the tool, as the URDF calls them; "joint 1", ... for D-H rows."""
        return tuple(self.model.names)[1:]

    @property
    def has_masses(self) -> bool:
        """Whether any link's mass is stated: without, gravity loads are known up to unknown mass moments only.

        A payload alone is not the load: the arm weighs something, too.
        """
        return bool(np.any(self.masses > 0))

    @property
    def is_modified_dh(self) -> bool:
        """Whether the rows follow Craig's modified convention."""
        return self.description.dh is not None and self.description.dh.convention == "modified"

    @property
    def links_come_first(self) -> bool:
        """Whether link j stands before joint j, as in modified rows and in a URDF; else behind it."""
        return self.is_modified_dh or self.description.dh is None

    def step_along(self, link: int) -> Array:
        """(4, 4) the fixed step along a link (from 1), from the frame where it begins, m."""
        return np.asarray((self.before if self.links_come_first else self.behind)[link - 1])

    @functools.cached_property
    def reach(self) -> float:
        """An upper bound of the distance of the tool from the base's origin, m."""
        lengths = np.linalg.norm(self.before[:, :3, 3], axis=1).sum()
        return float(lengths + np.linalg.norm(self.tip[:3, 3]) + np.linalg.norm(self.tool))


def load_arm(path: Path | str) -> Arm:
    """The arm of a robot.yaml. Raises InputError: the file can't be read or says something impossible."""
    return build_arm(load_description(path))


def build_arm(description: RobotDescription) -> Arm:
    """The arm of a description."""
    model = pinocchio_model(description)
    n_joints = model.njoints - 1
    if n_joints > ARMS.most_joints:
        rule = f"motors are called q1 ... q{ARMS.most_joints}, and no chain of an arm is that long"
        raise InputError(description.urdf or description.name, "", f"{n_joints} joints in a chain", rule)
    if description.dh is None:
        _check_motors(description, model)
    before, axis_turns = _joint_frames(model)
    tip = model.frames[model.getFrameId(TIP)].placement.homogeneous
    return Arm(
        description=description,
        model=model,
        before=before,
        behind=_link_frames(description, n_joints),
        tip=_inverse_rotation(axis_turns[-1]) @ tip,
        tool=np.array(description.tool_mm) * 1e-3,
        masses=np.array([model.inertias[joint].mass for joint in range(1, model.njoints)]),
        centres=np.array(
            [axis_turns[joint][:3, :3].T @ model.inertias[joint].lever for joint in range(1, model.njoints)]
        ),
        gravity=np.array(description.gravity_m_s2, dtype=float),
        actuation=description.actuation_matrix(n_joints),
        limits=_limits(description, model),
        sigma=None if description.instrument is None else description.instrument.sigma_mm * 1e-3,
    )


def _check_motors(description: RobotDescription, model: pin.Model) -> None:
    try:
        description.check_motors(model.njoints - 1, "joints of the chain")
    except ValueError as error:
        chain = ", ".join(list(model.names)[1:])
        raise InputError(description.urdf, "joints of the chain", chain, str(error)) from error


def _joint_frames(model: pin.Model) -> tuple[Array, Array]:
    """(before, turns): joint placements with the axis along z, and the turn of each joint's frame that does it."""
    turns = np.tile(np.eye(4), (model.njoints, 1, 1))
    before = np.empty((model.njoints - 1, 4, 4))
    data = model.createData()
    pin.computeJointJacobians(model, data, pin.neutral(model))
    for joint in range(1, model.njoints):
        if model.parents[joint] != joint - 1:
            raise InputError(model.name, model.names[joint], "a branch", "the joints must form one chain")
        turns[joint, :3, :3] = _turn_to_z(_axis(model, data, joint))
        before[joint - 1] = (
            _inverse_rotation(turns[joint - 1]) @ model.jointPlacements[joint].homogeneous @ turns[joint]
        )
    return before, turns


def _axis(model: pin.Model, data: pin.Data, joint: int) -> Array:
    """Axis of a revolute joint in its own frame; ``data`` holds the Jacobians."""
    local = np.reshape(pin.getJointJacobian(model, data, joint, pin.ReferenceFrame.LOCAL), (6, model.nv))
    return np.asarray(local[3:, model.joints[joint].idx_v])


def _turn_to_z(axis: Array) -> Array:
    """The shortest rotation whose third column is ``axis``."""
    turn: Array = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), axis).toRotationMatrix()
    return turn


def _inverse_rotation(turn: Array) -> Array:
    return turn.T  # turns are pure rotations in homogeneous form


def _link_frames(description: RobotDescription, n_joints: int) -> Array:
    if description.dh is None:
        return np.tile(np.eye(4), (n_joints, 1, 1))
    return np.array([dh_halves(row, description.dh.convention)[1].homogeneous for row in description.dh.joints])


def _limits(description: RobotDescription, model: pin.Model) -> Array:
    n_motors = description.n_motors(model.njoints - 1)
    if description.joint_limits_deg is not None:
        return np.asarray(np.radians(description.joint_limits_deg))
    limits = np.tile([-np.inf, np.inf], (n_motors, 1))
    if description.urdf is None:
        return limits
    matrix = description.actuation_matrix(model.njoints - 1)
    for number, row in enumerate(matrix, start=1):
        joint, motors = model.joints[number], np.flatnonzero(row)
        # a joint without limits is stored as cosine and sine; one that several motors turn limits none of them
        if joint.nq == 1 and len(motors) == 1 and row[motors[0]] == 1:
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            if low < high:
                limits[motors[0]] = max(limits[motors[0], 0], low), min(limits[motors[0], 1], high)
    return limits
