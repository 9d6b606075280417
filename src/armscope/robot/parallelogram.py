"""The five-bar linkage of a parallelogram arm, its loop closed exactly.

In the plane of the upper arm, seen from the shoulder S: the upper arm reaches the elbow E, the crank (motor 3)
reaches the crank pin C, the rod joins C to the rocker pin R, and the rocker E-R is part of the forearm.
The paper's Eqs. (1)-(2) with theta1_bar = theta3, theta2_bar = theta2 - theta3, theta2_bar + theta3_bar = pi and
equal opposite sides make the rocker parallel to the crank, so the forearm's angle in the serial chain is
theta3 - theta2: the `actuation` row {q3: 1, q2: -1}.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import Parallelogram


@dataclass(frozen=True)
class Linkage:
    """Lengths of the four bars, m; ``crank_angle`` from the forearm's x axis to the rocker, rad."""

    crank: float
    rocker: float
    rod: float
    upper_arm: float
    crank_angle: float = 0.0

    @classmethod
    def from_description(cls, linkage: Parallelogram) -> Linkage:
        """The linkage that a robot.yaml states."""
        return cls(
            linkage.crank_mm * 1e-3,
            linkage.rocker_mm * 1e-3,
            linkage.rod_mm * 1e-3,
            linkage.upper_arm_mm * 1e-3,
            np.radians(linkage.crank_angle_deg),
        )


def forearm_deviation(linkage: Linkage, elbow_angle: Array) -> Array:
    """How far the forearm turns beyond the ideal parallelogram, rad; NaN where the loop can't close.

    Args:
        elbow_angle: (N,) angle of the chain's third joint, from the upper arm's direction to the forearm's x axis, rad.

    The rod's length fixes the rocker: |E + k u(psi) - C| = r with crank c u(gamma) and upper arm l along x gives
    cos(psi - angle(d)) = (r^2 - |d|^2 - k^2) / (2 k |d|) for d = E - C; of the two solutions the one near gamma counts.
    """
    gamma = np.asarray(elbow_angle, dtype=float) + linkage.crank_angle
    d = np.stack([linkage.upper_arm - linkage.crank * np.cos(gamma), -linkage.crank * np.sin(gamma)])
    distance = np.hypot(d[0], d[1])
    with np.errstate(invalid="ignore"):
        half = np.arccos((linkage.rod**2 - distance**2 - linkage.rocker**2) / (2 * linkage.rocker * distance))
    towards = np.arctan2(d[1], d[0])
    branches = np.stack([towards + half - gamma, towards - half - gamma])
    branches = (branches + np.pi) % (2 * np.pi) - np.pi
    nearest = np.argmin(np.abs(np.nan_to_num(branches, nan=np.inf)), axis=0)
    deviation: Array = np.take_along_axis(branches, nearest[None], axis=0)[0]
    return deviation
