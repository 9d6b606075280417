"""The fitted coefficients beside the printed Eqs. (9)-(20)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from armscope.errormodels.fitted import SwarmFit
from armscope.paper.printed import EQUATIONS, printed_coefficients


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
