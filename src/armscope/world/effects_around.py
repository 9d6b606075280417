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


def lower_side(pull: Array) -> Array:
    """(N, k) where something lies that slides along k axes, each way by one; in the middle where that is nearly level.

    Args:
        pull: (N, k) share of its weight along each of them.
    """
    steep = np.linalg.norm(pull, axis=1, keepdims=True)
    return np.where(steep > LEAST_SLOPE, pull / np.maximum(steep, LEAST_SLOPE), 0.0)


LEAST_SLOPE = 0.1
"""Dry friction of polished steel."""


def _hide_holder(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    pull = weight_along_tool(scene)
    for n, axis in enumerate("xy"):
        hidden.move(f"target {axis}", values[f"sag_{axis}"] * pull[:, n])


def _hide_nest(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """A target that falls from one side of its nest to the other."""
    (axes,) = (name.removeprefix("play_") for name in values)
    side = lower_side(weight_along_tool(scene)[:, ["xyz".index(axis) for axis in axes]])
    for n, axis in enumerate(axes):
        hidden.move(f"target {axis}", values[f"play_{axes}"] * side[:, n])


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


def _draw_play(axes: str, rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {f"play_{axes}": 3e-4}


TARGET: tuple[Kind, ...] = (
    Kind(
        "holder_sag", "", LOAD, tuple(Parameter(f"sag_{axis}", "mm", 1e-3) for axis in "xy"), (), only("tool"),
        lambda rng, scene, place: {f"sag_{axis}": float(rng.normal(0, 3e-4)) for axis in "xy"}, _hide_holder,
    ),
    *(
        Kind(
            "loose_target", axes, LOAD, (Parameter(f"play_{axes}", "mm", 1e-3),), (), only("tool"),
            partial(_draw_play, axes), _hide_nest,
        )
        for axes in ("x", "xy")
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
