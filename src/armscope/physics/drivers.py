"""What effects follow, evaluated for all rows of a table: angles, loads, side of approach, temperature, time.

A driver's value is zero where its context was not recorded, so that a missing value neither helps nor hurts.
"""

from __future__ import annotations

from collections.abc import Callable
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
LARGEST_ARGUMENT = 1e12
"""Of a driver: seconds since 1970 are the largest numbers that stand there."""


def evaluate(scene: Scene, driver: Driver) -> Array:
    """Values (N,) of a driver at the scene's rows, in SI units (time in hours).

    Raises:
        InputError: the recordings lack the column that the driver needs.
    """
    kind, arguments = driver.kind, driver.arguments
    return np.asarray(KINDS[kind](scene, *arguments), dtype=np.float64)


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
    if scene.recordings.payload is None:
        raise _missing(scene, "payload_kg")
    return _unit_mass_torques(scene)[:, j - 1] * np.nan_to_num(scene.recordings.payload)


def _unit_mass_torques(scene: Scene) -> Array:
    """(N, m) torque of one kilogram at the tool point."""

    def compute() -> Array:
        ones = np.ones(len(scene))
        return gravity_torques(scene.arm, scene.loaded, ones) - gravity_torques(scene.arm, scene.loaded)

    return scene.remember("unit mass torques", compute)


def _heavier(scene: Scene, load: Driver) -> Array:
    """Change of a load driver per kilogram more at the tool point."""
    heavier = scene.remember("heavier", lambda: scene.with_payload(mass=1.0))
    change: Array = heavier.driver(load) - scene.driver(load)
    return change


def _off_centre(scene: Scene, load: Driver, axis: int) -> Array:
    """Change of a load driver per metre that the payload's centre lies off the tool point along a tool axis."""
    shifted = scene.remember(("off centre", axis), lambda: scene.with_payload(offset=np.eye(3)[axis]))
    change: Array = shifted.driver(load) - scene.driver(load)
    return change


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
    if scene.recordings.approach is None:
        raise _missing(scene, f"approach{j}")
    return np.nan_to_num(scene.recordings.approach[:, j - 1])


def _lost_motion(scene: Scene, j: int, centre: float, width: float) -> Array:
    """Side of approach where the joint stands near ``centre`` (a cubic spline of its angle)."""
    return _approach(scene, j) * cubic_spline(_angle(scene, j), centre, width)


def _speed(scene: Scene, j: int) -> Array:
    if scene.recordings.speed is None:
        raise _missing(scene, f"dq{j}_rad_s")
    return np.nan_to_num(scene.recordings.speed[:, j - 1])


def _warmth(scene: Scene) -> Array:
    """Temperature above the reference, K."""
    if scene.recordings.temperature is None:
        raise _missing(scene, "temperature_c")
    return np.nan_to_num(scene.recordings.temperature - REFERENCE_TEMPERATURE_C)


def _hours(scene: Scene, start: float) -> Array:
    """Hours since ``start`` (s)."""
    if scene.recordings.time is None:
        raise _missing(scene, "time_s")
    return np.nan_to_num((scene.recordings.time - start) / SECONDS_PER_HOUR)


def _rows(scene: Scene) -> Array:
    """Thousands of rows since the table's beginning."""
    return scene.row_numbers / ROWS_PER_UNIT


def _after_time(scene: Scene, start: float, run: str) -> Array:
    if scene.recordings.time is None:
        raise _missing(scene, "time_s")
    return (scene.recordings.time >= start) & (scene.recordings.run == run)


def _after_row(scene: Scene, first_row: float, run: str) -> Array:
    """Rows are counted by the table's id (its row number where it has none), within a run."""
    return (scene.row_numbers >= first_row) & (scene.recordings.run == run)


def _in_run(scene: Scene, run: str) -> Array:
    return scene.recordings.run == run


def _on_target(scene: Scene, target: str) -> Array:
    return scene.recordings.target == target


def _on_target_in_run(scene: Scene, target: str, run: str) -> Array:
    return (scene.recordings.target == target) & (scene.recordings.run == run)


def _spline(scene: Scene, source: Driver, centre: float, width: float) -> Array:
    return cubic_spline(scene.driver(source), centre, width)


def cubic_spline(at: Array, centre: float, width: float) -> Array:
    """Cubic B-spline: a smooth bump about ``centre``, zero beyond two widths."""
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


def _crank_to_upper_arm(scene: Scene) -> Array:
    return scene.elbow_angle + scene.linkage.crank_angle


def _away_from_zero(values: Array) -> Array:
    """A flat parallelogram has no defined forearm; its neighbourhood must not swamp everything else."""
    return np.where(np.abs(values) < 0.1, np.where(values < 0, -0.1, 0.1), values)


def _missing(scene: Scene, column: str) -> InputError:
    return InputError(
        scene.recordings.source,
        "line 1",
        f"no column {column}",
        "an effect in the model follows this column",
        "Add it to the table.",
    )


KINDS: dict[str, Callable[..., Any]] = {
    "one": _one,
    "angle": _angle,
    "sine": _sine,
    "cosine": _cosine,
    "chain sine": _chain_sine,
    "chain cosine": _chain_cosine,
    "chain angle": _chain_angle,
    "payload": _payload,
    "force": _force,
    "torque": _torque,
    "gravity torque": _gravity_torque,
    "payload torque": _payload_torque,
    "heavier": _heavier,
    "off centre": _off_centre,
    "regressor": _regressor,
    "load side": _load_side,
    "moment": _moment,
    "bend": _bend,
    "approach": _approach,
    "lost motion": _lost_motion,
    "speed": _speed,
    "warmth": _warmth,
    "hours": _hours,
    "rows": _rows,
    "after time": _after_time,
    "after row": _after_row,
    "in run": _in_run,
    "on target": _on_target,
    "on target in run": _on_target_in_run,
    "spline": _spline,
    "rod": _rod,
    "rocker": _rocker,
}
