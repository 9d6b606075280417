"""What a verdict puts right, in the layout of a controller or driver: only where its maker documents it.

Universal Robots: the file that the ROS driver takes as `kinematics_params_file` (package ur_calibration), in which
every joint has its place in the frame of the one before, behind that one's turn.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from armscope.core.types import Array
from armscope.verdict.corrections import NUMBERS, corrected_rows, place_and_angles, zero_offsets
from armscope.verdict.diagnosis import Diagnosis

UR_JOINTS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
HASH = "replace by the hash in your robot's own file of ur_calibration"
"""By which the driver compares the file with the robot: only the robot has it."""
ZEROS_IN_IT = (
    "Instead of resetting zeros and entering rows in the controller, never as well: it holds both, and done twice they "
    "are off the other way."
)
_UR = re.compile(r"\bur\s?\d+e?\b", re.IGNORECASE)


def ur_kinematics(verdict: Diagnosis) -> dict[str, Any] | None:
    """A Universal Robots arm's kinematics as its ROS driver reads them, rows and zeros put right.

    Standard D-H rows are cut where a and alpha of one joint meet d and theta of the next, as ur_calibration does. What
    stands behind the last joint (a and alpha of its row) has no place in the file.

    Args:
        verdict: of the arm.

    Returns:
        {"kinematics": {joint: {x, y, z (m), roll, pitch, yaw (rad)}, "hash": what to put there}}; None for other arms,
        and without D-H rows.
    """
    arm = verdict.model.arm
    rows = corrected_rows(verdict)
    if rows is None or len(rows) != len(UR_JOINTS) or arm.is_modified_dh or not _UR.search(arm.name):
        return None
    a, alpha, d, theta, beta = (rows[f"corrected_{name}"].to_numpy(float) for name in NUMBERS)
    zeros = np.radians(theta + zero_offsets(verdict)["actual_minus_commanded_deg"].to_numpy(float))
    before = np.eye(4)
    joints: dict[str, Any] = {}
    for j, name in enumerate(UR_JOINTS):
        place, angles = place_and_angles(before @ _moved(z=1e-3 * d[j]) @ _turned(2, zeros[j]))
        keys = ("x", "y", "z", "roll", "pitch", "yaw")
        joints[name] = dict(zip(keys, map(float, (*place, *angles)), strict=True))
        before = _moved(x=1e-3 * a[j]) @ _turned(0, np.radians(alpha[j])) @ _turned(1, np.radians(beta[j]))
    return {"kinematics": {**joints, "hash": HASH}}


def _moved(x: float = 0.0, z: float = 0.0) -> Array:
    placement = np.eye(4)
    placement[[0, 2], 3] = x, z
    return placement


def _turned(axis: int, radians: float) -> Array:
    """(4, 4) a turn about x (0), y (1) or z (2)."""
    placement, (one, two) = np.eye(4), ((axis + 1) % 3, (axis + 2) % 3)
    placement[one, one] = placement[two, two] = np.cos(radians)
    placement[one, two], placement[two, one] = -np.sin(radians), np.sin(radians)
    return placement
