"""A share of cases with its exact binomial interval, the cases it is counted in, and the aims it is held against."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import binomtest

from armscope.proof.definitions import SEEDS, Aim, judged

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


def aim_row(aim: str, seeds: str, counted: Rate, bounds: tuple[float, float]) -> Row:
    """An aim beside what was counted.

    Args:
        aim: in words.
        seeds: fixed, fresh or all worlds.
        counted: cases and estimate.
        bounds: least and most that are aimed at.

    Returns:
        Its row in the table of aims, with the verdict.
    """
    verdict = judged(counted.cases, counted.estimate, counted.low, counted.high, bounds)
    return {"aim": aim, "seeds": seeds, **vars(counted), "least": bounds[0], "most": bounds[1], "verdict": verdict}


def aim_rows(aims: Sequence[Aim], tables: Mapping[str, pd.DataFrame]) -> list[Row]:
    """Every aim for fixed, fresh and all worlds, counted in tables of cases."""
    return [
        aim_row(aim.text, seeds, rate(of_seeds(among, seeds)[aim.column]), aim.bounds)
        for aim in aims
        for among in [tables[aim.table][aim.among(tables[aim.table])]]
        for seeds in SEEDS
    ]
