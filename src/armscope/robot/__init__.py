"""What the arm is: its description, kinematics, parallelogram and gravity loads.

Each is imported when it is first asked for: a description that can't be used is refused without kinematics.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.robot.arm import Arm, load_arm
    from armscope.robot.description import RobotDescription
    from armscope.robot.description_file import load_description
    from armscope.robot.kinematics import (
        Chain,
        chain,
        forward_kinematics,
        position_jacobian,
        tool_frames,
        twist_jacobian,
    )

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
_HOMES = {"Arm": "arm", "load_arm": "arm", "RobotDescription": "description", "load_description": "description_file"}
"""Of all others: `kinematics`."""


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES.get(name, 'kinematics')}"), name)
