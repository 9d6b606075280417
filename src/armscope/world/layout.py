"""What a mechanism is made of: the nominal D-H arm, and the slides, hinges and springs that a world adds to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import LinkMass, RobotDescription

SEGMENTS = 8
"""Segments of a bending link: the tip's deflection under an end load is 1 / (4 SEGMENTS^2) = 0.4 % below the beam's."""
BASE_FREEDOMS = ("base x", "base y", "base z", "base rx", "base ry", "base rz")
TARGET_FREEDOMS = ("target x", "target y", "target z")  # Slides of the measured point along the last frame's axes
PEDESTAL = ("pedestal u", "pedestal v")
"""Hinges under the arm, level and square to each other, turned about z against the base's axes."""


@dataclass(frozen=True)
class Frame:
    """A fixed step along the chain: Trans(position) Rot(x, angle)."""

    position: Array
    turn_about_x: float


@dataclass(frozen=True)
class Layout:
    """What a mechanism is made of besides the nominal arm."""

    row_errors: Array  # (n, 4) added to a (m), alpha (rad), d (m), theta (rad) of the D-H rows
    tool_error: Array = field(default_factory=lambda: np.zeros(3))  # (3,) added to the tool point, m
    # (3,) from the tool point to the payload's centre of mass, m, in the last frame
    payload_offset: Array = field(default_factory=lambda: np.zeros(3))
    # small slides and hinges that exist, by name; the others are left out of the model
    freedoms: frozenset[str] = frozenset()
    stiffness: Mapping[str, float] = field(default_factory=dict)  # N m/rad of the freedoms that are springs
    # N m/rad by motor (0-based), of motors that give way
    motor_stiffness: Mapping[int, float] = field(default_factory=dict)
    # 1/(N m^2) by link (0-based): 1 / (E I) of links that bend
    flexibility: Mapping[int, float] = field(default_factory=dict)
    pedestal_turn: float = 0.0  # from the base's x axis to the pedestal's u axis, rad


class Geometry:
    """Numbers of a D-H arm, read from its description (SI units); n chain joints, m motors."""

    def __init__(self, description: RobotDescription) -> None:
        assert description.dh is not None, "worlds are made from D-H arms"
        assert not any(row.beta_deg for row in description.dh.joints), "worlds are made from plain D-H rows"
        self.modified = description.dh.convention == "modified"
        self.rows = np.array(
            [
                [row.a_mm * 1e-3, np.radians(row.alpha_deg), row.d_mm * 1e-3, np.radians(row.theta_offset_deg)]
                for row in description.dh.joints
            ]
        )
        self.n_joints = len(self.rows)
        self.n_motors = description.n_motors(self.n_joints)
        self.actuation = np.eye(self.n_joints)
        if description.actuation is not None:
            self.actuation = np.array(
                [[row.get(f"q{m + 1}", 0.0) for m in range(self.n_motors)] for row in description.actuation]
            )
        self.tool = np.array(description.tool_mm) * 1e-3
        self.gravity = np.array(description.gravity_m_s2, dtype=float)
        self.links: tuple[LinkMass, ...] = description.links or ()
        self.tool_load = description.tool_load

    def step_to_joint(self, j: int, rows: Array) -> Frame:
        """From link frame j-1 to the frame that carries joint j (0-based)."""
        a, alpha, d, _ = rows[j]
        if not self.modified:
            return Frame(np.zeros(3), 0.0)
        return Frame(np.array([a, -d * np.sin(alpha), d * np.cos(alpha)]), alpha)

    def step_to_link(self, j: int, rows: Array) -> Frame:
        """From the turned frame of joint j to link frame j, which is D-H frame j (0-based)."""
        a, alpha, d, _ = rows[j]
        if self.modified:
            return Frame(np.zeros(3), 0.0)
        return Frame(np.array([a, 0.0, d]), alpha)

    def lengthening(self, j: int, rows: Array) -> tuple[Array, Array]:
        """Directions, in the frame of "shift j", along which a and d of D-H row j grow."""
        alpha = rows[j, 1]
        along_d = np.array([0.0, np.sin(alpha), np.cos(alpha)])
        return np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]) if self.modified else along_d


def all_freedoms(n_joints: int) -> frozenset[str]:
    """The names of every small slide and hinge that a layout can ask for."""
    return frozenset(BASE_FREEDOMS + TARGET_FREEDOMS) | {
        f"{kind} {j + 1} {axis}"
        for j in range(n_joints)
        for kind, axes in (("shift", "xyz"), ("tilt", "xy"))
        for axis in axes
    }


def segment_hinges(link: int) -> list[str]:
    """Names of the hinges inside a bending link (0-based)."""
    return [f"bend {link + 1} {part} {way}" for part in range(SEGMENTS) for way in "uv"]
