"""Every sample of the table that is written keeps clear of floor, arm and limits, by kinematics of this file's own."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.poses.exciting.output import trajectory_table
from armscope.poses.exciting.search import MotionRequest, excite, times_of_table
from armscope.poses.obstacles import Surroundings
from armscope.robot import Arm
from armscope.robot.arm import build_arm
from armscope.robot.description import RobotDescription
from armscope.robot.library import nominal_description

RADIUS, SHORT = 0.075, 0.02
LINKS = (
    (7.37, (0.02, -26, 2), (0.036113, 0.036113, 0.018425)),
    (13.05, (380, 0, 158), (0.04698, 0.815625, 0.815625)),
    (3.99, (240, 0, 68), (0.009975, 0.1596, 0.1596)),
    (2.1, (0, 7, 18), (0.00525, 0.00525, 0.00336)),
    (1.98, (0, -7, 18), (0.00495, 0.00495, 0.003168)),
    (0.615, (0, 0, -26), (0.0005535, 0.0005535, 0.000984)),
)
LIMITS = [[-170, 170], [-160, -20], [-140, 140], [-180, 180], [-175, 175], [-180, 180]]
Piece = tuple[Array, Array]
"""(N, 3) ends, m."""


def arm_of_ur10e() -> Arm:
    """The arm of the built-in rows, with masses, limits and a tool."""
    dh = nominal_description("ur10e").model_dump()["dh"]
    links = [{"mass_kg": m, "com_mm": list(c), "inertia_kg_m2": [*i, 0, 0, 0]} for m, c, i in LINKS]
    content = {"name": "UR10e", "dh": dh, "links": links, "joint_limits_deg": LIMITS, "tool_mm": [30.0, -45.0, 80.0]}
    return build_arm(RobotDescription.model_validate(content))


def turned(angle: Array, alpha: float, a: float, d: float) -> tuple[Array, Array]:
    """(N, 4, 4) up to the common normal, and along it, of a standard D-H row."""
    first, then = np.zeros((len(angle), 4, 4)), np.eye(4)
    first[:, 0, 0] = first[:, 1, 1] = np.cos(angle)
    first[:, 1, 0] = np.sin(angle)
    first[:, 0, 1] = -first[:, 1, 0]
    first[:, 2, 2] = first[:, 3, 3] = 1
    first[:, 2, 3] = d
    cos, sin = np.cos(alpha), np.sin(alpha)
    then[1:3, 1:3], then[0, 3] = [[cos, -sin], [sin, cos]], a
    return first, first @ then


def pieces(arm: Arm, q: Array) -> list[Piece]:
    """The lines from axis to axis, and to the tool, at poses (N, 6)."""
    stands, points = np.tile(np.eye(4), (len(q), 1, 1)), [np.zeros((len(q), 3))]
    assert arm.description.dh is not None
    for j, row in enumerate(arm.description.dh.joints):
        angle = q[:, j] + np.radians(row.theta_offset_deg)
        along, whole = turned(angle, np.radians(row.alpha_deg), 1e-3 * row.a_mm, 1e-3 * row.d_mm)
        points += [(stands @ along)[:, :3, 3], (stands @ whole)[:, :3, 3]]
        stands = stands @ whole
    points.append((stands @ [*(1e-3 * np.array(arm.description.tool_mm)), 1.0])[:, :3])
    lines = pairwise(points)
    return [(start, end) for start, end in lines if np.linalg.norm(end[0] - start[0]) > SHORT]


def between(one: Piece, other: Piece) -> Array:
    """(N,) distance of two lines, by points along them: never less than it is."""
    at = np.linspace(0, 1, 9)[:, None, None]
    here, there = (start + at * (end - start) for start, end in (one, other))
    return np.linalg.norm(here[:, None] - there[None], axis=-1).min(axis=(0, 1))


def test_every_sample_of_the_table_keeps_clear() -> None:
    """Seen: an elbow at 69 mm over the floor between poses that were looked at, with links 75 mm thick."""
    arm = arm_of_ur10e()
    found = excite(arm, MotionRequest(), Surroundings(RADIUS, 0.0))
    table = trajectory_table(found, 100.0)
    q = table[[f"q{j}_rad" for j in range(1, 7)]].to_numpy()
    low, high = arm.limits.T
    assert np.all((q >= np.where(np.isfinite(low), low, -np.pi)) & (q <= np.where(np.isfinite(high), high, np.pi)))
    rng = np.random.default_rng(0)
    body, anywhere = pieces(arm, q), pieces(arm, rng.uniform(-np.pi, np.pi, (300, 6)))
    lowest = [
        end[:, 2].min() for (_, end), (_, other) in zip(body, anywhere, strict=True) if np.ptp(other[:, 2]) > 1e-6
    ]
    assert min(lowest) >= RADIUS
    for one, other in combinations(range(len(body)), 2):
        always = np.mean(between(anywhere[one], anywhere[other]) < 2 * RADIUS) > 0.5
        if other - one > 1 and not always:
            assert between(body[one], body[other]).min() >= 2 * RADIUS


@pytest.mark.long
def test_a_table_of_more_samples_than_are_looked_at_keeps_clear_too() -> None:
    arm = arm_of_ur10e()
    found = excite(arm, MotionRequest(rounds=40, rate=400.0), Surroundings(RADIUS, 0.0))
    q = trajectory_table(found, 400.0)[[f"q{j}_rad" for j in range(1, 7)]].to_numpy()
    assert len(q) == len(times_of_table(20.0, 400.0)) == 8001
    assert min(end[:, 2].min() for _, end in pieces(arm, q)[1:]) >= RADIUS
