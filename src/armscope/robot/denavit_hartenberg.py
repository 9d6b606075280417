"""Denavit-Hartenberg rows: what a unit of each constant moves, and rows of any chain of hinges, as one from a URDF."""

from __future__ import annotations

import numpy as np
from pydantic import ValidationError

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.robot.arm import Arm
from armscope.robot.constants import AXIS
from armscope.robot.description import DH, DHRow, LinkMass, RobotDescription


def row_twist(arm: Arm, joint: int, kind: str) -> tuple[str, Array]:
    """Where a constant of a D-H row acts, and how: exact at any values of the row.

    Standard rows Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta): theta and d act along the joint's axis, a and alpha along
    the row's x axis, seen past the turn about y. Modified rows Rx(alpha) Tx(a) Ry(beta) Rz(theta) Tz(d) (Craig): a and
    alpha act along x of the frame before, beta about a point d behind the joint frame's origin.

    Args:
        arm: with D-H rows.
        joint: number of the row, from 1.
        kind: "a", "alpha", "d", "theta" or "beta".

    Returns:
        The frame, see `Chain.frame`, and (6,) the twist (translation, rotation) in its axes by a unit (m, rad).
    """
    assert arm.description.dh is not None
    twist = np.zeros(6)
    if kind in ("theta", "d"):
        twist[5 if kind == "theta" else 2] = 1.0
        return f"joint {joint}", twist
    row = arm.description.dh.joints[joint - 1]
    if kind == "beta":
        twist[4] = 1.0
        twist[0] = row.d_mm / 1e3 if arm.is_modified_dh else 0.0
        return f"joint {joint}" if arm.is_modified_dh else f"link {joint}", twist
    beta = 0.0 if arm.is_modified_dh else np.radians(row.beta_deg)
    twist[[0, 2] if kind == "a" else [3, 5]] = np.cos(beta), np.sin(beta)
    if arm.is_modified_dh:
        return f"link {joint - 1}" if joint > 1 else "base", twist
    return f"link {joint}", twist


def as_dh(arm: Arm) -> tuple[RobotDescription, Array]:
    """The same arm as standard D-H rows, tool and loads included.

    Every chain of hinges has such rows (Denavit & Hartenberg 1955), once the base frame may stand on the first axis.

    Returns:
        the description, and (4, 4) its base frame in the arm's own.

    Raises:
        InputError: two axes are so nearly parallel that their common normal is farther away than any arm reaches.
    """
    axes = _axes_at_zero(arm)
    frames = [axes[0]]
    rows = []
    for joint, axis in enumerate(axes[1:], start=1):
        try:
            row, frame = _row(frames[-1], axis)
        except ValidationError as error:
            lengths = [str(each["input"]) for each in error.errors()]
            rule = "axes so nearly parallel have their common normal farther away than a D-H row may be long"
            cure = "Keep the URDF, or make the two axes exactly parallel."
            raise InputError(arm.name, f"joints {joint} and {joint + 1}", ", ".join(lengths), rule, cure) from error
        rows.append(row)
        frames.append(frame)
    # the last frame may be any on the last axis: the one that turns with it
    rows.append(DHRow(a_mm=0, alpha_deg=0, d_mm=0))
    links = [
        _in_frame(frame, axis, mass, centre)
        for frame, axis, mass, centre in zip([*frames[1:], frames[-1]], axes, arm.masses, arm.centres, strict=True)
    ]
    tip = axes[-1] @ arm.tip @ np.append(arm.tool, 1.0)
    base = frames[0]
    description = arm.description.model_copy(
        update={
            "dh": DH(joints=tuple(rows)),
            "urdf": None,
            "tip": None,
            "hold_joints": {},
            "tool_mm": _triple((np.linalg.inv(frames[-1]) @ tip)[:3] * 1e3),
            "links": tuple(links) if arm.has_masses else None,
            "tool_load": None,
            "gravity_m_s2": _triple(base[:3, :3].T @ arm.gravity),
            "joint_limits_deg": _limits(arm),
        }
    )
    return description, base


def _axes_at_zero(arm: Arm) -> list[Array]:
    """Frames of the joints with all angles zero, in the arm's base; z is the axis."""
    frames, frame = [], np.eye(4)
    for step in arm.before:
        frame = frame @ step
        frames.append(frame)
    return frames


def _row(frame: Array, axis: Array) -> tuple[DHRow, Array]:
    """The row from a frame on one axis to the frame that it leads to on the next axis."""
    origin, z, x = frame[:3, 3], frame[:3, 2], frame[:3, 0]
    point, next_z = axis[:3, 3], axis[:3, 2]
    normal = np.cross(z, next_z)
    sine = np.linalg.norm(normal)
    if sine < AXIS.parallel:
        away = point - origin - ((point - origin) @ z) * z
        length = np.linalg.norm(away)
        next_x = away / length if length > AXIS.parallel else x
        d = 0.0
        next_origin = origin + away
    else:
        next_x = normal / sine
        # z d + next_x a - next_z s = point - origin
        d, a = np.linalg.solve(np.column_stack([z, next_x, -next_z]), point - origin)[:2]
        if a < -AXIS.parallel:
            next_x, a = -next_x, -a
        next_origin = origin + d * z + a * next_x
    a = (next_origin - origin - d * z) @ next_x
    next_y = np.cross(next_z, next_x)
    reached = np.eye(4)
    reached[:3, :3], reached[:3, 3] = np.column_stack([next_x, next_y, next_z]), next_origin
    theta = np.degrees(np.arctan2(np.cross(x, next_x) @ z, x @ next_x))
    alpha = np.degrees(np.arctan2(np.cross(z, next_z) @ next_x, z @ next_z))
    row = DHRow(a_mm=float(a * 1e3), alpha_deg=float(alpha), d_mm=float(d * 1e3), theta_offset_deg=float(theta))
    return row, reached


def _in_frame(frame: Array, axis: Array, mass: float, centre: Array) -> LinkMass:
    """A link's mass with its centre in a D-H frame instead of the joint's."""
    moved = np.linalg.inv(frame) @ axis @ np.append(centre, 1.0)
    return LinkMass(mass_kg=float(mass), com_mm=_triple(moved[:3] * 1e3))


def _limits(arm: Arm) -> tuple[tuple[float, float], ...] | None:
    if not np.isfinite(arm.limits).all():
        return None
    low, high = np.degrees(arm.limits).T
    return tuple((float(a), float(b)) for a, b in zip(low, high, strict=True))


def _triple(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z
