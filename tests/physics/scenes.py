"""Arms and tables with every kind of context, random but seeded; no measured positions are needed here."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from armscope.recordings import Recordings
from armscope.robot import Arm, load_arm
from armscope.robot.arm import build_arm

ROBOTS = Path(__file__).parents[2] / "config" / "robots"
ARMS = ("parallelogram-120kg", "six-axis", "seven-axis")
FOUR_AXES = {"four-axis": "six-axis", "four-axis-modified": "seven-axis"}
"""Arms without their wrists: a diagnosis of one takes about half as long, where the claim is of no wrist."""


def arm_named(name: str) -> Arm:
    if name not in FOUR_AXES:
        return load_arm(ROBOTS / f"{name}.yaml")
    whole = load_arm(ROBOTS / f"{FOUR_AXES[name]}.yaml").description
    assert whole.links is not None
    assert whole.joint_limits_deg is not None
    dh = whole.dh.model_copy(update={"joints": whole.dh.joints[:4]})
    shorter = {"name": "4-axis arm", "dh": dh, "links": whole.links[:4], "joint_limits_deg": whole.joint_limits_deg[:4]}
    return build_arm(whole.model_copy(update=shorter))


def full_table(arm: Arm, rows: int, seed: int) -> Recordings:
    """Random poses with payload, temperature, time, approach and speed, in two runs with two targets."""
    rng = np.random.default_rng(seed)
    middle, half = arm.limits.mean(axis=1), np.ptp(arm.limits, axis=1) / 2
    angles = middle + 0.6 * half * rng.uniform(-1, 1, (rows, arm.n_motors))
    if arm.description.parallelogram is not None:
        angles[:, 2] = angles[:, 1] + rng.uniform(-0.7, 0.7, rows)
    return Recordings(
        motor_angles=angles,
        positions=np.full((rows, 3), np.nan),
        run=np.where(np.arange(rows) < rows // 2, "1", "2"),
        target=np.where(rng.random(rows) < 0.5, "p1", "p2"),
        id=np.arange(1, rows + 1).astype(str),
        time=np.sort(rng.uniform(0, 7200, rows)),
        temperature=rng.uniform(18, 27, rows),
        payload=rng.choice([0.0, 10.0], rows),
        approach=rng.choice([-1.0, 1.0], angles.shape),
        speed=rng.uniform(-0.5, 0.5, angles.shape),
    )
