"""Which velocity update reaches the least-squares optimum, and after how many iterations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from armscope.errormodels.fitted import SwarmFit
from armscope.errormodels.swarm_fit import FitProblem, fit_random_search, fit_swarms
from armscope.swarm.settings import SwarmSettings

RULES: dict[str, dict[str, Any]] = {
    "constriction": {"update": "constriction", "neighbourhood": "gbest", "velocity_clamp": None},
    "inertia": {"update": "inertia", "neighbourhood": "gbest", "velocity_clamp": None},
    "constriction, ring": {"update": "constriction", "neighbourhood": "ring", "velocity_clamp": None},
    "original, clamped": {"update": "original", "neighbourhood": "gbest", "velocity_clamp": 0.5},
    "original": {"update": "original", "neighbourhood": "gbest", "velocity_clamp": None},
}
"""The compared rules; `original` is the update as the paper prints it (section 5)."""
RANDOM_SEARCH = "random search"
CLOSE_PERCENT = 1.0
SMALLEST_PERCENT = 1e-8  # Differences below this share of the optimum are rounding


def convergence(
    problems: Sequence[FitProblem], seeds: Sequence[int], settings: SwarmSettings, basis: str, engine: str = "auto"
) -> pd.DataFrame:
    """Excess of the best fitness so far over the least-squares optimum, by rule, model and iteration.

    Args:
        problems: the models, on the same identification rows.
        seeds: one swarm per seed and axis.
        settings: population and iterations; the rules set the rest.
        basis: the coordinates to search in.
        engine: see `fit_swarms`.

    Returns:
        Columns rule, model, iteration, median, low, high (over seeds and axes, %), and reached: the share of the swarms
        that are within `CLOSE_PERCENT` of the optimum.
    """
    tables = []
    for rule, choice in RULES.items():
        chosen = replace(settings, threshold=None, **choice)
        tables += [_history(rule, fit) for fit in fit_swarms(problems, seeds, chosen, basis, engine)]
    baseline = fit_random_search(problems, seeds, replace(settings, threshold=None), basis)
    return pd.concat([*tables, *(_history(RANDOM_SEARCH, fit) for fit in baseline)], ignore_index=True)


def _history(rule: str, fit: SwarmFit) -> pd.DataFrame:
    optimum = fit.optimum_mm[None, :, None]
    excess = (100 * (fit.history_mm / optimum - 1)).clip(min=SMALLEST_PERCENT).reshape(-1, fit.history_mm.shape[2])
    return pd.DataFrame(
        {
            "rule": rule,
            "model": fit.name,
            "iteration": np.arange(excess.shape[1]),
            "median": np.median(excess, axis=0),
            "low": excess.min(axis=0),
            "high": excess.max(axis=0),
            "reached": np.mean(excess <= CLOSE_PERCENT, axis=0),
        }
    )


def iterations_needed(history: pd.DataFrame) -> pd.DataFrame:
    """When 90 % of a rule's swarms are within `CLOSE_PERCENT` of the optimum, and how far off the median ends.

    Args:
        history: as `convergence` returns it.

    Returns:
        Columns model, rule, iterations (NaN: never), final_excess_percent (median), share_reached.
    """
    rows = []
    for (model, rule), curve in history.groupby(["model", "rule"], sort=False):
        arrived = curve.loc[curve["reached"] >= 0.9, "iteration"]
        last = curve.iloc[-1]
        rows.append((model, rule, arrived.min() if len(arrived) else np.nan, last["median"], last["reached"]))
    return pd.DataFrame(rows, columns=["model", "rule", "iterations", "final_excess_percent", "share_reached"])
