"""Random recording sessions: poses an arm can take, and what went on around them.

A pose rule says how the poses are drawn. `free` covers the arm's range; the others leave out what would
separate two effects.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.layout import Geometry, Layout
from armscope.world.mechanism import Mechanism
from armscope.world.statics import Session

PoseRule = Literal["free", "lockstep", "narrow", "no_payload", "constant_speed", "warming_in_step", "in_order", "few"]
POSE_RULES: dict[str, str] = {
    "free": "random over the joints' ranges, all context varies",
    "lockstep": "joint 3 follows joint 2 to within 0.003 rad",
    "narrow": "every joint moves within a tenth of its range",
    "no_payload": "never a payload",
    "constant_speed": "each joint's speed is proportional to its angle",
    "warming_in_step": "the temperature rises in step with time",
    "in_order": "joint 2 goes from one end of its range to the other in the course of the session, and it gets warmer",
    "few": "two dozen poses, again and again",
}

LOWEST_TOOL_M = 0.05
FEW_POSES = 24
SLACK_OF_PARALLELOGRAM_RAD = 1.2
"""Elbow angles of a parallelogram arm stay this close to square, so that the linkage never comes near collinear."""


def random_session(
    description: RobotDescription,
    rng: np.random.Generator,
    count: int,
    rule: str,
    largest_payload: float,
    warming: float,
) -> Session:
    """A session of ``count`` rows in order of time.

    Args:
        description: the arm; its joint limits bound the poses.
        rng: source of all randomness.
        count: number of rows.
        rule: one of `POSE_RULES`.
        largest_payload: kg; payloads are 0, 1, 2 or 3 thirds of it.
        warming: span of the temperature over the session, K.

    Returns:
        Commanded angles, rad, and the context of every row.
    """
    commanded = _reachable_poses(description, rng, FEW_POSES if rule == "few" else count, rule)
    if rule == "few":
        commanded = commanded[rng.integers(0, FEW_POSES, count)]
    if rule == "in_order":
        commanded = commanded[np.argsort(commanded[:, 1])]
    motors = commanded.shape[1]
    run, time = _runs(rng, count)
    payload = rng.integers(0, 4, count) * (largest_payload / 3)
    approach = rng.choice([-1.0, 1.0], (count, motors))
    speed = rng.uniform(-0.6, 0.6, (count, motors)).round(3)
    temperature = _temperature(rng, time, warming)
    if rule == "no_payload":
        payload = np.zeros(count)
    if rule == "constant_speed":
        speed = 0.3 * commanded
    if rule in ("warming_in_step", "in_order"):
        temperature = (20.5 + warming * time / time[-1] + rng.normal(0, 0.01 * warming, count)).round(2)
    return Session(commanded, np.asarray(payload.round(3), dtype=float), time, temperature, run, approach, speed)


def _reachable_poses(description: RobotDescription, rng: np.random.Generator, count: int, rule: str = "free") -> Array:
    """(count, m) motor angles, rad, of a rule: tool above the floor and clear of the base, rounded to 1e-7 rad.
    Raises RuntimeError: hardly any pose of the rule can be reached."""
    assert description.joint_limits_deg is not None, "worlds need joint limits"
    geometry = Geometry(description)
    mechanism = Mechanism(geometry, Layout(row_errors=np.zeros((geometry.n_joints, 4))))
    limits = np.radians(np.array(description.joint_limits_deg, dtype=float))
    low, high = limits[:, 0], limits[:, 1]
    centre, half = (low + high) / 2, (high - low) / 2
    if rule == "narrow":
        centre = centre + rng.uniform(-0.6, 0.6, len(half)) * half
        half = half / 10
    clear = 0.15 * (np.abs(geometry.rows[:, [0, 2]]).sum())
    poses: list[Array] = []
    for _ in range(1000 * count):
        pose = centre + rng.uniform(-1, 1, len(half)) * half
        if rule == "lockstep":
            pose[2] = 0.6 * pose[1] + rng.normal(0, 0.003)
        pose = pose.round(7)
        if _reachable(mechanism, description, pose, clear):
            poses.append(pose)
            if len(poses) == count:
                return np.array(poses)
    raise RuntimeError(f"{description.name}: hardly any pose of the rule {rule!r} can be reached")


def _reachable(mechanism: Mechanism, description: RobotDescription, pose: Array, clear: float) -> bool:
    angles = mechanism.geometry.actuation @ pose
    if description.parallelogram is not None and abs(angles[2]) > SLACK_OF_PARALLELOGRAM_RAD:
        return False
    qpos = np.zeros(mechanism.n_freedoms)
    qpos[mechanism.angle_columns()] = angles + mechanism.rows[:, 3]
    mechanism.set_joints(qpos)
    x, y, z = mechanism.tool()
    return bool(z > LOWEST_TOOL_M and np.hypot(x, y) > clear)


def _runs(rng: np.random.Generator, count: int) -> tuple[NDArray[np.int64], Array]:
    """Runs of similar length with pauses between them; time of each row, s."""
    n_runs = int(rng.integers(2, 5))
    run = np.sort(rng.integers(1, n_runs + 1, count))
    run = np.unique(run, return_inverse=True)[1] + 1
    steps = 14 + rng.exponential(15, count)
    steps[1:] += np.where(np.diff(run) > 0, rng.uniform(600, 2200, count - 1), 0)
    return run, np.cumsum(steps).round(1)


def _temperature(rng: np.random.Generator, time: Array, span: float) -> Array:
    """A slow swing of the hall and small unrest, 0.01 degree steps."""
    phase, turns = rng.uniform(0, 2 * np.pi), rng.uniform(0.6, 1.3)
    swing = np.sin(2 * np.pi * turns * time / time[-1] + phase)
    lowest = rng.uniform(18, 22)
    return np.asarray((lowest + span * (swing + 1) / 2 + rng.normal(0, 0.01 * span, len(time))).round(2))
