"""A description predicts its own kinematics, in its base frame."""

from pathlib import Path

import numpy as np

from armscope.compensation.predicting import predict_file
from armscope.recordings import read_recordings
from armscope.robot import forward_kinematics, load_arm

EXAMPLE = Path(__file__).parents[2] / "examples" / "five-effects"


def test_a_robot_yaml_predicts_its_kinematics():
    robot, poses = EXAMPLE / "robot.yaml", EXAMPLE / "recordings.csv"
    table, notes = predict_file(robot, poses)
    arm = load_arm(robot)
    points = forward_kinematics(arm, read_recordings(poses, arm.n_motors).motor_angles)
    np.testing.assert_allclose(table[["x_mm", "y_mm", "z_mm"]].to_numpy(), points * 1e3, atol=1e-9)
    assert notes == []
