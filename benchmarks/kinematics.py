"""Positions and all frame Jacobians per second, beside a loop over pinocchio, in one run on one core.

Order alternates every round; the ratio of each round counts; both must give the same positions and joint Jacobians.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pinocchio as pin

from armscope.robot import Arm, chain, load_arm, position_jacobian, twist_jacobian
from armscope.robot.model import TIP

POSES, ROUNDS = 10_000, 7
ROBOT = Path(__file__).parents[1] / "config" / "robots" / "seven-axis.yaml"


def positions_and_jacobians(arm: Arm, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ours: tool points and Jacobians by motors, all poses at once."""
    frames = chain(arm, angles)
    return frames.tool, position_jacobian(arm, frames)


def all_frame_jacobians(arm: Arm, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ours: the same, and the displacement by all six twists at every joint's frame."""
    frames = chain(arm, angles)
    for joint in range(1, arm.n_joints + 1):
        twist_jacobian(frames, f"joint {joint}")
    return frames.tool, position_jacobian(arm, frames)


def pinocchio_loop(arm: Arm, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tool points and Jacobians by motors with pinocchio, pose by pose."""
    model = arm.model.copy()
    tip = model.frames[model.getFrameId(TIP)]
    placement = tip.placement * pin.SE3(np.eye(3), arm.tool)
    tool = model.addFrame(pin.Frame("tool", tip.parentJoint, 0, placement, pin.FrameType.OP_FRAME))
    data = model.createData()
    points, jacobians = np.empty((len(angles), 3)), np.empty((len(angles), 3, arm.n_joints))
    for row, theta in enumerate(angles @ arm.actuation.T):
        jacobians[row] = pin.computeFrameJacobian(model, data, theta, tool, pin.LOCAL_WORLD_ALIGNED)[:3]
        points[row] = pin.updateFramePlacement(model, data, tool).translation
    return points, jacobians @ arm.actuation


def main() -> None:
    """Time both, alternating, and print poses per second and the ratio."""
    arm = load_arm(ROBOT)
    angles = np.random.default_rng(0).uniform(-2, 2, (POSES, arm.n_motors))
    for mine, theirs in zip(positions_and_jacobians(arm, angles), pinocchio_loop(arm, angles), strict=True):
        assert np.abs(mine - theirs).max() < 1e-9, "both must compute the same"
    functions = (positions_and_jacobians, all_frame_jacobians, pinocchio_loop)
    seconds = np.empty((ROUNDS, len(functions)))
    for number in range(ROUNDS):
        for which in np.roll(range(len(functions)), number):
            start = time.process_time()
            functions[which](arm, angles)
            seconds[number, which] = time.process_time() - start
    print(f"{arm.name}, {POSES} poses, {ROUNDS} rounds, CPU time; ratio to the pinocchio loop of the same round")
    for which, function in enumerate(functions):
        ratios = seconds[:, -1] / seconds[:, which]
        print(
            f"  {function.__name__:24s} {POSES / np.median(seconds[:, which]):10,.0f} poses/s"
            f"  x {np.median(ratios):.2f} ({ratios.min():.2f}-{ratios.max():.2f})"
        )


if __name__ == "__main__":
    main()
