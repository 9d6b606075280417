"""What effects follow, evaluated for all rows of a table: angles, loads, side of approach, temperature, time.

A driver's value is zero where its context was not recorded, so that a missing value neither helps nor hurts.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.physics.effect import Driver
from armscope.robot.gravity import gravity_torques, mass_moment_regressor

if TYPE_CHECKING:
    from armscope.physics.scene import Scene


REFERENCE_TEMPERATURE_C = 20.0
"""Lengths hold at this temperature."""
SECONDS_PER_HOUR = 3600.0
ROWS_PER_UNIT = 1000.0
SMALL_SHARE = 1e-3
"""Of a link's mass, by which slopes are taken: what bends with the load hardly does so here."""


def evaluate(scene: Scene, driver: Driver) -> Array:
    """Values (N,) of a driver at the scene's rows, in SI units (time in hours).

    Raises:
        InputError: the recordings lack the column that the driver needs.
    """
    return np.asarray(KINDS[driver.kind].values(scene, *driver.arguments), dtype=np.float64)


def recorded(scene: Scene, context: str, motor: int = 0) -> Array:
    """A context field of the scene's recordings ("temperature", ...), or one motor's column of it, NaN where unknown.

    Args:
        scene: N rows.
        context: name of the field.
        motor: from 0, where the field has a column per motor.

    Returns:
        (N,) in the field's unit.

    Raises:
        InputError: it was not recorded.
    """
    values: Array | None = getattr(scene.recordings, context)
    if values is not None:
        return values[:, motor - 1] if motor else values
    column = COLUMNS[context].replace("dq_", f"dq{motor or ''}_")
    raise InputError(
        scene.recordings.source,
        "line 1",
        f"no column {column}{motor if motor and column == context else ''}",
        "an effect in the model follows this column",
        "Add it to the table.",
    )


def _one(scene: Scene) -> Array:
    return np.ones(len(scene))


def _angle(scene: Scene, j: int, low: float = -np.inf, high: float = np.inf) -> Array:
    """Motor angle j, rad; held at the ends of a range where one is given (a full turn away is the same place)."""
    angle = scene.recordings.motor_angles[:, j - 1]
    if np.isinf(low) and np.isinf(high):
        return angle
    beyond = (angle < low) | (angle > high)
    turned = (low + high) / 2 + np.remainder(angle - (low + high) / 2 + np.pi, 2 * np.pi) - np.pi
    return np.clip(np.where(beyond, turned, angle), low, high)


def _sine(scene: Scene, j: int, periods: float, *ends: float) -> Array:
    return np.sin(periods * _angle(scene, j, *ends))


def _cosine(scene: Scene, j: int, periods: float, *ends: float) -> Array:
    return np.cos(periods * _angle(scene, j, *ends))


def _chain_sine(scene: Scene, j: int, periods: int) -> Array:
    return np.sin(periods * scene.chain_angles[:, j - 1])


def _chain_cosine(scene: Scene, j: int, periods: int) -> Array:
    return np.cos(periods * scene.chain_angles[:, j - 1])


def _chain_angle(scene: Scene, j: int) -> Array:
    return scene.chain_angles[:, j - 1]


def _payload(scene: Scene) -> Array:
    return scene.payload


def _force(scene: Scene, location: str, axis: int) -> Array:
    """Weight beyond a frame, in the frame's axes, N."""
    return scene.force(location)[:, axis]


def _torque(scene: Scene, j: int) -> Array:
    """Recorded torque where there is one (positive along gravity's pull), else gravity of the stated masses."""
    return scene.torques[:, j - 1]


def _gravity_torque(scene: Scene, j: int) -> Array:
    """Torque of gravity by the stated masses and payload, whatever was recorded."""
    return scene.gravity_torques[:, j - 1]


def _payload_torque(scene: Scene, j: int) -> Array:
    """Torque on motor j of the payload alone."""
    return _unit_mass_torques(scene)[:, j - 1] * np.nan_to_num(recorded(scene, "payload"))


def _unit_mass_torques(scene: Scene) -> Array:
    """(N, m) torque of one kilogram at the tool point."""

    def compute() -> Array:
        ones = np.ones(len(scene))
        return gravity_torques(scene.arm, scene.loaded, ones) - gravity_torques(scene.arm, scene.loaded)

    return np.asarray(scene.remember("unit mass torques", compute))


def _heavier(scene: Scene, load: Driver) -> Array:
    """Change of a load driver per kilogram more at the tool point."""
    more = replace(scene.misstated, payload_kg=scene.misstated.payload_kg + 1.0)
    heavier = scene.remember("heavier", lambda: scene.loaded_as(more))
    change: Array = heavier.driver(load) - scene.driver(load)
    return change


def _off_centre(scene: Scene, load: Driver, axis: int) -> Array:
    """Change of a load driver per metre that the payload's centre lies off the tool point along a tool axis."""
    off = replace(scene.misstated, payload_offset=np.eye(3)[axis])
    shifted = scene.remember(("off centre", axis), lambda: scene.loaded_as(off))
    change: Array = shifted.driver(load) - scene.driver(load)
    return change


def _heavier_by_share(scene: Scene, load: Driver) -> Array:
    """Change of a load driver per share of the stated payload that it is heavier."""
    more = replace(scene.misstated, payload_share=scene.misstated.payload_share + 1.0)
    heavier = scene.remember("heavier by share", lambda: scene.loaded_as(more))
    change: Array = heavier.driver(load) - scene.driver(load)
    return change


def _heavier_link(scene: Scene, load: Driver, link: int) -> Array:
    """Slope of a load driver over the relative error of a link's mass; loads themselves are proportional to it."""
    change: Array = scene.with_heavier_link(link, SMALL_SHARE).driver(load) - scene.driver(load)
    return change / SMALL_SHARE


def _regressor(scene: Scene, j: int, *weights: float) -> Array:
    """Combination of the static torque regressor's columns of motor j: gravity torque of unknown mass moments."""
    regressor = scene.remember("regressor", lambda: mass_moment_regressor(scene.arm, scene.loaded))
    values: Array = regressor[:, j - 1] @ np.array(weights)
    return values


def _load_side(scene: Scene, j: int) -> Array:
    return np.sign(_torque(scene, j))


def _moment(scene: Scene, location: str, axis: int) -> Array:
    """Moment of gravity about the frame's origin, in the frame's axes, N m."""
    return scene.moment(location)[:, axis]


def _bend(scene: Scene, link: int, axis: int) -> Array:
    """Twist of a link's end per unit flexibility 1/(E I), Euler-Bernoulli cantilever under end force and moment."""
    return scene.bending(link)[:, axis]


def _approach(scene: Scene, j: int) -> Array:
    return np.nan_to_num(recorded(scene, "approach", j))


def _lost_motion(scene: Scene, j: int, centre: float, width: float) -> Array:
    """Side of approach where the joint stands near ``centre`` (a cubic spline of its angle)."""
    return _approach(scene, j) * cubic_spline(_angle(scene, j), centre, width)


def _speed(scene: Scene, j: int) -> Array:
    return np.nan_to_num(recorded(scene, "speed", j))


def _warmth(scene: Scene) -> Array:
    """Temperature above the reference, K."""
    return np.nan_to_num(recorded(scene, "temperature") - REFERENCE_TEMPERATURE_C)


def _hours(scene: Scene, start: float) -> Array:
    """Hours since ``start`` (s)."""
    return np.nan_to_num((recorded(scene, "time") - start) / SECONDS_PER_HOUR)


def _rows(scene: Scene) -> Array:
    """Thousands of rows since the table's beginning."""
    return scene.row_numbers / ROWS_PER_UNIT


def _after_time(scene: Scene, start: float, run: str, *later: str) -> Array:
    """From a time of a run on, and in later runs."""
    return np.where(_in_run(scene, run), recorded(scene, "time") >= start, _in_run(scene, *later))


def _after_row(scene: Scene, first_row: float, run: str, *later: str) -> Array:
    """From a row of a run on, and in later runs; counted by the table's id (its row number where it has none)."""
    return np.where(_in_run(scene, run), scene.row_numbers >= first_row, _in_run(scene, *later))


def _in_run(scene: Scene, *runs: str) -> Array:
    return np.asarray(np.isin(scene.recordings.run, runs))


def _slow_wave(scene: Scene, waves: int, first: float, last: float) -> Array:
    """Cosine of so many half waves from the first time (s) to the last, standing still before and after.

    Zero where no time was recorded: how the set-up then stands is not known.
    """
    time = scene.recordings.time
    return np.zeros(len(scene)) if time is None else np.nan_to_num(_half_waves(time, waves, first, last))


def _slow_wave_of_rows(scene: Scene, waves: int, first: float, last: float) -> Array:
    """The same along the order of rows."""
    return _half_waves(scene.row_numbers, waves, first, last)


def _half_waves(at: Array, waves: int, first: float, last: float) -> Array:
    along = np.clip((at - first) / max(last - first, 1e-9), 0.0, 1.0)
    return np.asarray(np.cos(np.pi * waves * along))


def _on_target(scene: Scene, target: str) -> Array:
    return np.asarray(scene.recordings.target == target)


def _on_target_in_run(scene: Scene, target: str, run: str) -> Array:
    return np.asarray((scene.recordings.target == target) & (scene.recordings.run == run))


def _spline(scene: Scene, source: Driver, centre: float, width: float) -> Array:
    return cubic_spline(scene.driver(source), centre, width)


def cubic_spline(at: Array, centre: float, width: float) -> Array:
    """Cubic B-spline: a smooth bump about ``centre``, zero beyond two widths.

    Args:
        at: (N,) values.
        centre: of the bump, same unit.
        width: between knots, same unit.

    Returns:
        (N,) 0 ... 2/3.
    """
    u = np.abs(at - centre) / width
    inner = 2 / 3 - u**2 + u**3 / 2
    outer = np.clip(2 - u, 0, None) ** 3 / 6
    return np.where(u < 1, inner, outer)


def _rod(scene: Scene) -> Array:
    """Forearm angle per metre that rod minus upper arm differs from the parallelogram: -1 / (k sin gamma)."""
    gamma = _crank_to_upper_arm(scene)
    return -1.0 / (scene.linkage.rocker * _away_from_zero(np.sin(gamma)))


def _rocker(scene: Scene) -> Array:
    """Forearm angle per metre that rocker minus crank differs from the parallelogram: cot(gamma) / k."""
    gamma = _crank_to_upper_arm(scene)
    return np.cos(gamma) / (scene.linkage.rocker * _away_from_zero(np.sin(gamma)))


def _rod_share(scene: Scene, crank_angle: float) -> Array:
    """As `_rod`, per share of the rocker's length, for a rocker that stands at ``crank_angle`` on the forearm, rad."""
    return -1.0 / _away_from_zero(np.sin(scene.elbow_angle + crank_angle))


def _rocker_share(scene: Scene, crank_angle: float) -> Array:
    """As `_rocker`, per share of the rocker's length."""
    gamma = scene.elbow_angle + crank_angle
    return np.cos(gamma) / _away_from_zero(np.sin(gamma))


def _crank_to_upper_arm(scene: Scene) -> Array:
    return scene.elbow_angle + scene.linkage.crank_angle


def _away_from_zero(values: Array) -> Array:
    """A flat parallelogram has no defined forearm; its neighbourhood must not swamp everything else."""
    return np.where(np.abs(values) < 0.1, np.where(values < 0, -0.1, 0.1), values)


@dataclass(frozen=True)
class DriverKind:
    """How a driver is evaluated, and all that anybody else asks about it.

    Attributes:
        values: (scene, *arguments of the driver) -> (N,) values, SI units (time in hours).
        needs: the field of the recordings without which it can't be evaluated ("temperature"; "" for none).
        follows: what it depends on: "load" (where the arm stands under gravity), "payload", "weight" (it is a load,
            proportional to what hangs there), "torque" (recorded where it was), "run" (it describes a recording, not
            the arm).
        unit: of its values where an effect is drawn as a curve over it; "" where it is not.
    """

    values: Callable[..., Any]
    needs: str = ""
    follows: frozenset[str] = frozenset()
    unit: str = ""


COLUMNS = {
    "payload": "payload_kg",
    "temperature": "temperature_c",
    "time": "time_s",
    "approach": "approach",
    "speed": "dq_rad_s",
}
"""Context: field of the recordings, and the column (one per motor for the last two) that it comes from."""

_LOAD = frozenset({"load", "payload"})
_WEIGHT = _LOAD | {"weight"}
_RUN = frozenset({"run"})

KINDS: dict[str, DriverKind] = {
    "one": DriverKind(_one),
    "angle": DriverKind(_angle, unit="rad"),
    "sine": DriverKind(_sine),
    "cosine": DriverKind(_cosine),
    "chain sine": DriverKind(_chain_sine),
    "chain cosine": DriverKind(_chain_cosine),
    "chain angle": DriverKind(_chain_angle),
    "payload": DriverKind(_payload, follows=frozenset({"payload"})),
    "force": DriverKind(_force, follows=_WEIGHT),
    "torque": DriverKind(_torque, follows=_WEIGHT | {"torque"}, unit="N m"),
    "gravity torque": DriverKind(_gravity_torque, follows=_WEIGHT),
    "payload torque": DriverKind(_payload_torque, needs="payload", follows=_LOAD),
    "heavier": DriverKind(_heavier, follows=_LOAD),
    "heavier by share": DriverKind(_heavier_by_share, follows=_LOAD),
    "heavier link": DriverKind(_heavier_link, follows=_LOAD),
    "off centre": DriverKind(_off_centre, follows=_LOAD),
    "regressor": DriverKind(_regressor, follows=frozenset({"load"})),
    "load side": DriverKind(_load_side, follows=_LOAD | {"torque"}),
    "moment": DriverKind(_moment, follows=_WEIGHT),
    "bend": DriverKind(_bend, follows=_WEIGHT),
    "approach": DriverKind(_approach, needs="approach"),
    "lost motion": DriverKind(_lost_motion, needs="approach"),
    "speed": DriverKind(_speed, needs="speed"),
    "warmth": DriverKind(_warmth, needs="temperature", follows=_RUN, unit="K above 20 C"),
    "hours": DriverKind(_hours, needs="time", follows=_RUN, unit="h"),
    "rows": DriverKind(_rows, follows=_RUN),
    "after time": DriverKind(_after_time, needs="time", follows=_RUN),
    "after row": DriverKind(_after_row, follows=_RUN),
    "in run": DriverKind(_in_run, follows=_RUN),
    "during run": DriverKind(_in_run, follows=_RUN),  # the same, of what is no free frame
    "slow wave": DriverKind(_slow_wave, follows=_RUN),
    "slow wave of rows": DriverKind(_slow_wave_of_rows, follows=_RUN),
    "on target": DriverKind(_on_target),
    "on target in run": DriverKind(_on_target_in_run),
    "spline": DriverKind(_spline),
    "rod": DriverKind(_rod),
    "rocker": DriverKind(_rocker),
    "rod share": DriverKind(_rod_share),
    "rocker share": DriverKind(_rocker_share),
}


def kinds_in(driver: Driver) -> frozenset[str]:
    """The kinds of a driver and of those that it is a function of."""
    inner = (kinds_in(argument) for argument in driver.arguments if isinstance(argument, Driver))
    return frozenset({driver.kind}).union(*inner)


@functools.lru_cache(maxsize=100_000)
def follows(what: str, driver: Driver) -> bool:
    """Whether a driver, or one that it is a function of, depends on one of these (`DriverKind.follows`)."""
    return any(what in KINDS[kind].follows for kind in kinds_in(driver))
