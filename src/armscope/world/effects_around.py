"""What goes wrong around the arm, at its base, instrument and payload, as concealed worlds build it.

Conventions: `armscope.world.effects`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from armscope.core.types import Array
from armscope.world.kinds import (
    COMPLIANCE,
    CONSTANT,
    LOAD,
    PAYLOAD,
    TIME,
    Kind,
    Parameter,
    Scene,
    Values,
    compliance_across,
    moment,
    only,
)
from armscope.world.layout import BASE_FREEDOMS
from armscope.world.statics import Hidden

HOUR_S = 3600.0


def twist_parameters(per: str = "", si: float = 1.0) -> tuple[Parameter, ...]:
    """Three translations in mm and three rotations in rad, each ``per`` something."""
    return tuple(
        Parameter(name, ("rad" if name.startswith("r") else "mm") + per, (1.0 if name.startswith("r") else 1e-3) * si)
        for name in ("x", "y", "z", "rx", "ry", "rz")
    )


def _draw_twist(rng: np.random.Generator) -> dict[str, float]:
    """Millimetres and milliradians about a place a metre or two away: both matter at the tool."""
    size = np.array([1e-3] * 3 + [0.5e-3] * 3)
    return dict(zip(("x", "y", "z", "rx", "ry", "rz"), (rng.normal(0, 1, 6) * size).tolist(), strict=True))


def _move_base(hidden: Hidden, values: Values, progress: Array) -> None:
    for freedom in BASE_FREEDOMS:
        hidden.move(freedom, values[freedom.split()[1]] * progress)


def _hide_drift(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    _move_base(hidden, values, scene.session.time)


def _draw_drift(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {name: value / HOUR_S for name, value in _draw_twist(rng).items()}


def _draw_shift(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {**_draw_twist(rng), "time": moment(rng, scene)}


def _hide_shift(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    _move_base(hidden, values, (scene.session.time > values["time"]).astype(float))


def _hide_base_compliance(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    for freedom in ("base rx", "base ry"):
        hidden.spring(freedom, values["compliance"])


def _hide_scale(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.scale += values["scale"]


def _hide_payload_mass(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.payload_mass += values["mass"]


def _hide_payload_centre(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    centre = np.array([values["com_x"], values["com_y"], values["com_z"]])
    hidden.layout = replace(hidden.layout, payload_offset=hidden.layout.payload_offset + centre)


def weight_along_tool(scene: Scene) -> Array:
    """(N, 3) share of a weight that pulls along each axis of the nominal last frame."""
    down = scene.geometry.gravity / np.linalg.norm(scene.geometry.gravity)
    return np.asarray(np.swapaxes(scene.tool_turn, 1, 2) @ down)


def lower_side(pull: Array, least: float) -> Array:
    """(N, 3) where something lies that slides about, by one at most; in the middle where that is nearly level.
    ``pull``: (N, 3) what of its weight pulls in the directions in which it slides."""
    steep = np.linalg.norm(pull, axis=1, keepdims=True)
    return np.where(steep > least, pull / np.maximum(steep, least), 0.0)


def _stem(rng: np.random.Generator) -> Array:
    """(3,) a direction of the tool, anyhow."""
    direction = rng.normal(size=3)
    return np.asarray(direction / np.linalg.norm(direction))


def _draw_holder(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    """A stem that bends across itself; what it does alike along all axes is taken off, which the base takes up."""
    stem = _stem(rng)
    sag = 3e-4 * (np.eye(3) - np.outer(stem, stem))
    sag -= sag[2, 2] * np.eye(3)
    return {f"sag_{name}": float(sag[at]) for name, at in SAGS.items()}


def _hide_holder(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    sag = np.zeros((3, 3))
    for name, (one, other) in SAGS.items():
        sag[one, other] = sag[other, one] = values[f"sag_{name}"]
    for axis, shift in zip("xyz", (weight_along_tool(scene) @ sag).T, strict=True):
        hidden.move(f"target {axis}", shift)


SAGS = {"x": (0, 0), "y": (1, 1), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
"""Entries of the matrix by which a holder bends, of which the last one on the diagonal is zero."""


def _draw_nest(way: str, rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    direction = dict(zip(("nest_x", "nest_y", "nest_z"), _stem(rng).tolist(), strict=True))
    return {f"play_{way}": 3e-4, **direction, "least_slope": float(rng.uniform(0.02, 0.2))}


def _hide_nest(way: str, hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """A target that falls from one side of its nest to the other, along a direction or in the plane across it."""
    direction = np.array([values["nest_x"], values["nest_y"], values["nest_z"]])
    pull = weight_along_tool(scene)
    along = np.outer(pull @ direction, direction)
    side = lower_side(along if way == "along" else pull - along, values["least_slope"])
    for axis, shift in zip("xyz", (values[f"play_{way}"] * side).T, strict=True):
        hidden.move(f"target {axis}", shift)


BASE: tuple[Kind, ...] = (
    Kind(
        "base_drift", "", TIME, twist_parameters("/h", 1 / HOUR_S), ("time_s",), only("base"), _draw_drift, _hide_drift
    ),
    Kind(
        "base_shift", "", TIME, (*twist_parameters(), Parameter("time", "s", scales=False)), ("time_s",), only("base"),
        _draw_shift, _hide_shift,
    ),
    Kind(
        "base_compliance", "", LOAD, COMPLIANCE, ("payload_kg",), only("base"), compliance_across,
        _hide_base_compliance,
    ),
)  # fmt: skip
"""In the order of the catalogue."""


_DIRECTION = tuple(Parameter(name, "", scales=False) for name in ("nest_x", "nest_y", "nest_z", "least_slope"))
TARGET: tuple[Kind, ...] = (
    Kind(
        "holder_sag", "", LOAD, tuple(Parameter(f"sag_{name}", "mm", 1e-3) for name in SAGS), (), only("tool"),
        _draw_holder, _hide_holder,
    ),
    *(
        Kind(
            "loose_target", way, LOAD, (Parameter(f"play_{way}", "mm", 1e-3), *_DIRECTION), (), only("tool"),
            partial(_draw_nest, way), partial(_hide_nest, way),
        )
        for way in ("along", "across")
    ),
)  # fmt: skip
"""In the order of the catalogue."""


INSTRUMENT_AND_PAYLOAD: tuple[Kind, ...] = (
    Kind(
        "instrument_scale", "", CONSTANT, (Parameter("scale", "m/m"),), (), only("instrument"),
        lambda rng, scene, place: {"scale": float(rng.choice([-1, 1]) * 1e-4)}, _hide_scale,
    ),
    Kind(
        "payload_error", "", PAYLOAD, (Parameter("mass", "kg"),), ("payload_kg",), only("payload"),
        lambda rng, scene, place: {"mass": float(0.3 * scene.session.payload.max())}, _hide_payload_mass,
    ),
    Kind(
        "payload_error", "centre", PAYLOAD, tuple(Parameter(f"com_{axis}", "mm", 1e-3) for axis in "xyz"),
        ("payload_kg",), only("payload"),
        lambda rng, scene, place: {f"com_{axis}": float(rng.normal(0, 0.15)) for axis in "xyz"}, _hide_payload_centre,
    ),
)  # fmt: skip
"""In the order of the catalogue."""
