"""The error field as a figure that a person turns: points, errors by model and stage, and the arm in every pose.

The page carries the numbers and a script that draws them on a plain 2D canvas (templates/error_field.js): no WebGL,
which remote desktops and old machines lack, and no library to ship.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from armscope.core.location import Location
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array
from armscope.report.colours import NOTHING, SHARES, SIGNED, between, darker, scale_end
from armscope.report.figures.arm_shape import arm_shape, shares_by_place, typical_pose, upright
from armscope.robot import Arm, Chain, chain

MOST_ROWS = 12_000  # A page carries no more; of longer tables so many rows, spread evenly, and all suspects
SHADES = 33
FAINTEST = 0.14  # Where the scale of sizes starts: dots must be seen on paper
NAMED_SHARE = 0.005


@dataclass(frozen=True, eq=False)
class ErrorField:
    """N points of an arm and the errors there."""

    points_mm: Array  # (N, 3) tool points, base axes
    motor_angles: Array  # (N, m) rad: the pose that the arm takes when a point is chosen
    ids: Sequence[str]  # (N) what the rows are called
    groups: Sequence[str]  # (N) the trajectory or run of each row
    group_word: str
    row_word: str
    # (name, what the error is) in the order in which they are offered: ("before", "measured minus nominal")
    stages: Sequence[tuple[str, str]]
    errors_mm: Mapping[str, Sequence[Array]]  # by model, for each stage (N, 3) base axes; NaN where there is no number
    missing: str = "not known"  # why a row may have no number
    paths: Sequence[str] = ()  # groups whose rows follow each other as a path
    suspects: Mapping[int, str] = field(default_factory=dict)  # why a row is no good, by row number from 0
    shares: Mapping[str, float] = field(default_factory=dict)  # of the mismatch by location; colours of the arm


def turnable(arm: Arm, shown: ErrorField) -> Markup:
    """The figure's content for a page that includes error_field.css and error_field.js."""
    content = json.dumps(figure_data(arm, shown), separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")
    return Markup(
        '<figure class="field" id="field"><script type="application/json">{}</script>'
        "<noscript><p>Turning the arm needs JavaScript; the figures below do without.</p></noscript>"
    ).format(Markup(content))


def figure_data(arm: Arm, shown: ErrorField) -> dict[str, Any]:
    """What error_field.js reads; lengths in mm, angles in rad, arrays as base64 of little-endian 32-bit floats."""
    rows = np.union1d(spread_evenly(len(shown.points_mm), MOST_ROWS), sorted(shown.suspects)).astype(np.intp)
    names = list(dict.fromkeys(shown.groups))
    number = {name: n for n, name in enumerate(names)}
    fields: list[str] = []
    models = []
    for model, stages in shown.errors_mm.items():
        packed = [_packed(errors[rows]) for errors in stages]
        fields.extend(text for text in packed if text not in fields)
        models.append({"name": model, "fields": [fields.index(text) for text in packed]})
    at = {int(row): n for n, row in enumerate(rows)}
    typical, view = typical_pose(arm, shown.motor_angles[rows])
    return {
        "points": _packed(shown.points_mm[rows]),
        "angles": _packed(shown.motor_angles[rows]),
        "ids": [str(shown.ids[row]) for row in rows],
        "group": _packed([number[shown.groups[row]] for row in rows]),
        "groups": names,
        "paths": [number[name] for name in shown.paths],
        "group_word": shown.group_word,
        "row_word": shown.row_word,
        "models": models,
        "fields": fields,
        "stages": list(shown.stages),
        "missing": shown.missing,
        "suspects": [(at[row], why) for row, why in sorted(shown.suspects.items())],
        "row": typical,
        "azimuth": float(np.arctan2(-view.right[0], view.right[1])),
        "elevation": float(np.arcsin(view.towards[2])),
        "sizes": [between(SHARES, part) for part in np.linspace(FAINTEST, 1, SHADES)],
        "signed": [between(SIGNED, part) for part in np.linspace(0, 1, SHADES)],
        "turn": upright(arm.gravity).ravel().tolist(),
        "arm": _arm_data(arm, shown.motor_angles[rows[typical]], shown.shares),
    }


def _packed(values: ArrayLike) -> str:
    return base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode()


def _arm_data(arm: Arm, motor_angles: Array, shares: Mapping[str, float]) -> dict[str, Any]:
    """The chain as the script turns it, and what is drawn of it, each piece in the frame of the body that moves it."""
    frames = chain(arm, np.reshape(motor_angles, (1, -1)))
    shape = arm_shape(arm, motor_angles)
    bodies = _bodies(arm, frames, motor_angles)
    size = float(np.max(np.ptp(shape.points, axis=0)))
    by_place = shares_by_place(shares)
    top = scale_end(max([0.0, *by_place.values()])) or 1.0

    def colour(place: str) -> str:
        share = by_place.get(place, 0.0)
        return between(SHARES, share / top) if share > 0 else NOTHING

    def width(number: float) -> float:
        return 1e3 * size * float(np.interp(number, [0, arm.n_joints + 1], [0.042, 0.021]))

    base_axes = shape.to_world.T  # the drawing's axes are turned against gravity
    parts = []
    for location, line in shape.parts:
        body = body_of(arm, location)
        rotation, origin = bodies[body]
        local = (line @ base_axes.T - origin) @ rotation * 1e3
        place = arm.n_joints + 1 if location == "tool" else Location.of(location).number
        parts.append(
            {
                "body": body,
                "line": local.tolist(),
                "width": 0.62 * width(place),
                "colour": colour(location),
                "ends": location == "tool",
            }
        )  # the tool's line ends at the row's own point
    discs = []
    for joint in range(arm.n_joints):
        centre = (shape.centres[joint] @ base_axes.T - frames.joint_origin[0, joint]) @ frames.joint_rotation[0, joint]
        share = by_place.get(f"joint {joint + 1}", 0.0)
        label = f"J{joint + 1}" + (f" {100 * share:.0f} %" if share >= NAMED_SHARE else "")
        radius = 1.15 * width(joint + 1)
        face = colour(f"joint {joint + 1}")
        discs.append({"at": (1e3 * centre).tolist(), "radius": radius, "half": 0.72 * radius, "colour": face,
                      "side": darker(face), "label": label})  # fmt: skip
    data: dict[str, Any] = {
        "before": [
            {"turn": fixed[:3, :3].ravel().tolist(), "at": (1e3 * fixed[:3, 3]).tolist()} for fixed in arm.before
        ],
        "actuation": arm.actuation.tolist(),
        "tool": (1e3 * (arm.tip[:3, 3] + arm.tip[:3, :3] @ arm.tool)).tolist(),
        "parts": parts,
        "discs": discs,
    }
    if shape.rod is not None:
        rotation, _ = bodies[3]
        data["rod"] = (1e3 * (shape.rod[1] - shape.rod[0]) @ base_axes.T @ rotation).tolist()
        data["rod_colour"] = colour("parallelogram")
    return data


def body_of(arm: Arm, location: str) -> int:
    """Which body carries a part of the drawing: 0 does not move, body j moves with joint j."""
    if location == "base":
        return 0
    if location == "tool":
        return arm.n_joints
    number = Location.of(location).number
    return number - 1 if arm.is_modified_dh else number


def _bodies(arm: Arm, frames: Chain, motor_angles: Array) -> list[tuple[Array, Array]]:
    """(rotation, origin) of the ground and of the frame that turns with each joint."""
    angles = arm.actuation @ np.ravel(motor_angles)
    bodies = [(np.eye(3), np.zeros(3))]
    for joint, angle in enumerate(angles):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        bodies.append((frames.joint_rotation[0, joint] @ turn, frames.joint_origin[0, joint]))
    return bodies
