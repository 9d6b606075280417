"""How much error is left: for every robot, model, trajectory and axis, uncompensated and after each prediction."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.measurements import Measurements
from armscope.paper.printed import AXES, UNCOMPENSATED

SPATIAL = "3D"  # The fourth "axis": the length of the error vector

NO_SEED = -1
COLUMNS = ["robot", "model", "trajectory", "axis", "method", "seed", "points", "rss_mm", "rms_mm"]


def residual_table(measurements: Measurements, fits: Sequence[SwarmFit]) -> pd.DataFrame:
    """One row per robot, model, trajectory, axis and fit.

    Args:
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


def typical(residuals: pd.DataFrame, value: str = "rms_mm") -> pd.DataFrame:
    """The swarms' median over seeds: one row per robot, columns (model, trajectory, axis); robots in their first order.

    Args:
        residuals: see `residual_table`.

    Returns:
        The table of medians, mm.
    """
    chosen = residuals[residuals["method"].isin(["none", "swarm"])]
    medians = chosen.groupby(["robot", "model", "trajectory", "axis"], sort=False)[value].median()
    return medians.unstack(["model", "trajectory", "axis"]).reindex(residuals["robot"].unique())


def spatial_rms(measurements: Measurements, fits: Sequence[SwarmFit], least_squares: bool = False) -> pd.DataFrame:
    """What fits leave of the errors, one row per robot with fits, in the order of the fits.

    Args:
        measurements: of the robots.
        fits: one per robot and model, labelled with the robot.
        least_squares: of the least-squares coefficients instead of the swarms'.

    Returns:
        Columns (model, trajectory, axis); RMS in mm, the median over the seeds; "Uncompensated" is one of the models.
    """
    robots = list(dict.fromkeys(fit.label for fit in fits))
    alike: dict[tuple[str, int], list[SwarmFit]] = {}
    for fit in fits:
        alike.setdefault((fit.name, len(fit.seeds)), []).append(fit)
    values: dict[tuple[str, str, str], Array] = {}

    def note(model: str, trajectory: str, labels: Sequence[str], left: Array) -> None:
        """Of residuals (R, S, N, 3)."""
        squares = np.einsum("rsna,rsna->rsa", left, left) / left.shape[2]
        rms = np.sqrt(np.concatenate([squares, squares.sum(axis=2, keepdims=True)], axis=2))
        places = [robots.index(label) for label in labels]
        for axis, of_axis in zip((*AXES, SPATIAL), np.median(rms, axis=1).T, strict=True):
            values.setdefault((model, trajectory, axis), np.full(len(robots), np.nan))[places] = of_axis

    for each in measurements.sets:
        errors = {robot: each.errors_mm[measurements.robots.index(robot), None] for robot in robots}
        note(UNCOMPENSATED, each.name, robots, np.stack(list(errors.values())))
        for (model, _), mine in alike.items():
            terms = mine[0].features.matrix(each.inputs(mine[0].features.spec))
            chosen = np.stack([fit.least_squares[None] if least_squares else fit.coefficients for fit in mine])
            left = np.stack([errors[fit.label] for fit in mine]) - terms @ chosen.swapaxes(2, 3)
            note(model, each.name, [fit.label for fit in mine], left)
    return pd.DataFrame(values, index=robots).rename_axis(columns=["model", "trajectory", "axis"])
