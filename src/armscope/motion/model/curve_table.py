"""curves.csv: a model's torques without a law, as points to be added to a simulator's torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from armscope.core.constants import Constants
from armscope.motion.library.laws import CLINGING, Law
from armscope.motion.library.remedies_of_curves import unit_of
from armscope.motion.model.fitted import MotionModel
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.model.shapes import free_curve, limits_of


@dataclass(frozen=True)
class CurveFile(Constants):
    """What curves.csv holds."""

    points: int = 201
    """of each curve; derived: straight lines between them are off by 1e-4 of a curve of nine knots or fewer"""


FILE = CurveFile()
COLUMNS = ("cause", "place", "driver", "shape", "at", "at_unit", "torque", "torque_unit", "stderr")
CURVE, STOP = "curve", "stop"
"""Shapes: a point of a curve; something that is taken along by so much before it slips."""


def curve_table(model: MotionModel) -> pd.DataFrame:
    """Every curve among the causes, one row per point: torque of the motor, beside all else of the model.

    Returns:
        No rows where there are no curves.
    """
    pieces = [_points(model, cause) for cause in model.causes]
    told = [each for each in pieces if each is not None]
    return pd.concat(told, ignore_index=True) if told else pd.DataFrame(columns=list(COLUMNS))


def _points(model: MotionModel, cause: FittedCause) -> pd.DataFrame | None:
    law = cause.placed.columns
    if not isinstance(law, Law):
        return None
    if cause.placed.is_curve:
        at = np.linspace(*limits_of(cause), FILE.points)
        shape, (torque, stderr) = CURVE, free_curve(cause, at)
    elif law.kind in ("clinging over ways", *CLINGING):
        at = np.array(law.numbers[-cause.placed.width :])
        shape, torque, stderr = STOP, cause.values, cause.stderr
    else:
        return None
    sliding = bool(model.arm.sliding[law.joints[0]])
    place = (cause.placed.cause.name, cause.placed.location, cause.placed.driver, shape)
    values = (at, unit_of(cause.placed.driver, sliding), torque, "N" if sliding else "N m", stderr)
    return pd.DataFrame(dict(zip(COLUMNS, (*place, *values), strict=True)))
