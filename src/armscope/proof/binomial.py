"""A share of cases with its exact binomial interval, and the cases it is counted in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import binomtest

Row = dict[str, object]
RATE = ("cases", "right", "estimate", "low", "high")


@dataclass(frozen=True)
class Rate:
    """Cases, how many of them right, the share, and its 95 % interval; NaN without cases."""

    cases: int
    right: int | None
    estimate: float
    low: float
    high: float


def rate(right: pd.Series) -> Rate:
    """The rate of a column of right and wrong, with its exact binomial interval."""
    cases, hits = len(right), int(right.astype(bool).sum())
    if cases == 0:
        return Rate(0, 0, np.nan, np.nan, np.nan)
    interval = binomtest(hits, cases).proportion_ci(0.95)
    return Rate(cases, hits, hits / cases, float(interval.low), float(interval.high))


def of_seeds(rows: pd.DataFrame, seeds: str) -> pd.DataFrame:
    """The rows of fixed, fresh or all worlds."""
    return rows if seeds == "all" else rows[rows["fresh"] == (seeds == "fresh")]
