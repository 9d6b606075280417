"""The arm in motion: torques that its masses ask for, and how they depend on every inertial parameter."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.robot.description_file import load_description
from armscope.robot.model import TIP, pinocchio_model

InertialName = Literal["m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"]
PARAMETERS: tuple[InertialName, ...] = get_args(InertialName)
"""Inertial parameters of a link about its joint's frame, in the order of pinocchio's regressor."""
UNITS = ("kg", *("kg m",) * 3, *("kg m^2",) * 6)


@dataclass(frozen=True, eq=False)
class MovingArm:
    """An arm of n chain joints moved by m motors, as inverse dynamics needs it; SI units (N where it slides)."""

    description: RobotDescription
    model: pin.Model  # the pinocchio model of the chain
    inertial: Array  # (10 n,) stated inertial parameters, `PARAMETERS` of each link
    actuation: Array  # (n, m) chain positions by motor positions
    sliding: NDArray[np.bool_]  # (m,) whether a motor's position is a length
    gains: Array  # (m,) N m per A; NaN where not stated
    gain_uncertainty: Array  # (m,) 1-sigma as a share; NaN where not stated
    # (m, 4) torque offset (always NaN), dry friction, viscous friction and rotor inertia of the drives, SI; NaN where
    # not stated
    stated_background: Array
    # bodies that are fixed to a moving link: name and (10 n,) inertial parameters of each
    attached: tuple[tuple[str, Array], ...] = ()

    @property
    def name(self) -> str:
        """The arm's name."""
        return self.description.name

    @property
    def n_links(self) -> int:
        """Number of moving links."""
        return len(self.inertial) // 10

    @property
    def n_motors(self) -> int:
        """Number of motors."""
        return int(self.actuation.shape[1])

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The chain's joints from the base to the tool."""
        return tuple(self.model.names)[1:]

    def point_load(self) -> Array:
        """(10 n,) inertial parameters of 1 kg at the tool point."""
        tip = self.model.frames[self.model.getFrameId(TIP)]
        at = tip.placement.act(np.array(self.description.tool_mm) * 1e-3)
        parameters = np.zeros(len(self.inertial))
        place = 10 * (tip.parentJoint - 1)
        parameters[place : place + 10] = pin.Inertia(1.0, at, np.zeros((3, 3))).toDynamicParameters()
        return parameters

    def in_tool_frame(self, at: Array) -> Array:
        """(3,) mm, of a point (3,), m, in the last joint's frame: as `tool_mm` states it."""
        tip = self.model.frames[self.model.getFrameId(TIP)]
        return np.asarray(tip.placement.actInv(at)) * 1e3

    def configurations(self, motors: Array) -> Array:
        """(N, nq) pinocchio configurations of motor positions (N, m)."""
        return configurations(self.model, motors @ self.actuation.T)

    def regressor(self, q: Array, dq: Array, ddq: Array) -> Array:
        """Torque of each motor per unit of each inertial parameter (Atkeson, An & Hollerbach 1986).

        Args:
            q: (N, m) motor positions.
            dq: (N, m) their velocities.
            ddq: (N, m) their accelerations.

        Returns:
            (N, m, 10 n) N m per SI unit.
        """
        return torque_regressor(self.model, self.actuation, (q, dq, ddq))

    def torques(self, q: Array, dq: Array, ddq: Array, inertial: Array) -> Array:
        """Torque of each motor by inverse dynamics with other inertial parameters than the stated ones.

        Args:
            q: (N, m) motor positions.
            dq: (N, m) their velocities.
            ddq: (N, m) their accelerations.
            inertial: (10 n,) of each link, `PARAMETERS`.

        Returns:
            (N, m) N m.
        """
        links = inertial.reshape(-1, 10)
        if not np.all(links[:, 0] > 0):  # no body has such parameters, but torque is linear in them
            return self.regressor(q, dq, ddq) @ inertial
        model = self.with_masses(inertial)
        data, configurations = model.createData(), self.configurations(q)
        v, a = dq @ self.actuation.T, ddq @ self.actuation.T
        moved = zip(configurations, v, a, strict=True)
        return (
            np.array([pin.rnea(model, data, *row).copy() for row in moved]).reshape(len(q), self.n_links)
            @ self.actuation
        )

    def with_masses(self, inertial: Array) -> pin.Model:
        """The model with other inertial parameters (10 n,) wherever a body can have them."""
        model = self.model.copy()
        for joint, parameters in enumerate(inertial.reshape(-1, 10), start=1):
            if parameters[0] > 0:
                model.inertias[joint] = pin.Inertia.FromDynamicParameters(parameters)
        return model

    def gravity_torques(self, q: Array, gravity: Array, inertial: Array | None = None) -> Array:
        """Torque of each motor that holds the links at rest.

        Args:
            q: (N, m) motor positions.
            gravity: (3,) m/s^2.
            inertial: (10 n,) of each link, `PARAMETERS`; the stated ones where not given.

        Returns:
            (N, m) N m.
        """
        model = self.model.copy() if inertial is None else self.with_masses(inertial)
        model.gravity.linear = gravity
        data, configurations = model.createData(), self.configurations(q)
        held = np.array([pin.computeGeneralizedGravity(model, data, each).copy() for each in configurations])
        return np.asarray(held @ self.actuation)


def configurations(model: pin.Model, chain: Array) -> Array:
    """(N, nq) pinocchio configurations of the chain's positions (N, n); a joint without limits has cosine and sine."""
    columns: list[Array] = []
    for joint in range(chain.shape[1]):
        turning = model.joints[joint + 1].nq == 2
        columns += [np.cos(chain[:, joint]), np.sin(chain[:, joint])] if turning else [chain[:, joint]]
    return np.column_stack(columns)


def torque_regressor(model: pin.Model, actuation: Array, motion: tuple[Array, Array, Array]) -> Array:
    """Torque of each motor per unit of each inertial parameter (Atkeson, An & Hollerbach 1986).

    Args:
        model: of the chain.
        actuation: (n, m) chain positions by motor positions.
        motion: (N, m) motor positions, velocities, accelerations.

    Returns:
        (N, m, 10 n) N m per SI unit.
    """
    data, (q, v, a) = model.createData(), (each @ actuation.T for each in motion)
    stored = configurations(model, q)
    torque = np.empty((len(q), len(actuation), 10 * len(actuation)))
    for row in range(len(q)):
        torque[row] = pin.computeJointTorqueRegressor(model, data, stored[row], v[row], a[row])
    if np.array_equal(actuation, np.eye(len(actuation))):
        return torque
    return np.asarray(np.einsum("njp,jm->nmp", torque, actuation))


def inertial_parameters(model: pin.Model) -> Array:
    """(10 n,) stated inertial parameters, `PARAMETERS` of each link."""
    return np.concatenate([model.inertias[joint].toDynamicParameters() for joint in range(1, model.njoints)])


def moved_centre(inertial: Array, by: Array | None = None) -> Array:
    """How a body's inertial parameters change as its centre of mass lies elsewhere, mass and inertia about it kept.

    The inertia about the joint changes with it (Huygens and Steiner): along its slope, or exactly at given moments.

    Args:
        inertial: (10,) `PARAMETERS` of the body; one without mass has no inertia to move.
        by: (3,) kg m by which the first moments change where columns times them are to be the whole change.

    Returns:
        (10, 3) per kg m of the first moments.
    """
    mass, moment = inertial[0], inertial[1:4] + (0.0 if by is None else by / 2)
    found = np.zeros((10, 3))
    found[1:4] = np.eye(3)
    if mass > 0:
        for axis, unit in enumerate(np.eye(3)):
            across = np.outer(moment, unit)
            bent = (2 * moment[axis] * np.eye(3) - across - across.T) / mass
            found[4:, axis] = bent[*np.array([[0, 0], [0, 1], [1, 1], [0, 2], [1, 2], [2, 2]]).T]
    return found


def leaning_gravity(down: Array) -> Array:
    """(2, 3) m/s^2 by which gravity ``down`` (3,), not zero, changes per rad about each of two axes across it."""
    level = np.linalg.svd(down[None] / np.linalg.norm(down))[2][1:]
    if abs(down[2]) == np.linalg.norm(down):
        level = np.eye(3)[:2]
    return np.asarray(-np.cross(level, down))


def load_moving_arm(path: Path | str) -> MovingArm:
    """The arm of a robot.yaml, for inverse dynamics. Raises InputError: the file can't be read, says something
    impossible, or states no masses."""
    return build_moving_arm(load_description(path), path)


def build_moving_arm(description: RobotDescription, source: Path | str = "robot.yaml") -> MovingArm:
    """The arm of a description. Raises InputError: it states no masses, or joints that are not possible."""
    model = pinocchio_model(description, sliding=True)
    n_links = model.njoints - 1
    masses = np.array([model.inertias[joint].mass for joint in range(1, model.njoints)])
    if not np.any(masses > 0):
        place = "links" if description.dh is not None else "urdf"
        rule = "inverse dynamics needs masses, centres of mass and inertias of the links"
        raise InputError(source, place, "no masses", rule, "State `links` (mass_kg, com_mm, inertia_kg_m2).")
    try:
        description.check_motors(n_links, "joints of the chain")
    except ValueError as error:
        raise InputError(source, "joints of the chain", ", ".join(list(model.names)[1:]), str(error)) from error
    actuation = description.actuation_matrix(n_links)
    slides = np.array([model.joints[joint].shortname().startswith("JointModelP") for joint in range(1, model.njoints)])
    drives = description.drives or ()
    none = np.full(actuation.shape[1], np.nan)
    return MovingArm(
        description=description,
        model=model,
        inertial=inertial_parameters(model),
        actuation=actuation,
        sliding=np.asarray((np.abs(actuation[slides]) > 0).any(axis=0)),
        gains=np.array([_known(drive.gain_nm_per_a) for drive in drives]) if drives else none,
        gain_uncertainty=np.array([_known(drive.gain_uncertainty) for drive in drives]) if drives else none,
        stated_background=np.array(
            [[np.nan, *map(_known, (d.coulomb_nm, d.viscous_nm_s_rad, d.rotor_inertia_kg_m2))] for d in drives]
        )
        if drives
        else np.full((actuation.shape[1], 4), np.nan),
        attached=attached_bodies(model),
    )


def attached_bodies(model: pin.Model) -> tuple[tuple[str, Array], ...]:
    """Bodies that fixed or locked joints hold to a moving link, each with what it carries. Returns name and (10 n,)
    inertial parameters, SI, in the frames of the links, of each."""
    found: dict[bytes, tuple[str, Array]] = {}
    for number, frame in enumerate(model.frames):
        if frame.type not in (pin.FrameType.FIXED_JOINT, pin.FrameType.JOINT) or frame.parentJoint == 0:
            continue
        if frame.name in list(model.names):
            continue
        carried = _carried(model, number)
        if carried.mass > 0:
            parameters = np.zeros(10 * (model.njoints - 1))
            place = 10 * (frame.parentJoint - 1)
            parameters[place : place + 10] = carried.toDynamicParameters()
            bodies = [f.name for f in model.frames if f.parentFrame == number and f.type == pin.FrameType.BODY]
            name = bodies[0] if bodies else frame.name
            found[np.round(parameters, 9).tobytes()] = (name, parameters)  # the innermost of frames that carry the same
    return tuple(found.values())


def _carried(model: pin.Model, number: int) -> pin.Inertia:
    """Inertia, in the joint's frame, of a frame and of all frames behind it."""
    frame = model.frames[number]
    whole = frame.placement.act(frame.inertia)
    for other, behind in enumerate(model.frames):
        if other != number and behind.parentFrame == number and behind.parentJoint == frame.parentJoint:
            whole = whole + _carried(model, other)
    return whole


def _known(value: float | None) -> float:
    return float("nan") if value is None else value
