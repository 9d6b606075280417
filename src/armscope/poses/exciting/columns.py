"""What a motion shows: the motors' torques per unit of every inertial and friction parameter, and per unit of a cause.

Inertial parameters are pinocchio's ten per link (mass, first moments, inertias about the joint's origin); torques of
motors follow from the chain's by virtual work through `actuation`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.poses.exciting.constants import DRIVES, SHOWING
from armscope.robot import Arm
from armscope.robot.dynamics import (
    attached_bodies,
    inertial_parameters,
    leaning_gravity,
    moved_centre,
    torque_regressor,
)

LINK_NAMES = ("mass", "m x", "m y", "m z", "I xx", "I xy", "I yy", "I xz", "I yz", "I zz")
JOINT_NAMES = ("offset", "Coulomb", "viscous", "rotor inertia")


@dataclass(frozen=True, eq=False)
class Motion:
    """N samples of m motors: rad, rad/s, rad/s^2; ``step``: s between them."""

    angle: Array
    speed: Array
    acceleration: Array
    step: float

    def sign(self) -> Array:
        """(N, m) of the speeds."""
        return np.tanh(self.speed / DRIVES.standstill_rad_s)


def link_columns(arm: Arm, motion: Motion) -> Array:
    """(N, m, 10 n) torque of the motors per unit of each inertial parameter."""
    return torque_regressor(arm.model, arm.actuation, (motion.angle, motion.speed, motion.acceleration))


def joint_columns(motion: Motion) -> Array:
    """(N, m, 4 m) torque per unit of offset, Coulomb, viscous friction and rotor inertia, motor by motor."""
    count = motion.angle.shape[1]
    found = np.zeros((len(motion.angle), count, 4 * count))
    patterns = (np.ones_like(motion.angle), motion.sign(), motion.speed, motion.acceleration)
    for motor in range(count):
        for number, pattern in enumerate(patterns):
            found[:, motor, 4 * motor + number] = pattern[:, motor]
    return found


def names(arm: Arm) -> list[str]:
    """Of the columns of `all_columns`."""
    links = [f"{name} of link {link + 1}" for link in range(arm.n_joints) for name in LINK_NAMES]
    return links + [f"{name} of joint {motor + 1}" for motor in range(arm.n_motors) for name in JOINT_NAMES]


def all_columns(arm: Arm, motion: Motion) -> Array:
    """(N, m, 10 n + 4 m) of links and joints."""
    return np.concatenate([link_columns(arm, motion), joint_columns(motion)], axis=2)


def stated_friction(arm: Arm) -> Array:
    """(4 m,) as `joint_columns`; zero where robot.yaml does not say."""
    found = np.zeros((arm.n_motors, 4))
    for motor, drive in enumerate(arm.description.drives or ()):
        found[motor, 1:] = [drive.coulomb_nm or 0, drive.viscous_nm_s_rad or 0, drive.rotor_inertia_kg_m2 or 0]
    return found.reshape(-1)


def cause_columns(arm: Arm, motion: Motion, links: Array, effect: str, location: str) -> Array | None:
    """Torque patterns of a cause at a place, to first order.

    Args:
        arm: the arm.
        motion: the motion.
        links: (N, m, 10 n) of `link_columns`.
        effect: name of a cause of arms in motion.
        location: its place.

    Returns:
        (N, m, k) torques; None of a cause without a law by which a motion could be planned.
    """
    where = Location.of(location)
    if effect == "joint_compliance":
        turns = where.kind == "joint" and not where.source and where.index < motion.angle.shape[1]
        return _behind_a_drive(arm, motion, links, where.index) if turns else None
    masses = _of_masses(arm, effect, where)
    if masses is not None:
        return links @ masses
    if effect == "gravity_direction":
        return _leaning(arm, motion)
    if (effect, location) == ("motor_constant", "every joint"):
        return (links @ inertial_parameters(arm.model))[:, :, None]
    if where.kind != "joint" or where.source:
        return None
    patterns = _joint_patterns(motion, links @ inertial_parameters(arm.model), where.index)
    if effect not in patterns:
        return None
    found = np.zeros((*motion.angle.shape, patterns[effect].shape[1]))
    found[:, where.index] = patterns[effect]
    return found


def _of_masses(arm: Arm, effect: str, where: Location) -> Array | None:
    """(10 n, k) inertial parameters that a cause is made of, as the diagnosis has it; None of other causes."""
    stated = inertial_parameters(arm.model)
    identity = np.eye(len(stated))
    if where.kind == "payload":
        return identity[:, -10:-6]
    if effect == "attached_body":
        body = dict(attached_bodies(arm.model)).get(where.kind)
        return None if body is None else body[:, None]
    if where.kind != "link" or where.index >= arm.n_joints:
        return None
    own = 10 * where.index + np.arange(10)
    if effect == "link_mass":  # heavier with its centre where it was
        return identity[:, own] @ stated[own, None] / stated[own[0]] if stated[own[0]] > 0 else identity[:, own[:4]]
    if effect == "link_first_moment":
        return identity[:, own] @ moved_centre(stated[own])
    return identity[:, own[4:]] if effect == "link_inertia" else None


def _leaning(arm: Arm, motion: Motion) -> Array | None:
    """(N, m, 2) torque per rad that the base leans, about two axes; None where gravity does not pull."""
    down, still = arm.model.gravity.linear, np.zeros_like(motion.angle)
    if not np.any(down):
        return None
    model, torques = arm.model.copy(), []
    for lean in leaning_gravity(down):
        model.gravity.linear = lean
        columns = torque_regressor(model, arm.actuation, (motion.angle, still, still))
        torques.append(columns @ inertial_parameters(arm.model))
    return np.stack(torques, axis=2)


def _behind_a_drive(arm: Arm, motion: Motion, links: Array, j: int) -> Array:
    """(N, m, 1) torque per unit of a drive's compliance: its link is where the motor is less compliance x its torque.

    To first order; the link's lag is derived as a wave that repeats, as the motions of the search do.
    """
    stated = inertial_parameters(arm.model)
    rigid = links @ stated
    waves = 2j * np.pi * np.fft.rfftfreq(len(rigid), motion.step)
    lag = [np.fft.irfft(waves**order * np.fft.rfft(rigid[:, j]), len(rigid)) for order in range(3)]
    moved = [np.array(each) for each in (motion.angle, motion.speed, motion.acceleration)]
    largest = [float(np.abs(each[:, j]).max()) for each in moved]
    unit = DRIVES.lag * min(
        most / max(float(np.abs(each).max()), SHOWING.nothing) for most, each in zip(largest, lag, strict=True)
    )
    for values, late in zip(moved, lag, strict=True):
        values[:, j] -= unit * late
    behind = torque_regressor(arm.model, arm.actuation, (moved[0], moved[1], moved[2])) @ stated
    found: Array = ((behind - rigid) / max(unit, SHOWING.nothing**2))[:, :, None]
    return found


def _joint_patterns(motion: Motion, rigid: Array, j: int) -> dict[str, Array]:
    speed, angle, sign = motion.speed[:, j], motion.angle[:, j], motion.sign()[:, j]
    centred = (angle - angle.mean()) / max(float(np.ptp(angle)) / 2, SHOWING.nothing)
    one = np.ones_like(angle)
    single = {
        "coulomb_friction": sign,
        "viscous_friction": speed,
        "asymmetric_friction": np.abs(speed),
        "stribeck_friction": np.exp(-((speed / DRIVES.stribeck_rad_s) ** 2)) * sign,
        "load_friction": np.abs(rigid[:, j]) * sign,
        "rotor_inertia": motion.acceleration[:, j],
        "torque_offset": one,
        "motor_constant": rigid[:, j],
        "torque_delay": -np.gradient(rigid[:, j], motion.step),
    }
    curves = {
        "gravity_balance": np.column_stack([one, angle]),
        "cable_torque": np.polynomial.chebyshev.chebvander(centred, DRIVES.curve_degree),
    }
    return {name: pattern[:, None] for name, pattern in single.items()} | curves
