"""An arm's kinematics in the layout of a controller or driver: only where its maker documents it.

Universal Robots: the file that the ROS driver takes as `kinematics_params_file` (package ur_calibration), in which
every joint has its place in the frame of the one before, behind that one's turn.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from armscope.core.types import Array
from armscope.robot.arm import Arm

UR_JOINTS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
UR_KINEMATICS = "ur_kinematics.yaml"
ZEROS_IN_IT = (
    "Instead of resetting zeros and entering rows in the controller, never as well: it holds both, and done twice they "
    "are off the other way."
)
HASH = "replace by the hash in your robot's own file of ur_calibration"
"""By which the driver compares the file with the robot: only the robot has it."""
_UR = re.compile(r"\bur\s?\d+e?\b", re.IGNORECASE)


def ur_kinematics(arm: Arm) -> dict[str, Any] | None:
    """A Universal Robots arm's kinematics as its ROS driver reads them.

    Standard D-H rows are cut where a and alpha of one joint meet d and theta of the next, as ur_calibration does. What
    stands behind the last joint (a and alpha of its row) has no place in the file.

    Returns:
        {"kinematics": {joint: {x, y, z (m), roll, pitch, yaw (rad)}, "hash": what to put there}}; None for other arms,
        and without D-H rows.
    """
    dh = arm.description.dh
    if dh is None or len(dh.joints) != len(UR_JOINTS) or arm.is_modified_dh or not _UR.search(arm.name):
        return None
    before = np.eye(4)
    joints: dict[str, Any] = {}
    for row, name in zip(dh.joints, UR_JOINTS, strict=True):
        place = before @ _moved(z=1e-3 * row.d_mm) @ _turned("z", row.theta_offset_deg)
        angles = Rotation.from_matrix(place[:3, :3]).as_euler("xyz", suppress_warnings=True)
        at = (*place[:3, 3] + 0.0, *angles + 0.0)  # no minus before a zero
        joints[name] = dict(zip(("x", "y", "z", "roll", "pitch", "yaw"), map(float, at), strict=True))
        before = _moved(x=1e-3 * row.a_mm) @ _turned("x", row.alpha_deg) @ _turned("y", row.beta_deg)
    return {"kinematics": {**joints, "hash": HASH}}


def _moved(x: float = 0.0, z: float = 0.0) -> Array:
    placement = np.eye(4)
    placement[[0, 2], 3] = x, z
    return placement


def _turned(axis: str, degrees: float) -> Array:
    placement = np.eye(4)
    placement[:3, :3] = Rotation.from_euler(axis, degrees, degrees=True).as_matrix()
    return placement
