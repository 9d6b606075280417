"""Kinds of effects that only rough arms have (`armscope.world.rough`): they break what a diagnosis assumes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.world.effects import LIBRARY
from armscope.world.kinds import (
    ANGLE,
    CONSTANT,
    LOAD,
    PAYLOAD,
    TEMPERATURE,
    TIME,
    Hide,
    Kind,
    Parameter,
    Scene,
    Values,
    number,
    only,
)
from armscope.world.layout import BASE_FREEDOMS
from armscope.world.statics import Hidden

OF = {kind.name: kind for kind in LIBRARY}
_RMS, _SIZE = Parameter("rms", "rad"), Parameter("size", "mm", 1e-3)
_METRES_PER_TURN = 2.0


def _kind(effect: str, variant: str, driver: str, hide: Hide, *parameters: Parameter) -> Kind:
    """A kind that only rough arms have: it is placed and drawn below."""
    return Kind(effect, variant, driver, parameters, (), only(""), lambda rng, scene, place: {}, hide)


def _hide_hardening(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """A spring in two sections, as makers of strain-wave gears state it: softer up to the knee, with a bend there."""
    motor = number(location)
    knee = values["knee"] * scene.largest_torque(motor)
    hidden.motor_spring(motor, values["compliance"])
    hidden.curves.append((motor, lambda torque: values["soft"] * min(max(torque / knee, -1.0), 1.0)))


def _hide_pedestal(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.layout = replace(hidden.layout, pedestal_turn=values["direction"])
    hidden.spring("pedestal u", values["soft"])
    hidden.spring("pedestal v", values["stiff"])


def _hide_bearing(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    for axis in "xy":
        hidden.spring(f"tilt {number(location) + 1} {axis}", values[f"about_{axis}"])


def _hide_waves(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.motor[:, number(location)] += waves(scene.session.commanded[:, number(location)], values)


def waves(angle: Array, values: Values) -> Array:
    """(N,) error of a gear, rad: waves of random phase, amplitude falling as a power of their number.

    Args:
        angle: (N,) rad.
        values: `rms` over a turn, the numbers of waves `first` to `last`, `slope`, and `seed` of what is random.

    Returns:
        (N,) rad.
    """
    rng = np.random.default_rng(int(values["seed"]))
    count = np.arange(values["first"], values["last"] + 1)
    amplitude = rng.rayleigh(size=len(count)) * (rng.random(len(count)) < 2 / 3) * count ** -values["slope"]
    amplitude[np.argmax(count ** -values["slope"])] += 1e-3  # at least one
    phase = rng.uniform(0, 2 * np.pi, len(count))
    turned = np.cos(np.outer(angle, count) - phase) @ amplitude
    return np.asarray(values["rms"] * turned / np.sqrt(np.sum(amplitude**2) / 2))


def _hide_row(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.misshape(number(location), np.array([values["a"], 0.0, 0.0, 0.0]))


def _hide_link(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """Errors of a D-H row, and the turn about y that no row has."""
    row = {name: value for name, value in values.items() if name != "beta"}
    OF["link_geometry"].hide(hidden, scene, location, row)
    hidden.move(f"tilt {number(location) + 1} y", np.full(len(scene.session), values["beta"]))


def _hide_wander(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """Three slow waves of time in every direction."""
    rng = np.random.default_rng(int(values["seed"]))
    hours = scene.session.time / 3600
    for freedom in BASE_FREEDOMS:
        per_hour, phase = rng.uniform(0.3, 6, 3), rng.uniform(0, 2 * np.pi, 3)
        course = np.cos(np.outer(hours, per_hour) - phase).sum(axis=1) / np.sqrt(1.5)
        hidden.move(freedom, values["size"] * _per_freedom(freedom) * course)


def _hide_runs(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    rng = np.random.default_rng(int(values["seed"]))
    for freedom in BASE_FREEDOMS:
        of_run = rng.normal(size=100)[scene.session.run]
        hidden.move(freedom, values["size"] * _per_freedom(freedom) * of_run)


def _per_freedom(freedom: str) -> float:
    return 1 / _METRES_PER_TURN if freedom.startswith("base r") else 1.0


def _hide_growth(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    session = replace(scene.session, temperature=lagging(scene.session.temperature, scene.session.time, values["lag"]))
    OF["thermal_expansion"].hide(hidden, replace(scene, session=session), location, values)


def lagging(temperature: Array, time: Array, lag: float) -> Array:
    """What follows a temperature to first order.

    Args:
        temperature: (N,) deg C.
        time: (N,) s.
        lag: time constant, s.

    Returns:
        (N,) deg C, from the first temperature on.
    """
    share = 1 - np.exp(-np.diff(time) / lag)
    found = [float(temperature[0])] if len(temperature) else []
    for part, hall in zip(share, temperature[1:], strict=True):
        found.append(found[-1] + part * (hall - found[-1]))
    return np.array(found)


def _hide_payload(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    hidden.payload_share += values["share"]


_COMPLIANCE = Parameter("compliance", "rad/(N m)")
DRIVE = _kind(
    "joint_compliance", "hardening", LOAD, _hide_hardening, _COMPLIANCE,
    Parameter("soft", "rad"), Parameter("knee", "1", scales=False),
)  # fmt: skip
PEDESTAL = _kind(
    "base_compliance", "two axes", LOAD, _hide_pedestal, Parameter("soft", "rad/(N m)"),
    Parameter("stiff", "rad/(N m)"), Parameter("direction", "rad", scales=False),
)  # fmt: skip
BEARING = _kind(
    "bearing_compliance", "two axes", LOAD, _hide_bearing, Parameter("about_x", "rad/(N m)"),
    Parameter("about_y", "rad/(N m)"),
)  # fmt: skip
LOW_WAVES = _kind("gear_eccentricity", "waves", ANGLE, _hide_waves, _RMS)
FINE_WAVES = _kind("gear_mesh", "waves", ANGLE, _hide_waves, _RMS)
ROW = _kind("link_geometry", "stated on the next row", CONSTANT, _hide_row, Parameter("a", "mm", 1e-3))
LINK = _kind("link_geometry", "", CONSTANT, _hide_link, *OF["link_geometry"].parameters)
WANDER = _kind("base_drift", "wander", TIME, _hide_wander, _SIZE)
RUNS = _kind("base_shift", "between runs", TIME, _hide_runs, _SIZE)
GROWTH = _kind("thermal_expansion", "lagging", TEMPERATURE, _hide_growth, Parameter("coefficient", "1/K"))
PAYLOAD_SHARE = _kind("payload_error", "share", PAYLOAD, _hide_payload, Parameter("share", "1"))
