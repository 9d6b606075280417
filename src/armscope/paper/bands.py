"""Where the drawn robots' errors lie, true and estimated: the bands behind the figures of the anchored one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.beside_printed import ENSEMBLE_RANGE
from armscope.paper.measurements import Measurements

TRUE = "true"
LOW, HIGH = ["low_x_mm", "low_y_mm", "low_z_mm"], ["high_x_mm", "high_y_mm", "high_z_mm"]


def ensemble_bands(measurements: Measurements, fits: Sequence[SwarmFit]) -> pd.DataFrame:
    """5 and 95 % of the robots at every point.

    Args:
        fits: of all of them; the median over the seeds counts.

    Returns:
        Columns trajectory, model ("true": the errors themselves), point (from 1), low_x_mm, ..., high_z_mm.
    """
    tables = []
    for each in measurements.sets:
        tables.append(_table(each.name, TRUE, each.errors_mm))
        for model in dict.fromkeys(fit.name for fit in fits):
            mine = [fit for fit in fits if fit.name == model]
            terms = mine[0].features.matrix(each.inputs(mine[0].features.spec))
            estimated = np.stack([terms @ np.median(fit.coefficients, axis=0).T for fit in mine])
            tables.append(_table(each.name, model, estimated))
    return pd.concat(tables, ignore_index=True)


def _table(trajectory: str, model: str, errors: Array) -> pd.DataFrame:
    low, high = np.percentile(errors, ENSEMBLE_RANGE, axis=0)
    place = {"trajectory": trajectory, "model": model, "point": np.arange(1, errors.shape[1] + 1)}
    return pd.DataFrame({**place, **dict(zip([*LOW, *HIGH], np.hstack([low, high]).T, strict=True))})


def band_of(bands: pd.DataFrame, trajectory: str, model: str) -> tuple[Array, Array] | None:
    """(low, high), each (N, 3) mm, of a trajectory and model; None where there is none.

    Args:
        bands: table of all bands.
        trajectory: which.
        model: which.

    Returns:
        (low, high).
    """
    if bands.empty:
        return None
    rows = bands[(bands["trajectory"] == trajectory) & (bands["model"] == model)]
    return (rows[LOW].to_numpy(dtype=float), rows[HIGH].to_numpy(dtype=float)) if len(rows) else None
