"""What a verdict puts right, in the layout of a controller or driver."""

from __future__ import annotations

from typing import Any

from armscope.robot import controllers
from armscope.robot.arm import build_arm
from armscope.verdict.corrections import NUMBERS, changes, corrected_rows, zero_offsets
from armscope.verdict.diagnosis import Diagnosis


def corrected_ur_kinematics(verdict: Diagnosis) -> dict[str, Any] | None:
    """`armscope.robot.controllers.ur_kinematics` of an arm whose rows and zeros are put right.

    None where nothing is: a file of the nominal arm would undo what the maker calibrated.
    """
    arm = verdict.model.arm
    rows, zeros = corrected_rows(verdict), zero_offsets(verdict)["actual_minus_commanded_deg"]
    if rows is None or arm.description.dh is None or not (changes(rows) or zeros.any()):
        return None
    rows = rows.assign(corrected_theta_offset_deg=rows["corrected_theta_offset_deg"] + zeros)
    joints = [
        row.model_copy(update={name: float(rows[f"corrected_{name}"].iloc[j]) for name in NUMBERS})
        for j, row in enumerate(arm.description.dh.joints)
    ]
    dh = arm.description.dh.model_copy(update={"joints": joints})
    return controllers.ur_kinematics(build_arm(arm.description.model_copy(update={"dh": dh})))
