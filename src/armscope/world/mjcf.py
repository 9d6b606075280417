"""An arm written as an MJCF model.

Joint j has, from the base outwards, whichever of these a world needs: three slides and a tilt about x and y ("shift j
x", "tilt j x": in the axes of the frame that carries the joint), a motor-side spring about the axis, the hinge itself.
A bending link is a row of segments with two hinges each, over which its mass is spread. Springs are MuJoCo joint
springs; motor springs are fixed tendons over the chain's hinges, so that a parallelogram's motors feel what the
principle of virtual work gives them.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import LinkMass
from armscope.world.layout import BASE_FREEDOMS, PEDESTAL, SEGMENTS, TARGET_FREEDOMS, Frame, Geometry, Layout


def mjcf(geometry: Geometry, layout: Layout, rows: Array) -> str:
    """An arm as an MJCF model.

    Args:
        geometry: the nominal arm.
        layout: what else it is made of.
        rows: (n, 4) a (m), alpha (rad), d (m), theta (rad) of its D-H rows as they are.

    Returns:
        The model's XML.
    """
    body = _chain(geometry, layout, rows)
    return (
        '<mujoco><compiler angle="radian" boundmass="1e-12" boundinertia="1e-12"/>'
        f'<option gravity="{numbers(geometry.gravity)}"/>'
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
            own = _mass_from_root(geometry, j - 1, Frame(np.zeros(3), 0.0))
            beam, opened = _beam(j, to_joint, bends, own)
            parts.append(beam)
        parts += [
            f'<body name="joint {j + 1}" {placed(to_joint) if not opened else _last_step(to_joint)}>',
            shifts if geometry.modified else "",
            *(_freedom(layout, f"tilt {j + 1} {axis}") for axis in "xy"),
            f'<joint name="give {j + 1}" axis="0 0 1"/>' if j in springs else "",
            f'<joint name="angle {j + 1}" axis="0 0 1"/>',
        ]
        if bends is not None and not geometry.modified:
            beam, opened = _beam(j, to_link, bends, _mass_from_root(geometry, j, to_link))
            parts.append(beam)
        bent_here = bends is not None and not geometry.modified
        parts.append(f'<body name="link {j + 1}" {_last_step(to_link) if bent_here else placed(to_link)}>')
        parts.append("" if geometry.modified else shifts)
        if geometry.links and j + geometry.modified not in layout.flexibility:
            parts.append(_mass_body(geometry.links[j]))
        depth += 2 + opened
    if geometry.tool_load is not None:
        parts.append(_mass_body(geometry.tool_load))
    tool = geometry.tool + layout.tool_error
    parts.append(_target(layout, tool))
    # a token mass, so that the body exists; `set_payload` gives it its real one
    parts.append(
        f'<body name="payload" pos="{numbers(geometry.tool + layout.payload_offset)}">'
        '<inertial pos="0 0 0" mass="1e-12" diaginertia="1e-12 1e-12 1e-12"/></body>'
    )
    return "".join(parts) + "</body>" * depth


def _target(layout: Layout, tool: Array) -> str:
    """The point that is measured, on slides along the last frame's axes where it is loose."""
    slides = "".join(_freedom(layout, name) for name in TARGET_FREEDOMS)
    if not slides:
        return f'<site name="tool" pos="{numbers(tool)}"/>'
    inertia = '<inertial pos="0 0 0" mass="1e-12" diaginertia="1e-12 1e-12 1e-12"/>'
    return f'<body name="target" pos="{numbers(tool)}">{inertia}{slides}<site name="tool"/></body>'


def _freedom(layout: Layout, name: str) -> str:
    """MJCF of one slide or hinge, if the layout has it."""
    if name not in layout.freedoms:
        return ""
    axis = name.rsplit(" ", 1)[1]
    turns = name.startswith(("tilt", "pedestal")) or len(axis) == 2
    c, s = np.cos(layout.pedestal_turn), np.sin(layout.pedestal_turn)
    ways = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "u": (c, s, 0), "v": (-s, c, 0)}
    direction = numbers(ways[axis[-1]])
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


Point = tuple[float, Array]  # A mass, kg, and where it is, m


def _mass_from_root(geometry: Geometry, body: int, step: Frame) -> Point:
    """Mass and centre of a link (0-based), in the axes of the frame from which a step to its frame starts."""
    if not geometry.links or body < 0:
        return 0.0, np.zeros(3)
    c, s = np.cos(step.turn_about_x), np.sin(step.turn_about_x)
    centre = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array(geometry.links[body].com_mm) * 1e-3
    return geometry.links[body].mass_kg, step.position + centre


def _beam(link: int, step: Frame, flexibility: float, own: Point) -> tuple[str, int]:
    """Segments along the straight line to the link's end, each hinged in its middle; returns MJCF and bodies opened.

    The link's mass lies evenly on them, as far as its centre lets it; the rest is at the end that is nearer to that.
    """
    length = float(np.linalg.norm(step.position))
    direction = step.position / length
    u = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    u /= np.linalg.norm(u)
    v = np.cross(direction, u)
    piece = step.position / SEGMENTS
    stiffness = SEGMENTS / (length * flexibility)
    mass, centre = own
    along = float(centre @ direction)
    beside = centre - along * direction
    even = mass * max(0.0, 1 - abs(2 * along / length - 1))
    lump, at_root = mass - even, 2 * along < length
    parts = [_point((lump, beside - max(-along, 0.0) * direction)) if at_root else ""]
    for part in range(SEGMENTS):
        at = piece / 2 if part == 0 else piece
        parts.append(f'<body name="segment {link + 1} {part}" pos="{numbers(at)}">')
        parts.append(_point((even / SEGMENTS, beside)))
        for way, axis in (("u", u), ("v", v)):
            name = f"bend {link + 1} {part} {way}"
            parts.append(f'<joint name="{name}" axis="{numbers(axis)}" stiffness="{float(stiffness)!r}"/>')
    parts.append("" if at_root else _point((lump, piece / 2 + beside + max(along - length, 0.0) * direction)))
    return "".join(parts), SEGMENTS


def placed(step: Frame) -> str:
    """MJCF position and orientation of a body at the end of a step."""
    half = step.turn_about_x / 2
    return f'pos="{numbers(step.position)}" quat="{numbers([np.cos(half), np.sin(half), 0, 0])}"'


def _last_step(step: Frame) -> str:
    """The half segment from the last hinge of a beam to the link's end, with the link's turn."""
    return placed(Frame(step.position / (2 * SEGMENTS), step.turn_about_x))


def _mass_body(link: LinkMass) -> str:
    return _point((link.mass_kg, np.array(link.com_mm) * 1e-3))


def _point(point: Point) -> str:
    """A mass at a place of the body around it."""
    mass, place = point
    if mass == 0:
        return ""
    return f'<body><inertial pos="{numbers(place)}" mass="{float(mass)!r}" diaginertia="1e-6 1e-6 1e-6"/></body>'


def numbers(values: Iterable[float]) -> str:
    """Numbers as an attribute, with all their digits."""
    return " ".join(repr(float(value)) for value in values)
