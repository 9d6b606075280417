"""A moving arm as a MuJoCo mechanism: the torques that its motors must give for a given motion.

This engine shares no line with the inverse dynamics of the diagnosis. Rotor inertia is MuJoCo's `armature`, friction
its `frictionloss` and `damping`, a gravity balance a joint spring, a coupled wrist a fixed tendon over two joints.
MuJoCo's dry friction is a constraint: near standstill it grows with the speed instead of jumping, as real joints' does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry
from armscope.world.mjcf import numbers, placed

STIFF_FRICTION = 'solimpfriction="0.999 0.999 0.001" solreffriction="0.004 1"'
"""Dry friction that is fully there from about a milliradian per second on."""
LEAST = 1e-9  # Friction below this many N m is left out of the model
LEAST_INERTIA = 1e-12  # kg m^2: a point's, to an engine that allows no zero


@dataclass(frozen=True)
class Spring:
    """A spring about a joint (0-based): N m/rad, and the angle at which it does not pull, rad."""

    joint: int
    stiffness: float
    rest: float


@dataclass(frozen=True)
class Coupling:
    """A tendon of length q_joint + q_source (0-based) that rubs and has inertia: N m, N m s/rad, kg m^2."""

    joint: int
    source: int
    coulomb: float = 0.0
    viscous: float = 0.0
    inertia: float = 0.0


@dataclass(frozen=True, eq=False)
class Dynamics:
    """An arm's dynamics in numbers; n joints, each with a motor of its own."""

    mass: Array  # (n,) kg
    centre: Array  # (n, 3) centres of mass in the links' D-H frames, m
    inertia: Array  # (n, 6) xx, yy, zz, xy, xz, yz about the centres of mass in the same axes, kg m^2
    rotor: Array  # (n,) rotor inertia at the joint's side, kg m^2
    # coulomb, viscous: (n,) N m, N m s/rad
    coulomb: Array
    viscous: Array
    gravity: Array  # (3,) in the base frame, m/s^2
    # load, load_centre, load_inertia: a body, kg, where it is from the tool point, in the last frame, m, and its
    # inertia about any axis through its centre, kg m^2
    load: float = 0.0
    load_centre: Array | None = None
    load_inertia: float = 0.0
    springs: tuple[Spring, ...] = ()
    couplings: tuple[Coupling, ...] = ()

    @property
    def n_joints(self) -> int:
        """Number of joints."""
        return len(self.mass)

    def changed(self, what: str, joint: int, by: float | Array) -> Dynamics:
        """With one joint's or link's numbers changed.

        Args:
            what: name of the array.
            joint: which entry (0-based).
            by: what is added to it, in the array's unit.

        Returns:
            The other arm.
        """
        values = np.array(getattr(self, what))
        values[joint] += by
        changes: dict[str, Any] = {what: values}
        return replace(self, **changes)

    def without_friction(self) -> Dynamics:
        """The links alone: no friction, no rotors, no springs, no couplings."""
        zero = np.zeros(self.n_joints)
        return replace(self, rotor=zero, coulomb=zero, viscous=zero, springs=(), couplings=())


def stated_dynamics(description: RobotDescription) -> Dynamics:
    """What a robot.yaml with inertias and drives says."""
    assert description.links is not None, "moving worlds are made from arms with masses"
    assert description.drives is not None, "moving worlds are made from arms with drives"
    assert description.actuation is None, "moving worlds are made from arms with a motor in each joint"
    links, drives = description.links, description.drives
    return Dynamics(
        mass=np.array([link.mass_kg for link in links]),
        centre=np.array([link.com_mm for link in links]) * 1e-3,
        inertia=np.array([link.inertia_kg_m2 for link in links], dtype=float),
        rotor=np.array([drive.rotor_inertia_kg_m2 for drive in drives], dtype=float),
        coulomb=np.array([drive.coulomb_nm for drive in drives], dtype=float),
        viscous=np.array([drive.viscous_nm_s_rad for drive in drives], dtype=float),
        gravity=np.array(description.gravity_m_s2, dtype=float),
    )


class MovingArm:
    """A compiled arm.

    Args:
        geometry: its D-H rows and tool.
        dynamics: its masses, friction and the rest.

    Raises:
        ValueError: no body has these inertias.
    """

    def __init__(self, geometry: Geometry, dynamics: Dynamics) -> None:
        self.dynamics = dynamics
        self.model = mujoco.MjModel.from_xml_string(mjcf_of(geometry, dynamics))
        self.data = mujoco.MjData(self.model)

    def torques(self, angle: Array, speed: Array, acceleration: Array) -> Array:
        """The motors' torques for a motion.

        Args:
            angle: (N, n) rad.
            speed: (N, n) rad/s.
            acceleration: (N, n) rad/s^2.

        Returns:
            (N, n) N m.
        """
        model, data = self.model, self.data
        found = np.empty_like(angle)
        for row in range(len(angle)):
            data.qpos[:], data.qvel[:], data.qacc[:] = angle[row], speed[row], acceleration[row]
            mujoco.mj_inverse(model, data)
            found[row] = data.qfrc_inverse
        return found

    def energy(self, angle: Array, speed: Array) -> Array:
        """(N,) kinetic and potential energy, J."""
        found = np.empty(len(angle))
        for row in range(len(angle)):
            self.data.qpos[:], self.data.qvel[:] = angle[row], speed[row]
            mujoco.mj_forward(self.model, self.data)
            found[row] = self.data.energy.sum()
        return found


def mjcf_of(geometry: Geometry, dynamics: Dynamics) -> str:
    """The mechanism in MuJoCo's words: joints are called "joint 1" ..."""
    parts, depth = ["<body>"], 1
    for j in range(geometry.n_joints):
        to_joint, to_link = (placed(step(j, geometry.rows)) for step in (geometry.step_to_joint, geometry.step_to_link))
        parts.append(f"<body {to_joint}>{_joint(geometry, dynamics, j)}<body {to_link}>{_link(dynamics, j)}")
        depth += 3
    if dynamics.load:
        place = geometry.tool + (0 if dynamics.load_centre is None else dynamics.load_centre)
        body = f'diaginertia="{numbers(np.full(3, max(dynamics.load_inertia, LEAST_INERTIA)))}"'
        parts.append(f'<body><inertial pos="{numbers(place)}" mass="{float(dynamics.load)!r}" {body}/></body>')
    tendons = "".join(_tendon(number, coupling) for number, coupling in enumerate(dynamics.couplings))
    return (
        '<mujoco><compiler angle="radian"/>'
        f'<option gravity="{numbers(dynamics.gravity)}"><flag energy="enable" contact="disable"/></option>'
        f"<worldbody>{''.join(parts)}{'</body>' * depth}</worldbody>"
        f"{f'<tendon>{tendons}</tendon>' if tendons else ''}</mujoco>"
    )


def _joint(geometry: Geometry, dynamics: Dynamics, j: int) -> str:
    """Hinge j; MuJoCo's angle counts from the D-H row's theta offset, so that qpos is the motor's angle."""
    half = geometry.rows[j, 3] / 2
    turned = f'<body quat="{numbers([np.cos(half), 0, 0, np.sin(half)])}">'
    springs = [spring for spring in dynamics.springs if spring.joint == j]
    spring = f' stiffness="{springs[0].stiffness!r}" springref="{springs[0].rest!r}"' if springs else ""
    rubs = f' frictionloss="{float(dynamics.coulomb[j])!r}" {STIFF_FRICTION}' if dynamics.coulomb[j] > LEAST else ""
    attributes = f'armature="{float(dynamics.rotor[j])!r}" damping="{float(dynamics.viscous[j])!r}"{rubs}{spring}'
    return f'{turned}<joint name="joint {j + 1}" axis="0 0 1" {attributes}/>'


def _link(dynamics: Dynamics, j: int) -> str:
    place, inertia = numbers(dynamics.centre[j]), numbers(dynamics.inertia[j])
    return f'<inertial pos="{place}" mass="{float(dynamics.mass[j])!r}" fullinertia="{inertia}"/>'


def _tendon(number: int, coupling: Coupling) -> str:
    rubs = f' frictionloss="{coupling.coulomb!r}" {STIFF_FRICTION}' if coupling.coulomb > LEAST else ""
    joints = "".join(f'<joint joint="joint {j + 1}" coef="1"/>' for j in (coupling.joint, coupling.source))
    attributes = f'damping="{coupling.viscous!r}" armature="{coupling.inertia!r}"{rubs}'
    return f'<fixed name="coupling {number}" {attributes}>{joints}</fixed>'
