"""How far a forearm turns as the bars of its parallelogram differ."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.physics.form_constants import FORM
from armscope.physics.loaded_arm import LoadedArm
from armscope.physics.terms import DriverKind


def _rod(scene: LoadedArm) -> Array:
    """Forearm angle per metre that rod minus upper arm differs from the parallelogram: -1 / (k sin gamma)."""
    gamma = _crank_to_upper_arm(scene)
    return -1.0 / (scene.linkage.rocker * _away_from_zero(np.sin(gamma)))


def _rocker(scene: LoadedArm) -> Array:
    """Forearm angle per metre that rocker minus crank differs from the parallelogram: cot(gamma) / k."""
    gamma = _crank_to_upper_arm(scene)
    return np.cos(gamma) / (scene.linkage.rocker * _away_from_zero(np.sin(gamma)))


def _rod_share(scene: LoadedArm, crank_angle: float) -> Array:
    """As `_rod`, per share of the rocker's length, for a rocker that stands at ``crank_angle`` on the forearm, rad."""
    return -1.0 / _away_from_zero(np.sin(scene.elbow_angle + crank_angle))


def _rocker_share(scene: LoadedArm, crank_angle: float) -> Array:
    """As `_rocker`, per share of the rocker's length."""
    gamma = scene.elbow_angle + crank_angle
    return np.cos(gamma) / _away_from_zero(np.sin(gamma))


def _crank_to_upper_arm(scene: LoadedArm) -> Array:
    return scene.elbow_angle + scene.linkage.crank_angle


def _away_from_zero(values: Array) -> Array:
    """A flat parallelogram has no defined forearm; its neighbourhood must not swamp everything else."""
    return np.where(np.abs(values) < FORM.flat, np.where(values < 0, -FORM.flat, FORM.flat), values)


BARS: dict[str, DriverKind] = {
    "rod": DriverKind(_rod),
    "rocker": DriverKind(_rocker),
    "rod share": DriverKind(_rod_share),
    "rocker share": DriverKind(_rocker_share),
}
"""Kinds of drivers by name."""
