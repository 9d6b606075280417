"""What gives way follows: weights, torques and moments of gravity, and how they change where a load is misstated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from armscope.core.types import Array
from armscope.physics.form_constants import FORM
from armscope.physics.loaded_arm import LoadedArm
from armscope.physics.recorded_drivers import recorded
from armscope.physics.terms import Driver, DriverKind
from armscope.robot.gravity import gravity_torques, mass_moment_regressor


def _payload(scene: LoadedArm) -> Array:
    return scene.payload


def _force(scene: LoadedArm, location: str, axis: int) -> Array:
    """Weight beyond a frame, in the frame's axes, N."""
    return scene.force(location)[:, axis]


def _torque(scene: LoadedArm, j: int) -> Array:
    """Recorded torque where there is one (positive along gravity's pull), else gravity of the stated masses."""
    return scene.torques[:, j - 1]


def _gravity_torque(scene: LoadedArm, j: int) -> Array:
    """Torque of gravity by the stated masses and payload, whatever was recorded."""
    return scene.gravity_torques[:, j - 1]


def _payload_torque(scene: LoadedArm, j: int) -> Array:
    """Torque on motor j of the payload alone."""
    return _unit_mass_torques(scene)[:, j - 1] * np.nan_to_num(recorded(scene, "payload"))


def _unit_mass_torques(scene: LoadedArm) -> Array:
    """(N, m) torque of one kilogram at the tool point."""

    def compute() -> Array:
        ones = np.ones(len(scene))
        return gravity_torques(scene.arm, scene.loaded, ones) - gravity_torques(scene.arm, scene.loaded)

    return np.asarray(scene.remember("unit mass torques", compute))


def _heavier(scene: LoadedArm, load: Driver) -> Array:
    """Change of a load driver per kilogram more at the tool point."""
    heavier = scene.remember("heavier", lambda: scene.with_heavier_payload(1.0, 0.0))
    change: Array = heavier.driver(load) - scene.driver(load)
    return change


def _heavier_during_run(scene: LoadedArm, load: Driver, *runs: str) -> Array:
    """Change of a load driver per kilogram more at the tool point, in some runs alone."""
    return np.where(np.isin(scene.recordings.run, runs), _heavier(scene, load), 0.0)


def _off_centre(scene: LoadedArm, load: Driver, axis: int) -> Array:
    """Change of a load driver per metre that the payload's centre lies off the tool point along a tool axis."""
    off = replace(scene.misstated, payload_offset=np.eye(3)[axis])
    shifted = scene.remember(("off centre", axis), lambda: scene.loaded_as(off))
    change: Array = shifted.driver(load) - scene.driver(load)
    return change


def _heavier_by_share(scene: LoadedArm, load: Driver) -> Array:
    """Change of a load driver per share of the stated payload that it is heavier."""
    heavier = scene.remember("heavier by share", lambda: scene.with_heavier_payload(0.0, 1.0))
    change: Array = heavier.driver(load) - scene.driver(load)
    return change


def _heavier_links(scene: LoadedArm, load: Driver, link: int, *links: int) -> Array:
    """Slope of a load driver over the relative error of links' masses; loads themselves are proportional to it."""
    change: Array = scene.with_heavier_links((link, *links), FORM.slope_share).driver(load) - scene.driver(load)
    return change / FORM.slope_share


def _leaning(scene: LoadedArm, load: Driver, axis: int) -> Array:
    """Slope of a load driver over the angle by which gravity turns about one of two axes across it, per rad."""
    leaning = scene.remember(("leaning", axis), lambda: scene.with_leaning_gravity(axis, FORM.slope_share))
    change: Array = leaning.driver(load) - scene.driver(load)
    return change / FORM.slope_share


def _regressor(scene: LoadedArm, j: int, *weights: float) -> Array:
    """Combination of the static torque regressor's columns of motor j: gravity torque of unknown mass moments."""
    return np.asarray(static_regressor(scene)[:, j - 1] @ np.array(weights))


def static_regressor(scene: LoadedArm) -> Array:
    """(N, m, k) gravity torque on the motors per unit of each mass moment (`mass_moment_regressor`), computed once."""
    return np.asarray(scene.remember("regressor", lambda: mass_moment_regressor(scene.arm, scene.loaded)))


def _load_side(scene: LoadedArm, j: int) -> Array:
    torque = _torque(scene, j)
    return np.where(np.abs(torque) > FORM.no_torque_nm, np.sign(torque), 0.0)


def _soft_start(scene: LoadedArm, j: int, knee: float) -> Array:
    """Turn of a drive that is softer under small loads, as a share of what it comes to; the knee in N m."""
    return np.asarray(np.tanh(_torque(scene, j) / knee))


def _moment(scene: LoadedArm, location: str, axis: int) -> Array:
    """Moment of gravity about the frame's origin, in the frame's axes, N m."""
    return scene.moment(location)[:, axis]


def _bend(scene: LoadedArm, link: int, axis: int) -> Array:
    """Twist of a link's end per unit flexibility 1/(E I), Euler-Bernoulli cantilever under end force and moment."""
    return scene.bending(link)[:, axis]


_LOAD = frozenset({"load", "payload"})
_WEIGHT = _LOAD | {"weight"}

LOADS: dict[str, DriverKind] = {
    "payload": DriverKind(_payload, follows=frozenset({"payload"})),
    "force": DriverKind(_force, follows=_WEIGHT),
    "torque": DriverKind(_torque, follows=_WEIGHT | {"torque"}, unit="N m"),
    "gravity torque": DriverKind(_gravity_torque, follows=_WEIGHT),
    "payload torque": DriverKind(_payload_torque, needs="payload", follows=_LOAD),
    "heavier": DriverKind(_heavier, follows=_LOAD),
    "heavier during run": DriverKind(_heavier_during_run, follows=_LOAD | {"run"}),
    "heavier by share": DriverKind(_heavier_by_share, follows=_LOAD),
    "heavier link": DriverKind(_heavier_links, follows=_LOAD),
    "leaning": DriverKind(_leaning, follows=_LOAD),
    "off centre": DriverKind(_off_centre, follows=_LOAD),
    "regressor": DriverKind(_regressor, follows=frozenset({"load"})),
    "load side": DriverKind(_load_side, follows=_LOAD | {"torque"}),
    "soft start": DriverKind(_soft_start, follows=_LOAD | {"torque"}),
    "moment": DriverKind(_moment, follows=_WEIGHT),
    "bend": DriverKind(_bend, follows=_WEIGHT),
}
"""Kinds of drivers by name."""
