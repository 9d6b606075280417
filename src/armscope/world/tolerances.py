"""Geometric errors of tolerance size: what machining and assembly leave wrong in an arm, and where its tool then is.

Each error is a small twist in the exact forward model: the D-H values of each row (and a turn about y where two axes
are parallel, since D-H values alone can't tilt them: Hayati & Mirmirani 1985), and the six of the base's registration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armscope.core.types import Array
from armscope.robot import Arm, Chain, chain, forward_kinematics, twist_jacobian

PARALLEL = np.sin(np.radians(5))


@dataclass(frozen=True)
class GeometricErrors:
    """K possible errors of an arm and their tolerances."""

    arm: Arm
    names: tuple[str, ...]  # "a2", "alpha2", "d2", "theta2", "beta2", "base x", ...
    locations: tuple[str, ...]  # where the twist acts: "base", "joint j" or "link j"
    directions: Array  # (K, 6) twist of a unit error (m or rad) in that frame
    sigmas: Array  # (K,) one-sigma sizes, m or rad
    angular: NDArray[np.bool_]  # (K,) whether it is an angle

    def jacobian(self, frames: Chain) -> Array:
        """(N, 3, K) displacement of the tool, m, per error of one sigma."""
        by_location = {location: twist_jacobian(frames, location) for location in dict.fromkeys(self.locations)}
        columns = [
            by_location[location] @ direction
            for location, direction in zip(self.locations, self.directions, strict=True)
        ]
        return np.stack(columns, axis=2) * self.sigmas

    def frames(self, motor_angles: Array, in_sigmas: Array) -> Chain:
        """All frames of one arm with errors ``in_sigmas`` (K,) at ``motor_angles`` (N, m), exactly."""
        twists: dict[str, Array] = {}
        for size, location, direction in zip(in_sigmas * self.sigmas, self.locations, self.directions, strict=True):
            twists[location] = twists.get(location, np.zeros(6)) + size * direction
        return chain(self.arm, motor_angles, twists)

    def positions(self, motor_angles: ArrayLike, in_sigmas: ArrayLike) -> Array:
        """(R, N, 3) exact tool points, m, of R arms with errors ``in_sigmas`` (R, K) at ``motor_angles`` (N, m)."""
        angles = np.asarray(motor_angles, dtype=float)
        sizes = np.atleast_2d(np.asarray(in_sigmas, dtype=float)) * self.sigmas
        n_poses, n_robots = len(angles), len(sizes)
        twists: dict[str, Array] = {}
        for k, location in enumerate(self.locations):
            twist = sizes[:, k, None] * self.directions[k]
            twists[location] = twists.get(location, np.zeros((n_robots, 6))) + twist
        per_row = {location: np.repeat(twist, n_poses, axis=0) for location, twist in twists.items()}
        tool = forward_kinematics(self.arm, np.tile(angles, (n_robots, 1)), per_row)
        return tool.reshape(n_robots, n_poses, 3)


def geometric_errors(
    arm: Arm, link_m: float = 1e-3, link_rad: float = 1e-3, base_m: float = 3e-3, base_rad: float = 3e-3
) -> GeometricErrors:
    """The geometric errors of an arm, with one-sigma sizes per link and for the base.

    D-H rows give their values' errors; a URDF has no such rows, so each joint's frame may be shifted and turned.

    Args:
        arm: the nominal arm.
        link_m, link_rad: one-sigma sizes of a link's shifts and turns.
        base_m, base_rad: of the base's.

    Returns:
        Names, locations, directions and sizes of all of them.
    """
    rows = [(name, "base", twist, base_rad if angular else base_m, angular) for name, twist, angular in _frame("base ")]
    for number in range(1, arm.n_joints + 1):
        location, errors = _of_joint(arm, number)
        rows += [(name, location, twist, link_rad if angular else link_m, angular) for name, twist, angular in errors]
    names, locations, directions, sigmas, angulars = zip(*rows, strict=True)
    return GeometricErrors(arm, names, locations, np.array(directions), np.array(sigmas), np.array(angulars))


UnitError = tuple[str, Array, bool]  # Name, twist of a unit error, whether it is an angle


def _frame(prefix: str = "", suffix: str = "") -> list[UnitError]:
    """Shifts and turns of a whole frame."""
    names = ("x", "y", "z", "rx", "ry", "rz")
    return [
        (f"{prefix}{name}{suffix}", twist, k >= 3) for k, (name, twist) in enumerate(zip(names, np.eye(6), strict=True))
    ]


def _of_joint(arm: Arm, number: int) -> tuple[str, list[UnitError]]:
    """Where the errors of row ``number`` act, and what they are."""
    if arm.description.dh is None:
        return f"joint {number}", _frame(suffix=str(number))
    row = arm.description.dh.joints[number - 1]
    alpha, a, d = np.radians(row.alpha_deg), row.a_mm * 1e-3, row.d_mm * 1e-3
    location, directions = (_modified_row if arm.is_modified_dh else _standard_row)(a, alpha, d)
    between_axes = 0 < number - arm.is_modified_dh < arm.n_joints
    if abs(np.sin(alpha)) >= PARALLEL or not between_axes:
        del directions["beta"]
    errors = [(f"{name}{number}", twist, name not in ("a", "d")) for name, twist in directions.items()]
    return f"{location} {number}", errors


def _standard_row(a: float, alpha: float, d: float) -> tuple[str, dict[str, Array]]:
    """Unit errors of Rz(theta) Tz(d) Tx(a) Rx(alpha) as twists in link frame j."""
    axis = np.array([0.0, np.sin(alpha), np.cos(alpha)])  # the joint's axis, seen from behind the twist alpha
    x, y, zero = np.eye(3)[0], np.eye(3)[1], np.zeros(3)
    return "link", {
        "a": np.concatenate([x, zero]),
        "alpha": np.concatenate([zero, x]),
        "d": np.concatenate([axis, zero]),
        "theta": np.concatenate([np.cross(axis, a * x), axis]),
        "beta": np.concatenate([zero, y]),
    }


def _modified_row(a: float, alpha: float, d: float) -> tuple[str, dict[str, Array]]:
    """Unit errors of Rx(alpha) Tx(a) Rz(theta) Tz(d) as twists in joint frame j, before it turns."""
    x, y, z = np.eye(3)
    zero = np.zeros(3)
    return "joint", {
        "a": np.concatenate([x, zero]),
        "alpha": np.concatenate([np.cross(x, d * z), x]),
        "d": np.concatenate([z, zero]),
        "theta": np.concatenate([zero, z]),
        "beta": np.concatenate([zero, y]),
    }
