"""How large a model the rows can bear: folds, and the fewest parts within one standard error of the best.

The rule: Breiman, Friedman, Olshen & Stone, Classification and Regression Trees, 1984, section 3.4.3.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from armscope.core.types import Array, Indices

FOLDS = 5


def fold_numbers(count: int, rng: np.random.Generator) -> Indices:
    """(M,) which fold each of ``count`` rows is held out in."""
    return rng.permutation(np.arange(count) % FOLDS)


def compare_sizes(size: str, sizes: ArrayLike, fit: Array, held_out: Array) -> pd.DataFrame:
    """Models of growing size beside each other.

    Args:
        size: what is counted: "terms".
        sizes: (K,) ascending.
        fit: (K,) mean squared length of the error vector left on the rows fitted, mm^2.
        held_out: (F, K) the same on the rows held out in each fold.

    Returns:
        Columns ``size``, fit_rms_mm, held_out_rms_mm, stderr_mm (of the held-out RMS, from the scatter of the folds),
        and chosen: the smallest within one standard error of the best.
    """
    rms = np.sqrt(held_out.mean(axis=0))
    stderr = held_out.std(axis=0, ddof=1) / np.sqrt(len(held_out)) / (2 * np.maximum(rms, 1e-300))
    best = int(np.argmin(rms))
    first = int(np.flatnonzero(rms <= rms[best] + stderr[best])[0])
    columns = {size: sizes, "fit_rms_mm": np.sqrt(fit), "held_out_rms_mm": rms, "stderr_mm": stderr}
    return pd.DataFrame(columns | {"chosen": np.arange(len(rms)) == first})
