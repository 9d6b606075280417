"""Effects that no diagnosis has in its library: what real arms do besides.

truth.yaml lists them as `unknown`, with their driver and a `shape`. Angles act on a motor, as for the library's.
"""

from __future__ import annotations

import numpy as np

from armscope.world.kinds import ANGLE, APPROACH, LOAD, TIME, Kind, Parameter, Scene, Values, joints, number
from armscope.world.statics import Hidden

_AMPLITUDE = Parameter("amplitude", "rad")
_SIZE = 5e-4


def _fixed(name: str, unit: str) -> Parameter:
    return Parameter(name, unit, scales=False)


def _somewhere(rng: np.random.Generator, scene: Scene, location: str) -> float:
    """An angle in the middle half of what the joint did in the session."""
    return float(np.quantile(scene.session.commanded[:, number(location)], rng.uniform(0.3, 0.7)))


def _signed(rng: np.random.Generator) -> float:
    return float(rng.choice([-1, 1]) * _SIZE)


def _hide_bump(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    angle = scene.session.commanded[:, number(location)]
    hidden.motor[:, number(location)] += values["amplitude"] * np.exp(
        -0.5 * ((angle - values["centre"]) / values["width"]) ** 2
    )


def _hide_hysteresis(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """Lost motion whose width changes with the angle, as of a worn gear."""
    motor = number(location)
    angle = scene.session.commanded[:, motor]
    wear = 1 + np.tanh((angle - values["centre"]) / 0.3)
    hidden.motor[:, motor] -= scene.session.approach[:, motor] * values["amplitude"] * wear


def _hide_loose_beyond(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    angle = scene.session.commanded[:, number(location)]
    hidden.motor[:, number(location)] += values["amplitude"] * np.maximum(angle - values["centre"], 0.0)


def _hide_dead_band(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """Gives way only when the load exceeds a threshold, on either side."""
    motor = number(location)
    threshold, full = values["threshold"], scene.largest_torque(motor)

    def curve(torque: float) -> float:
        beyond = max(abs(torque) - threshold, 0.0) / (full - threshold)
        return float(values["amplitude"] * np.sign(torque) * beyond)

    hidden.curves.append((motor, curve))


def _draw_dead_band(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    largest = scene.largest_torque(number(location))
    return {"amplitude": _SIZE, "threshold": float(rng.uniform(0.4, 0.6) * largest)}


def _hide_one_sided(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """Gives way to one side only, as where bolts let a flange gape and a seat holds it the other way."""
    motor = number(location)
    full = scene.largest_torque(motor)
    hidden.curves.append((motor, lambda torque: float(values["amplitude"] * max(torque / full, 0.0))))


def _hide_product(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """A cyclic error whose size changes cyclically with the neighbour's angle."""
    motor = number(location)
    neighbour = int(values["neighbour"]) - 1
    angles = scene.session.commanded
    hidden.motor[:, motor] += values["amplitude"] * np.sin(2 * angles[:, motor]) * np.sin(2 * angles[:, neighbour])


def _draw_product(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    motor = number(location)
    neighbour = motor - 1 if motor else 1
    return {"amplitude": _SIZE, "neighbour": float(neighbour + 1)}


def _hide_tooth(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    angle = scene.session.commanded[:, number(location)]
    hidden.motor[:, number(location)] += values["amplitude"] * (angle > values["centre"])


def _hide_warm_up(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    """The gear's zero creeps exponentially after the start."""
    hidden.motor[:, number(location)] += values["amplitude"] * np.exp(-scene.session.time / values["constant"])


def _draw_warm_up(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    return {"amplitude": _signed(rng), "constant": float(rng.uniform(0.15, 0.4) * scene.session.time[-1])}


OUTSIDE: tuple[Kind, ...] = (
    Kind(
        "unknown", "local_bump", ANGLE, (_AMPLITUDE, _fixed("centre", "rad"), _fixed("width", "rad")), (), joints,
        lambda rng, scene, place: {
            "amplitude": _signed(rng), "centre": _somewhere(rng, scene, place), "width": float(rng.uniform(0.1, 0.25)),
        },
        _hide_bump, "one damaged stretch of a gear",
    ),
    Kind(
        "unknown", "worn_hysteresis", APPROACH, (_AMPLITUDE, _fixed("centre", "rad")), ("approach",), joints,
        lambda rng, scene, place: {"amplitude": _SIZE / 2, "centre": _somewhere(rng, scene, place)},
        _hide_hysteresis, "lost motion that grows from one side of the range to the other",
    ),
    Kind(
        "unknown", "loose_beyond", ANGLE, (Parameter("amplitude", "rad/rad"), _fixed("centre", "rad")), (), joints,
        lambda rng, scene, place: {"amplitude": 2 * _signed(rng), "centre": _somewhere(rng, scene, place)},
        _hide_loose_beyond, "in order up to an angle, proportional to what exceeds it beyond",
    ),
    Kind(
        "unknown", "load_dead_band", LOAD, (_AMPLITUDE, _fixed("threshold", "N m")), ("payload_kg",), joints,
        _draw_dead_band, _hide_dead_band, "gives way only beyond a load",
    ),
    Kind(
        "unknown", "one_sided_spring", LOAD, (_AMPLITUDE,), ("payload_kg",), joints,
        lambda rng, scene, place: {"amplitude": _SIZE}, _hide_one_sided, "gives way to one side, and not to the other",
    ),
    Kind(
        "unknown", "harmonic_product", ANGLE, (_AMPLITUDE, _fixed("neighbour", "joint")), (), joints,
        _draw_product, _hide_product, "a cyclic error modulated by the neighbour's angle",
    ),
    Kind(
        "unknown", "tooth_jump", ANGLE, (_AMPLITUDE, _fixed("centre", "rad")), (), joints,
        lambda rng, scene, place: {"amplitude": _signed(rng), "centre": _somewhere(rng, scene, place)},
        _hide_tooth, "a step at an angle",
    ),
    Kind(
        "unknown", "warm_up", TIME, (_AMPLITUDE, _fixed("constant", "s")), ("time_s",), joints,
        _draw_warm_up, _hide_warm_up, "a joint's zero creeps after the start",
    ),
)  # fmt: skip
"""The kinds outside the library."""
