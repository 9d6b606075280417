"""Of a URDF's joint no direction is told that a zero says as well; together they say all that six directions do."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from armscope.core.types import Array
from armscope.physics.effect import AXES
from armscope.physics.joint_directions import directions_of_a_joint
from armscope.robot.kinematics import forward_kinematics
from tests.robot.test_urdf import TORSO_ARM
from tests.robot.test_urdf import build as build_urdf


def test_of_a_urdfs_joints_no_direction_is_told_that_a_zero_says_as_well() -> None:
    """With all of them, zeros of joints 2 to 4 of an arm like the UR5e were told as shifts of the joints behind."""
    arm = build_urdf()
    angles = np.random.default_rng(1).uniform(-1.5, 1.5, (60, arm.n_motors))
    stands, step = forward_kinematics(arm, angles), 1e-6

    def moved(joint: int, twist: Array) -> Array:
        return (forward_kinematics(arm, angles, {f"joint {joint}": step * twist}) - stands).ravel() / step

    def rank(directions: list[Array]) -> int:
        columns = np.column_stack(directions)
        return int(np.linalg.matrix_rank(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-9), tol=1e-4))

    told, every = [], []
    for joint in range(1, arm.n_joints + 1):
        units = [moved(joint, unit) for unit in np.eye(6)]
        every += units
        told_here = directions_of_a_joint(arm, joint)
        assert len(told_here) == (5 if joint == 1 else 4)
        told.append(units[5])
        told += [moved(joint, twist) for twist in told_here.values()]
    assert len(told) < len(every)
    assert rank(told) == rank(every)


@pytest.mark.parametrize(("leans", "left_out"), [(0.0, "ty"), (0.02, "ty"), (np.pi / 2, "rx")])
def test_of_axes_that_are_parallel_or_nearly_it_is_a_shift(leans: float, left_out: str, tmp_path: Path) -> None:
    file = ElementTree.parse(TORSO_ARM)
    joint = next(each for each in file.getroot().findall("joint") if each.get("name") == build_urdf().joint_names[1])
    turning, origin = joint.find("axis"), joint.find("origin")
    assert turning is not None
    assert origin is not None
    turning.set("xyz", "0 0 1")
    origin.set("xyz", "0.4 0 0.1")
    origin.set("rpy", f"{leans} 0 0")
    file.write(tmp_path / "arm.urdf")
    told = directions_of_a_joint(build_urdf(tmp_path / "arm.urdf"), 2)
    assert set(AXES) - set(told) - {"rz"} == ({left_out} if leans < 1 else {"ry"})
