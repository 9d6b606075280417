"""What effects follow, evaluated for all rows of a table; those of angles, others stand in files of their own.

A driver's value is zero where its context was not recorded, so that a missing value neither helps nor hurts.
"""

from __future__ import annotations

import functools

import numpy as np

from armscope.core.types import Array
from armscope.physics.linkage_drivers import BARS
from armscope.physics.load_drivers import LOADS
from armscope.physics.loaded_arm import LoadedArm
from armscope.physics.recorded_drivers import RECORDED, side_of_approach
from armscope.physics.terms import Driver, DriverKind


def driver_values(scene: LoadedArm, driver: Driver) -> Array:
    """Values (N,) of a driver at the scene's rows, in SI units (time in hours).

    Raises:
        InputError: the recordings lack the column that the driver needs.
    """
    return np.asarray(KINDS[driver.kind].values(scene, *driver.arguments), dtype=np.float64)


def _one(scene: LoadedArm) -> Array:
    return np.ones(len(scene))


def _angle(scene: LoadedArm, j: int, low: float = -np.inf, high: float = np.inf) -> Array:
    """Motor angle j, rad; held at the ends of a range where one is given (a full turn away is the same place)."""
    angle = scene.recordings.motor_angles[:, j - 1]
    if np.isinf(low) and np.isinf(high):
        return angle
    beyond = (angle < low) | (angle > high)
    turned = (low + high) / 2 + np.remainder(angle - (low + high) / 2 + np.pi, 2 * np.pi) - np.pi
    return np.clip(np.where(beyond, turned, angle), low, high)


def _sine(scene: LoadedArm, j: int, periods: float, *ends: float) -> Array:
    return np.sin(periods * _angle(scene, j, *ends))


def _cosine(scene: LoadedArm, j: int, periods: float, *ends: float) -> Array:
    return np.cos(periods * _angle(scene, j, *ends))


def _chain_sine(scene: LoadedArm, j: int, periods: int) -> Array:
    return np.sin(periods * scene.chain_angles[:, j - 1])


def _chain_cosine(scene: LoadedArm, j: int, periods: int) -> Array:
    return np.cos(periods * scene.chain_angles[:, j - 1])


def _chain_angle(scene: LoadedArm, j: int) -> Array:
    return scene.chain_angles[:, j - 1]


def _attitude(scene: LoadedArm, row: int, column: int) -> Array:
    """An entry of the tool's rotation R in base axes, counted from 1: the side that it turns to the instrument."""
    entry: Array = scene.nominal.tool_rotation[:, row - 1, column - 1]
    return entry


def _attitude_twice(scene: LoadedArm, row: int, column: int) -> Array:
    """The same of degree two: tr(S_row R S_column R^T), S the five symmetric matrices of unit norm without a trace."""
    rotation = scene.nominal.tool_rotation
    seen = np.einsum("nij,jl,nkl->nik", rotation, _quadrupole(column), rotation, optimize=True)
    return np.asarray(np.einsum("ik,nik->n", _quadrupole(row), seen))


def _quadrupole(number: int) -> Array:
    """One of an orthonormal basis of symmetric 3 x 3 matrices without a trace, counted from 1."""
    if number <= 3:
        matrix = np.zeros((3, 3))
        first, second = ((0, 1), (1, 2), (0, 2))[number - 1]
        matrix[first, second] = matrix[second, first] = np.sqrt(1 / 2)
        return matrix
    diagonal = np.array([1, -1, 0]) / np.sqrt(2) if number == 4 else np.array([1, 1, -2]) / np.sqrt(6)
    return np.asarray(np.diag(diagonal))


def _weight(scene: LoadedArm) -> Array:
    """(N, 3) share of a weight that pulls along each axis of the tool, -1 to 1."""

    def compute() -> Array:
        down = scene.arm.gravity / np.linalg.norm(scene.arm.gravity)
        return np.asarray(np.swapaxes(scene.nominal.tool_rotation, 1, 2) @ down)

    return np.asarray(scene.remember("weight in the tool", compute))


def _pull(scene: LoadedArm, axis: int) -> Array:
    return _weight(scene)[:, axis]


def _along_base(scene: LoadedArm, axis: int, in_tool: Array) -> Array:
    """What is a shift (N, 3) in the nominal tool's axes, along an axis of the base."""
    return np.asarray(np.sum(scene.nominal.tool_rotation[:, axis] * in_tool, axis=1))


def _side_along(scene: LoadedArm, axis: int, x: float, y: float, z: float, slope: float) -> Array:
    """Where something lies that slides along a direction of the tool, by one to its lower end, along a base's axis."""
    direction = np.array([x, y, z])
    pull = _weight(scene) @ direction
    return _along_base(scene, axis, np.outer(np.where(np.abs(pull) > slope, np.sign(pull), 0.0), direction))


def _side_across(scene: LoadedArm, axis: int, x: float, y: float, z: float, slope: float) -> Array:
    """The same of what slides in the plane across a direction."""
    pull, across = _weight(scene), np.array([x, y, z])
    pull = pull - np.outer(pull @ across, across)
    steep = np.linalg.norm(pull, axis=1, keepdims=True)
    return _along_base(scene, axis, np.where(steep > slope, pull / np.maximum(steep, 1e-12), 0.0))


def _sag(scene: LoadedArm, axis: int, row: int, column: int) -> Array:
    """What a symmetric matrix with ones at a place (from 1) makes of a weight in the tool, along a base's axis."""
    matrix = np.zeros((3, 3))
    matrix[row - 1, column - 1] = matrix[column - 1, row - 1] = 1.0
    return _along_base(scene, axis, _weight(scene) @ matrix)


def _lost_motion(scene: LoadedArm, j: int, centre: float, width: float) -> Array:
    """Side of approach where the joint stands near ``centre`` (a cubic spline of its angle)."""
    return side_of_approach(scene, j) * cubic_spline(_angle(scene, j), centre, width)


def _spline(scene: LoadedArm, source: Driver, centre: float, width: float) -> Array:
    return cubic_spline(scene.driver(source), centre, width)


def _held(scene: LoadedArm, source: Driver, low: float, high: float) -> Array:
    """A driver as it is in a range where what follows it is known, and the nearest end of that range beyond it."""
    return np.clip(scene.driver(source), low, high)


def _both(scene: LoadedArm, one: Driver, other: Driver) -> Array:
    """The product of two drivers: a load that acts from some moment on, say."""
    return scene.driver(one) * scene.driver(other)


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


KINDS: dict[str, DriverKind] = {
    "one": DriverKind(_one),
    "angle": DriverKind(_angle, unit="rad"),
    "sine": DriverKind(_sine),
    "cosine": DriverKind(_cosine),
    "chain sine": DriverKind(_chain_sine),
    "chain cosine": DriverKind(_chain_cosine),
    "chain angle": DriverKind(_chain_angle),
    "attitude": DriverKind(_attitude),
    "attitude twice": DriverKind(_attitude_twice),
    "pull on the target": DriverKind(_pull),
    "sag": DriverKind(_sag),
    "side along": DriverKind(_side_along),
    "side across": DriverKind(_side_across),
    "lost motion": DriverKind(_lost_motion, needs="approach"),
    "spline": DriverKind(_spline),
    "held": DriverKind(_held),
    "both": DriverKind(_both),
    **LOADS,
    **RECORDED,
    **BARS,
}
"""All kinds of drivers by name; packages bring more (`armscope.physics.registry`)."""


def kinds_in(driver: Driver) -> frozenset[str]:
    """The kinds of a driver and of those that it is a function of."""
    inner = (kinds_in(argument) for argument in driver.arguments if isinstance(argument, Driver))
    return frozenset({driver.kind}).union(*inner)


@functools.lru_cache(maxsize=100_000)
def follows(what: str, driver: Driver) -> bool:
    """Whether a driver, or one that it is a function of, depends on one of these (`DriverKind.follows`)."""
    return any(what in KINDS[kind].follows for kind in kinds_in(driver))
