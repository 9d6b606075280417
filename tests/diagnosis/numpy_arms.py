"""Arms whose kinematics are written here, in NumPy alone, and what is said of their recordings."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.recordings import Recordings
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.verdict.diagnosis import Diagnosis

QUICK = Settings(resamples=0, cross_validation=False)
ROWS, NOISE_M = 150, 5e-5
UR5E = [(0, 90, 0.1625), (-0.425, 0, 0), (-0.3922, 0, 0), (0, 90, 0.1333), (0, -90, 0.0997), (0, 0, 0.0996)]
IIWA = [(0, -90, 0.34), (0, 90, 0), (0, 90, 0.4), (0, -90, 0), (0, -90, 0.4), (0, 90, 0), (0, 0, 0.126)]
"""a (m), alpha (degrees), d (m) of their data sheets."""
TOOL_M = np.array([0.03, 0.02, 0.08])
TOLERANCE = 1.5e-4
"""Every a, d (m) and alpha (rad) is off by about this."""


def reached(rows: list[tuple[float, float, float]], errors: Array, angles: Array) -> Array:
    """(N, 3) tool points, m, of standard D-H rows with errors (n, 4) of a, alpha, d and about y at angles (N, n)."""
    points = np.tile(TOOL_M, (len(angles), 1))
    for (a, alpha, d), error, theta in zip(rows[::-1], errors[::-1], angles.T[::-1], strict=True):
        x, y, z = points.T
        s, c = np.sin(error[3]), np.cos(error[3])
        x, z = c * x + s * z, c * z - s * x
        s, c = np.sin(np.radians(alpha) + error[1]), np.cos(np.radians(alpha) + error[1])
        x, y, z = x + a + error[0], c * y - s * z, s * y + c * z + d + error[2]
        points = np.column_stack([np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y, z])
    return points


def still(values: Array, row: Array) -> None:
    """Nothing moves."""


def said(
    rows: list[tuple[float, float, float]],
    moved: Callable[[Array, Array], None],
    seed: int,
    shifted: Callable[[Array, Array], None] = still,
    skew: tuple[int, float] = (1, 0.0),
    bow: tuple[int, int, float] | None = None,
    **context: Array,
) -> Diagnosis:
    """What is said of an arm of ordinary tolerances whose angles or points, by row, were moved in some way.

    Behind D-H row ``skew[0]`` all else is turned about y by ``skew[1]``, rad; with ``bow`` = (row, joint, rad), by that
    many rad times the sine of the joint's angle, too.
    """
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-2, 2, (ROWS, len(rows)))
    true = angles.copy()
    moved(true, np.arange(ROWS))
    errors = tolerances(rows, rng)
    errors[skew[0] - 1, 3] = skew[1]
    points = bowed(rows, errors, true, bow) + NOISE_M * rng.normal(size=(ROWS, 3))
    shifted(points, np.arange(ROWS))
    table = Recordings(
        angles,
        points,
        run=context.pop("run", np.full(ROWS, "1")),
        target=np.full(ROWS, ""),
        id=np.arange(1, ROWS + 1).astype(str),
        **context,
    )
    joints = [{"a_mm": 1e3 * a, "alpha_deg": alpha, "d_mm": 1e3 * d, "theta_offset_deg": 0} for a, alpha, d in rows]
    dh = {"convention": "standard", "joints": joints}
    return diagnose(build_arm(RobotDescription.model_validate({"name": "arm", "dh": dh})), table, QUICK)


def tolerances(rows: list[tuple[float, float, float]], rng: np.random.Generator) -> Array:
    """(n, 4) errors of an arm of ordinary tolerances."""
    return np.hstack([TOLERANCE * rng.normal(size=(len(rows), 3)), np.zeros((len(rows), 1))])


def bowed(
    rows: list[tuple[float, float, float]], errors: Array, angles: Array, bow: tuple[int, int, float] | None
) -> Array:
    """`reached`, with a row that turns about y with the angle of a joint: each row of the table has its own arm."""
    if bow is None:
        return reached(rows, errors, angles)
    row, joint, size = bow
    points = np.empty((len(angles), 3))
    for n, at in enumerate(angles):
        own = errors.copy()
        own[row - 1, 3] += size * np.sin(at[joint - 1])
        points[n] = reached(rows, own, at[None, :])[0]
    return points
