"""A robot arm as a MuJoCo mechanism: rigid bodies, hinges that stand somewhere, springs, bending segments.

This is the engine behind the concealed worlds. It shares no line with the kinematics or the loads that the diagnosis
uses: frames, Jacobians and generalised forces all come from MuJoCo.

An arm is written as an MJCF model in which joint j has, from the base outwards, whichever of these a world needs: three
slides and a tilt about x and y ("shift j x", "tilt j x": in the axes of the frame that carries the joint), a motor-side
spring about the axis, the hinge itself. A bending link is a row of segments with two hinges each. Springs are MuJoCo
joint springs; motor springs are fixed tendons over the chain's hinges, so that a parallelogram's motors feel what the
principle of virtual work gives them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import mujoco
import numpy as np

from armscope.core.types import Array
from armscope.robot.description import LinkMass, RobotDescription

SEGMENTS = 8
"""Segments of a bending link: the tip's deflection under an end load is 1 / (4 SEGMENTS^2) = 0.4 % below the beam's."""

BASE_FREEDOMS = ("base x", "base y", "base z", "base rx", "base ry", "base rz")
PEDESTAL = ("pedestal u", "pedestal v")
"""Hinges under the arm, level and square to each other, turned about z against the base's axes."""


@dataclass(frozen=True)
class Frame:
    """A fixed step along the chain: Trans(position) Rot(x, angle)."""

    position: Array
    turn_about_x: float

    def attributes(self) -> str:
        """MJCF position and orientation."""
        half = self.turn_about_x / 2
        return f'pos="{_numbers(self.position)}" quat="{_numbers([np.cos(half), np.sin(half), 0, 0])}"'


@dataclass(frozen=True)
class Layout:
    """What a mechanism is made of besides the nominal arm.

    Attributes:
        row_errors: (n, 4) added to a (m), alpha (rad), d (m), theta (rad) of the D-H rows.
        tool_error: (3,) added to the tool point, m.
        payload_offset: (3,) from the tool point to the payload's centre of mass, m, in the last frame.
        freedoms: small slides and hinges that exist, by name; the others are left out of the model.
        stiffness: N m/rad of the freedoms that are springs.
        motor_stiffness: N m/rad by motor (0-based), of motors that give way.
        flexibility: 1/(N m^2) by link (0-based): 1 / (E I) of links that bend.
        pedestal_turn: from the base's x axis to the pedestal's u axis, rad.
    """

    row_errors: Array
    tool_error: Array = field(default_factory=lambda: np.zeros(3))
    payload_offset: Array = field(default_factory=lambda: np.zeros(3))
    freedoms: frozenset[str] = frozenset()
    stiffness: Mapping[str, float] = field(default_factory=dict)
    motor_stiffness: Mapping[int, float] = field(default_factory=dict)
    flexibility: Mapping[int, float] = field(default_factory=dict)
    pedestal_turn: float = 0.0


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


class Mechanism:
    """A compiled arm; `qpos` columns are addressed by the names of hinges and slides.

    Args:
        geometry: the nominal arm.
        layout: what else it is made of.
    """

    def __init__(self, geometry: Geometry, layout: Layout) -> None:
        self.geometry, self.layout = geometry, layout
        self.rows = geometry.rows + layout.row_errors
        self.model = mujoco.MjModel.from_xml_string(_mjcf(geometry, layout, self.rows))
        self.data = mujoco.MjData(self.model)
        self.index = {self.model.joint(i).name: i for i in range(self.model.njnt)}
        self.tool_site = self.model.site("tool").id
        self._payload_body = self.model.body("payload").id

    @property
    def n_freedoms(self) -> int:
        """Number of hinges and slides."""
        return int(self.model.nq)

    def angle_columns(self) -> list[int]:
        """Columns of the chain's joint angles."""
        return [self.index[f"angle {j + 1}"] for j in range(self.geometry.n_joints)]

    def set_payload(self, mass: float) -> None:
        """Hang ``mass`` kg at the payload's place."""
        self.model.body_mass[self._payload_body] = mass
        mujoco.mj_setConst(self.model, self.data)

    def stand(self, qpos: Array) -> None:
        """Frames at ``qpos``."""
        self.data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)

    def load(self, qpos: Array) -> tuple[Array, Array]:
        """Generalised forces (gravity, springs) at ``qpos``, N m and N, each positive along its freedom."""
        self.stand(qpos)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_tendon(self.model, self.data)
        mujoco.mj_fwdVelocity(self.model, self.data)
        return -self.data.qfrc_bias, self.data.qfrc_passive

    def tool(self) -> Array:
        """Tool point (3,) in the base frame, m, at the last `stand` or `load`."""
        return np.array(self.data.site_xpos[self.tool_site])

    def tool_turn(self) -> Array:
        """(3, 3) orientation of the tool in the base frame at the last `stand` or `load`."""
        return np.array(self.data.site_xmat[self.tool_site]).reshape(3, 3)

    def tool_jacobian(self) -> Array:
        """(3, n_freedoms) displacement of the tool point per unit of each freedom, at the last `load`."""
        jacobian = np.zeros((3, self.model.nv))
        mujoco.mj_jacSite(self.model, self.data, jacobian, None, self.tool_site)
        return jacobian


def all_freedoms(n_joints: int) -> frozenset[str]:
    """The names of every small slide and hinge that a layout can ask for."""
    return frozenset(BASE_FREEDOMS) | {
        f"{kind} {j + 1} {axis}"
        for j in range(n_joints)
        for kind, axes in (("shift", "xyz"), ("tilt", "xy"))
        for axis in axes
    }


def segment_hinges(link: int) -> list[str]:
    """Names of the hinges inside a bending link (0-based)."""
    return [f"bend {link + 1} {part} {way}" for part in range(SEGMENTS) for way in "uv"]


def _mjcf(geometry: Geometry, layout: Layout, rows: Array) -> str:
    body = _chain(geometry, layout, rows)
    return (
        '<mujoco><compiler angle="radian" boundmass="1e-12" boundinertia="1e-12"/>'
        f'<option gravity="{_numbers(geometry.gravity)}"/>'
        # armature keeps the inertia matrix regular; it has no part in statics
        '<default><joint armature="1" limited="false"/></default>'
        f"<worldbody>{body}</worldbody>{_motor_springs(geometry, layout)}</mujoco>"
    )


def _chain(geometry: Geometry, layout: Layout, rows: Array) -> str:
    """Nested bodies from base to tool; opened on the way out, closed at the end."""
    parts = ['<body name="pedestal">', *(_freedom(layout, name) for name in PEDESTAL)]
    parts += ['<body name="base">', *(_freedom(layout, name) for name in BASE_FREEDOMS)]
    depth = 2
    springs = _sprung_hinges(geometry, layout)
    for j in range(geometry.n_joints):
        opened = 0
        bends = layout.flexibility.get(j)
        to_joint, to_link = geometry.step_to_joint(j, rows), geometry.step_to_link(j, rows)
        shifts = "".join(_freedom(layout, f"shift {j + 1} {axis}") for axis in "xyz")
        if bends is not None and geometry.modified:
            beam, opened = _beam(j, to_joint, bends)
            parts.append(beam)
        parts += [
            f'<body name="joint {j + 1}" {to_joint.attributes() if not opened else _last_step(to_joint)}>',
            shifts if geometry.modified else "",
            *(_freedom(layout, f"tilt {j + 1} {axis}") for axis in "xy"),
            f'<joint name="give {j + 1}" axis="0 0 1"/>' if j in springs else "",
            f'<joint name="angle {j + 1}" axis="0 0 1"/>',
        ]
        if bends is not None and not geometry.modified:
            beam, opened = _beam(j, to_link, bends)
            parts.append(beam)
        bent_here = bends is not None and not geometry.modified
        parts.append(f'<body name="link {j + 1}" {_last_step(to_link) if bent_here else to_link.attributes()}>')
        parts.append("" if geometry.modified else shifts)
        if geometry.links:
            parts.append(_mass_body(geometry.links[j]))
        depth += 2 + opened
    if geometry.tool_load is not None:
        parts.append(_mass_body(geometry.tool_load))
    tool = geometry.tool + layout.tool_error
    parts.append(f'<site name="tool" pos="{_numbers(tool)}"/>')
    # a token mass, so that the body exists; `set_payload` gives it its real one
    parts.append(
        f'<body name="payload" pos="{_numbers(geometry.tool + layout.payload_offset)}">'
        '<inertial pos="0 0 0" mass="1e-12" diaginertia="1e-12 1e-12 1e-12"/></body>'
    )
    return "".join(parts) + "</body>" * depth


def _freedom(layout: Layout, name: str) -> str:
    """MJCF of one slide or hinge, if the layout has it."""
    if name not in layout.freedoms:
        return ""
    axis = name.rsplit(" ", 1)[1]
    turns = name.startswith(("tilt", "pedestal")) or len(axis) == 2
    c, s = np.cos(layout.pedestal_turn), np.sin(layout.pedestal_turn)
    ways = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "u": (c, s, 0), "v": (-s, c, 0)}
    direction = _numbers(ways[axis[-1]])
    spring = f' stiffness="{float(layout.stiffness[name])!r}"' if name in layout.stiffness else ""
    return f'<joint name="{name}" type="{"hinge" if turns else "slide"}" axis="{direction}"{spring}/>'


def _sprung_hinges(geometry: Geometry, layout: Layout) -> set[int]:
    """Chain joints that turn when a motor that gives way does."""
    return {int(j) for m in layout.motor_stiffness for j in np.flatnonzero(geometry.actuation[:, m])}


def _motor_springs(geometry: Geometry, layout: Layout) -> str:
    if not layout.motor_stiffness:
        return ""
    to_motors = np.linalg.inv(geometry.actuation)
    hinges = sorted(_sprung_hinges(geometry, layout))
    tendons = []
    for motor, stiffness in sorted(layout.motor_stiffness.items()):
        joints = "".join(
            f'<joint joint="give {j + 1}" coef="{float(to_motors[motor, j])!r}"/>'
            for j in hinges
            if to_motors[motor, j] != 0
        )
        tendons.append(
            f'<fixed name="motor {motor + 1}" stiffness="{float(stiffness)!r}" springlength="0">{joints}</fixed>'
        )
    return f"<tendon>{''.join(tendons)}</tendon>"


def _beam(link: int, step: Frame, flexibility: float) -> tuple[str, int]:
    """Segments along the straight line to the link's end, each hinged in its middle; returns MJCF and bodies opened."""
    length = float(np.linalg.norm(step.position))
    direction = step.position / length
    u = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    u /= np.linalg.norm(u)
    v = np.cross(direction, u)
    piece = step.position / SEGMENTS
    stiffness = SEGMENTS / (length * flexibility)
    parts = []
    for part in range(SEGMENTS):
        at = piece / 2 if part == 0 else piece
        parts.append(f'<body name="segment {link + 1} {part}" pos="{_numbers(at)}">')
        for way, axis in (("u", u), ("v", v)):
            name = f"bend {link + 1} {part} {way}"
            parts.append(f'<joint name="{name}" axis="{_numbers(axis)}" stiffness="{float(stiffness)!r}"/>')
    return "".join(parts), SEGMENTS


def _last_step(step: Frame) -> str:
    """The half segment from the last hinge of a beam to the link's end, with the link's turn."""
    return Frame(step.position / (2 * SEGMENTS), step.turn_about_x).attributes()


def _mass_body(link: LinkMass) -> str:
    if link.mass_kg == 0:
        return ""
    place = _numbers(np.array(link.com_mm) * 1e-3)
    return f'<body><inertial pos="{place}" mass="{link.mass_kg!r}" diaginertia="1e-6 1e-6 1e-6"/></body>'


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
