"""Files in the layout of a controller: read as its maker reads them, they put the tool in the right place."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.robot.arm import Arm, build_arm
from armscope.robot.controllers import UR_JOINTS, ur_kinematics
from armscope.robot.library import nominal_description

UR5E = {
    "shoulder": (0, 0, 0.1625), "upper_arm": (0, 0, 0), "forearm": (-0.425, 0, 0), "wrist_1": (-0.3922, 0, 0.1333),
    "wrist_2": (0, -0.0997, 0), "wrist_3": (0, 0.0996, 0),
}  # fmt: skip
"""Where Universal Robots' own description of a UR5e puts each joint, m (ur_description, nominal numbers)."""


def ur5e() -> Arm:
    return build_arm(nominal_description("ur5e"))


def tool_of(kinematics: dict[str, Any], angles: np.ndarray) -> np.ndarray:
    """(3,) the last joint's place: origins one behind the other, each joint turning about its own z."""
    turn, place = Rotation.identity(), np.zeros(3)
    for name, motor in zip(UR_JOINTS, angles, strict=True):
        at = kinematics["kinematics"][name]
        place = place + turn.apply([at["x"], at["y"], at["z"]])
        turn = turn * Rotation.from_euler("xyz", [at["roll"], at["pitch"], at["yaw"]]) * Rotation.from_euler("z", motor)
    return place


def test_a_nominal_ur5e_is_what_its_maker_publishes() -> None:
    written = ur_kinematics(ur5e())
    assert written is not None
    for name, place in UR5E.items():
        at = written["kinematics"][name]
        np.testing.assert_allclose([at["x"], at["y"], at["z"]], place, atol=1e-9)
    rolls = [abs(written["kinematics"][name]["roll"]) for name in UR_JOINTS]
    np.testing.assert_allclose(rolls, [0, np.pi / 2, 0, 0, np.pi / 2, np.pi / 2], atol=1e-9)


@pytest.mark.parametrize("name", ["irb120", "panda", "kr6-r900"])
def test_other_makers_arms_have_no_such_file(name: str) -> None:
    assert ur_kinematics(build_arm(nominal_description(name))) is None
