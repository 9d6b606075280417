"""What the paper prints beside what its method gives on the anchored robot and its ensemble."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.printed import (
    AXES,
    EQUATIONS,
    TEST_TRAJECTORIES,
    printed_coefficients,
    printed_features,
    printed_matrix,
    printed_table2,
)
from armscope.paper.residuals import typical

ENSEMBLE_RANGE = (5, 95)  # Per cent of the robots between which the ensemble's range is given

READINGS = {"rss": "root of the sum of squares", "rms": "root of the mean square"}
"""The two ways to read the table's "RMS": by name of the columns."""


def table2(residuals: pd.DataFrame) -> pd.DataFrame:
    """One row per model, trajectory and axis (x, y, z, 3D), in the order of the fits.

    Args:
        residuals: see `residual_table`; the first robot is shown (the anchored one), all others are its ensemble.

    Returns:
        Columns model, trajectory, axis, points, printed (as in the paper, no unit; NaN for models, sets and axes that
        it does not have, and throughout for studies of other arms), and for each reading r of "RMS" ("rss", "rms"), in
        mm: r_median, r_low, r_high (over the seeds), r_least_squares, r_ensemble_low, r_ensemble_median,
        r_ensemble_high (5, 50, 95 % of the other robots, each with its median seed; NaN without an ensemble),
        r_ratio = r_median / printed, r_ensemble_ratio = r_ensemble_median / printed; and robots (in all) and rank (of
        the one shown among them, 1 the smallest error).
    """
    robots = residuals["robot"].unique()
    shown: str = robots[0]
    keys = ["model", "trajectory", "axis"]
    mine = residuals[residuals["robot"] == shown]
    fitted = mine[mine["method"] != "least squares"].groupby(keys, sort=False)
    least_squares = mine[mine["method"].isin(["least squares", "none"])].set_index(keys)
    table = fitted["points"].first().to_frame()
    of_paper = set(TEST_TRAJECTORIES) <= set(residuals["trajectory"])
    printed = printed_table2().set_index(keys)["printed"]
    table["printed"] = printed.reindex(table.index) if of_paper else np.nan
    for reading in READINGS:
        values = fitted[f"{reading}_mm"]
        table[f"{reading}_median"] = values.median()
        table[f"{reading}_low"] = values.min()
        table[f"{reading}_high"] = values.max()
        table[f"{reading}_least_squares"] = least_squares[f"{reading}_mm"].reindex(table.index)
        ensemble = typical(residuals[residuals["robot"] != shown], value=f"{reading}_mm")
        bounds = (*ENSEMBLE_RANGE[:1], 50, *ENSEMBLE_RANGE[1:])
        for name, per_cent in zip(("low", "median", "high"), bounds, strict=True):
            quantile = ensemble.quantile(per_cent / 100) if len(ensemble) else pd.Series(dtype=float)
            table[f"{reading}_ensemble_{name}"] = quantile.reindex(table.index) if len(quantile) else np.nan
        table[f"{reading}_ratio"] = table[f"{reading}_median"] / table["printed"]
        table[f"{reading}_ensemble_ratio"] = table[f"{reading}_ensemble_median"] / table["printed"]
    all_robots = typical(residuals)
    table["robots"] = len(robots)
    table["rank"] = ((all_robots < all_robots.loc[shown]).sum() + 1).reindex(table.index)
    return table.reset_index()


def coefficient_table(fits: Sequence[SwarmFit]) -> pd.DataFrame:
    """One row per model, axis and term of one robot's fits.

    Returns:
        Columns model, equation (NaN where the paper prints none), axis, term, printed, median, low, high (over the
        seeds), least_squares; in mm per unit of the term (mm or rad).
    """
    printed = printed_coefficients().set_index(["model", "axis", "term"])["coefficient"]
    parts = []
    for fit in fits:
        for number, axis in enumerate(fit.axes):
            values = fit.coefficients[:, number]
            table = pd.DataFrame(
                {
                    "model": fit.name,
                    "equation": EQUATIONS[fit.name] + number if fit.name in EQUATIONS else np.nan,
                    "axis": axis,
                    "term": fit.features.term_names,
                    "median": np.median(values, axis=0),
                    "low": values.min(axis=0),
                    "high": values.max(axis=0),
                    "least_squares": fit.least_squares[number],
                }
            )
            keys = pd.MultiIndex.from_frame(table[["model", "axis", "term"]])
            table.insert(4, "printed", printed.reindex(keys).to_numpy())
            parts.append(table)
    return pd.concat(parts, ignore_index=True)


UNTOLD_MODELS = ("FDP(AI)", "SDP(CI)", "SDP(AI)")


def cross_check(residuals: pd.DataFrame, fits: Sequence[SwarmFit]) -> pd.DataFrame:
    """One row per printed number that anchoring did not use.

    Args:
        residuals: of all robots (see `residual_table`), the anchored one first.

    Returns:
        Columns kind ("slope" of an equation, "error" of Table 2), number (such as "Eq. (9), x, theta1" or "FDP(CI),
        test 1, x"), unit, printed, anchored (least squares, or mm as root of the sum of squares), low, median, high (5,
        50, 95 % of the ensemble), same_sign (share of the robots with the printed sign; slopes only), inside (whether
        the printed number lies between low and high). Constants are left out: they depend on where the lost Table 1
        puts the joints' zeros.
    """
    table = pd.concat([_slopes(fits), _errors(residuals)], ignore_index=True)
    table["inside"] = (table["printed"] >= table["low"]) & (table["printed"] <= table["high"])
    return table


def _slopes(fits: Sequence[SwarmFit]) -> pd.DataFrame:
    rows = []
    for model in UNTOLD_MODELS:
        mine = [fit for fit in fits if fit.name == model]
        terms = printed_features(model).term_names
        if not mine or mine[0].features.term_names != terms:
            continue
        values = np.stack([fit.least_squares for fit in mine])
        printed = printed_matrix(model)
        unit = "mm" if model.endswith("(CI)") else "rad"
        for k, axis in enumerate(AXES):
            for j, term in enumerate(terms[1:], start=1):
                per = f"mm/{unit}^2" if term.endswith("^2") else f"mm/{unit}"
                name = f"Eq. ({EQUATIONS[model] + k}), {axis}, {term}"
                rows.append(_row("slope", name, per, printed[k, j], values[:, k, j]))
    return pd.DataFrame(rows)


def _errors(residuals: pd.DataFrame) -> pd.DataFrame:
    cells = typical(residuals, value="rss_mm")
    rows = []
    for model, trajectory, axis, printed in printed_table2().itertuples(index=False):
        if (model, trajectory, axis) in cells:
            values = cells[model, trajectory, axis].to_numpy(dtype=float)
            rows.append(_row("error", f"{model}, {trajectory}, {axis}", "mm", printed, values))
    return pd.DataFrame(rows)


def _row(kind: str, name: str, unit: str, printed: float, values: Array) -> dict[str, object]:
    """``values``: of the anchored robot first, then of its ensemble."""
    ensemble = values[1:] if len(values) > 1 else np.array([np.nan])
    low, median, high = np.quantile(ensemble, [ENSEMBLE_RANGE[0] / 100, 0.5, ENSEMBLE_RANGE[1] / 100])
    return {
        "kind": kind,
        "number": name,
        "unit": unit,
        "printed": printed,
        "anchored": values[0],
        "low": low,
        "median": median,
        "high": high,
        "same_sign": float(np.mean(np.sign(values) == np.sign(printed))) if kind == "slope" else np.nan,
    }
