"""The error field of the reproduction, to be turned: before, after each prediction, and compensated."""

from __future__ import annotations

import numpy as np
import pandas as pd
from markupsafe import Markup

from armscope.compensation.closed_loop import NO_MODEL
from armscope.core.types import Array
from armscope.paper.measurements import pose_arrays
from armscope.paper.printed import IDENTIFICATION
from armscope.recordings.columns import ERROR_COLUMNS
from armscope.report.figures.error_field import ErrorField, turnable
from armscope.robot import Arm


def error_field(arm: Arm, poses: pd.DataFrame, left_over: pd.DataFrame) -> Markup:
    """The errors of the first robot before and after, to be turned.

    Args:
        arm: the nominal arm.
        poses: see `armscope.paper.measurements.pose_table`.
        left_over: see `armscope.compensation.closed_loop.remaining_errors`.

    Returns:
        HTML.
    """
    left_over = left_over.assign(stage=left_over["stage"].replace("fit", "prediction"))
    vectors = left_over.set_index(["model", "stage", "trajectory", "point"])[ERROR_COLUMNS]
    rows = list(zip(poses["trajectory"], poses["point"], strict=True))

    def errors(model: str, stage: str) -> Array:
        keys = [(model, stage, trajectory, point) for trajectory, point in rows]
        return vectors.reindex(keys).to_numpy(dtype=np.float64)

    before = errors(NO_MODEL, "prediction")
    angles, nominal_mm = pose_arrays(poses)
    shown = ErrorField(
        points_mm=nominal_mm,
        motor_angles=angles,
        ids=poses["point"].astype(str).tolist(),
        groups=poses["trajectory"].tolist(),
        group_word="trajectory",
        row_word="point",
        stages=(
            ("before", "measured minus nominal"),
            ("after prediction", "measured minus predicted"),
            ("compensated", "where the arm really goes under the corrected commands, minus where it should"),
        ),
        errors_mm={
            model: (before, errors(model, "prediction"), errors(model, "closed loop"))
            for model in dict.fromkeys(left_over["model"])
            if model != NO_MODEL
        },
        missing="only the test paths were compensated, and a command may be refused",
        paths=[name for name in dict.fromkeys(poses["trajectory"]) if name != IDENTIFICATION],
    )
    return turnable(arm, shown)
