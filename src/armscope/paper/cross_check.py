"""Do the robots that stand in know what they were not told? Printed numbers that anchoring did not use.

Anchoring uses Eqs. (15)-(17) and nothing else. The slopes of the other printed equations and the cells of Table 2 are
free to disagree: where a printed number lies outside the ensemble's range, the assumed geometry, poses or tolerances
are not the paper's, or the printed number is not what it seems (see the audit).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.printed import AXES, EQUATIONS, printed_features, printed_matrix, printed_table2
from armscope.paper.residuals import typical
from armscope.paper.table2 import ENSEMBLE_RANGE

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
