"""What the arm is: its description, kinematics, parallelogram and gravity loads."""

from armscope.robot.arm import Arm, load_arm
from armscope.robot.description import RobotDescription
from armscope.robot.description_file import load_description
from armscope.robot.kinematics import Chain, chain, forward_kinematics, position_jacobian, tool_frames, twist_jacobian

__all__ = [
    "Arm",
    "Chain",
    "RobotDescription",
    "chain",
    "forward_kinematics",
    "load_arm",
    "load_description",
    "position_jacobian",
    "tool_frames",
    "twist_jacobian",
]
