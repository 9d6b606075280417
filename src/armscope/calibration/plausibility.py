"""What speaks against a calibration: constants that no drawing gets so wrong, springs that push, loads not known."""

from __future__ import annotations

import numpy as np
import pandas as pd

from armscope.calibration.constants import CALIBRATING, SIZES
from armscope.calibration.model import GRAVITY, Level, SetUp
from armscope.calibration.result import SHOWN, no_gain
from armscope.calibration.solve import Solved
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.fitting.gauss_newton import UNSETTLED
from armscope.recordings import Recordings


def require_loads(recordings: Recordings, rows: SetUp, level: Level) -> None:
    """Compliances need something that joints give way under.

    Args:
        recordings: with their context.
        rows: the set-up.
        level: what is asked for.

    Raises:
        InputError: nobody knows it.
    """
    if level == "compliance" and rows.loads is None:
        masses = "`links` in robot.yaml" if rows.arm.description.urdf is None else "<inertial> of the URDF's links"
        raise InputError(
            recordings.source,
            "level",
            level,
            f"neither the masses of {rows.arm.name} nor recorded torques say what its joints give way under",
            f"State {masses} or record tau1_nm ..., or calibrate at level geometric.",
        )


def implausible_fit(solved: Solved) -> list[str]:
    """What shows that the fit has lost its way."""
    rows, state = solved.rows, solved.fitted.state
    limits = {"m": SIZES.wrong_length * rows.arm.reach, "rad": SIZES.wrong_angle_rad}
    far = [
        f"{constant.name} by {value * SHOWN[constant.unit][0]:.3g} {SHOWN[constant.unit][1]}"
        for constant, value in zip(rows.constants, state.constants, strict=True)
        if not constant.is_zero_offset and abs(value) > limits[constant.unit]
    ]
    told = [f"no drawing is so wrong: {', '.join(far)}"] if far else []
    return told + (["the fit did not settle"] if solved.fitted.reason == UNSETTLED else [])


def doubtful_loads(solved: Solved, level: Level, covariance: Array) -> list[str]:
    """Joints that turn against their load beyond doubt, which no spring does; links that weigh nothing.

    Args:
        solved: the fit.
        level: what was free.
        covariance: (P, P) of the parameters.

    Returns:
        One sentence each.
    """
    if level != "compliance":
        return []
    rows, arm, notes = solved.rows, solved.rows.arm, list[str]()
    by_table = rows.load_source == GRAVITY
    fitted = np.array(rows.names)[solved.free]
    errors = dict(zip(fitted.tolist(), np.sqrt(np.diag(covariance)).tolist(), strict=True))
    values = {f"joint {motor}": value for motor, value in enumerate(solved.fitted.state.compliances, start=1)}
    error_of = {name: errors.get(f"{name} compliance", np.inf) for name in values}
    if against := [name for name, value in values.items() if value < -CALIBRATING.sure_sigmas * error_of[name]]:
        question = "; does gravity_m_s2 point the right way?" if by_table else ""
        notes.append(f"turns against its load, which no spring does: {', '.join(against)}{question}")
    if by_table and not arm.masses.all():
        light = [name for name, mass in zip(arm.joint_names, arm.masses, strict=True) if mass == 0]
        notes.append(f"no mass is stated for what turns with {', '.join(light)}: it counts as weightless")
    return notes


def no_held_out_gain(misses: pd.DataFrame | None) -> list[str]:
    """A note where poses that took no part are foretold no better than by the nominal arm."""
    if not no_gain(misses):
        return []
    return ["on poses that took no part it does no better than base and tool alone: the nominal arm serves as well"]
