"""How much error is left: for every robot, model, trajectory and axis, uncompensated and after each prediction."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.errormodels import FittedModel
from armscope.paper.measurements import Measurements
from armscope.paper.printed import AXES, UNCOMPENSATED

SPATIAL = "3D"
"""The fourth "axis": the length of the error vector."""

NO_SEED = -1
COLUMNS = ["robot", "model", "trajectory", "axis", "method", "seed", "points", "rss_mm", "rms_mm"]


def residual_table(measurements: Measurements, fits: Sequence[FittedModel]) -> pd.DataFrame:
    """One row per robot, model, trajectory, axis and fit.

    Args:
        measurements: of the robots.
        fits: whose labels are robots' names (`Measurements.fit_problems`); robots without a fit keep their
            uncompensated rows.

    Returns:
        Columns robot, model ("Uncompensated", "FDP(CI)", ...), trajectory, axis (x, y, z, 3D), method ("none", "swarm",
        "random search", "least squares"), seed (-1 where there is none), points, rss_mm (root of the sum of squares
        over the points) and rms_mm (root of their mean). Residual = measured - predicted error.
    """
    parts = [
        _rows(robot, UNCOMPENSATED, each.name, "none", (NO_SEED,), each.errors_mm[row][None])
        for row, robot in enumerate(measurements.robots)
        for each in measurements.sets
    ]
    for fit in fits:
        row = measurements.robots.index(fit.label)
        for each in measurements.sets:
            terms = fit.features.matrix(each.inputs(fit.features.spec))
            errors = each.errors_mm[row]
            swarms = errors - np.matmul(terms, fit.coefficients.transpose(0, 2, 1))
            parts.append(_rows(fit.label, fit.name, each.name, fit.method, fit.seeds, swarms))
            least_squares = (errors - terms @ fit.least_squares.T)[None]
            parts.append(_rows(fit.label, fit.name, each.name, "least squares", (NO_SEED,), least_squares))
    columns = {name: np.concatenate([part[name] for part in parts]) for name in COLUMNS}
    return pd.DataFrame(columns)


def _rows(
    robot: str, model: str, trajectory: str, method: str, seeds: Sequence[int], residuals: Array
) -> dict[str, NDArray[Any]]:
    """The table's columns for residuals (S, N, 3) of S fits."""
    n_points = residuals.shape[1]
    squares = np.einsum("sna,sna->sa", residuals, residuals)
    squares = np.column_stack([squares, squares.sum(axis=1)]).ravel()
    count = len(squares)
    return {
        "robot": np.full(count, robot, dtype=object),
        "model": np.full(count, model, dtype=object),
        "trajectory": np.full(count, trajectory, dtype=object),
        "axis": np.array([*AXES, SPATIAL] * len(seeds), dtype=object),
        "method": np.full(count, method, dtype=object),
        "seed": np.repeat(np.asarray(seeds, dtype=int), len(AXES) + 1),
        "points": np.full(count, n_points),
        "rss_mm": np.sqrt(squares),
        "rms_mm": np.sqrt(squares / n_points),
    }


def typical(residuals: pd.DataFrame, method: str = "swarm", value: str = "rms_mm") -> pd.DataFrame:
    """The median over seeds: one row per robot, columns (model, trajectory, axis); robots in their first order.

    Args:
        residuals: see `residual_table`.
        method: whose fits; the uncompensated errors are always in.
        value: "rms_mm" or "rss_mm".

    Returns:
        The table of medians, mm.
    """
    chosen = residuals[residuals["method"].isin(["none", method])]
    medians = chosen.groupby(["robot", "model", "trajectory", "axis"], sort=False)[value].median()
    return medians.unstack(["model", "trajectory", "axis"]).reindex(residuals["robot"].unique())


def spatial_rms(measurements: Measurements, fits: Sequence[FittedModel], least_squares: bool = False) -> pd.DataFrame:
    """What fits leave of the errors, one row per robot with fits, in the order of the fits.

    Args:
        measurements: of the robots.
        fits: one per robot and model, labelled with the robot.
        least_squares: of the least-squares coefficients instead of the swarms'.

    Returns:
        Columns (model, trajectory, axis); RMS in mm, the median over the seeds; "Uncompensated" is one of the models.
    """
    robots = list(dict.fromkeys(fit.label for fit in fits))
    rows = {robot: measurements.robots.index(robot) for robot in robots}
    values: dict[tuple[str, str, str], dict[str, float]] = {}

    def note(robot: str, model: str, trajectory: str, left: Array) -> None:
        squares = np.einsum("sna,sna->sa", left, left) / left.shape[1]
        rms = np.sqrt(np.column_stack([squares, squares.sum(axis=1)]))
        for axis, value in zip((*AXES, SPATIAL), np.median(rms, axis=0), strict=True):
            values.setdefault((model, trajectory, axis), {})[robot] = float(value)

    for each in measurements.sets:
        terms: dict[str, Array] = {}
        for robot in robots:
            note(robot, UNCOMPENSATED, each.name, each.errors_mm[rows[robot]][None])
        for fit in fits:
            if fit.name not in terms:
                terms[fit.name] = fit.features.matrix(each.inputs(fit.features.spec))
            chosen = fit.least_squares[None] if least_squares else fit.coefficients
            left = each.errors_mm[rows[fit.label]] - np.matmul(terms[fit.name], chosen.transpose(0, 2, 1))
            note(fit.label, fit.name, each.name, left)
    table = pd.DataFrame(values, index=robots)
    return table.rename_axis(columns=["model", "trajectory", "axis"])
