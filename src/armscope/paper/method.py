"""The method as printed, and what makes it work: every basis, layout and update rule, beside least squares.

The paper searches the coefficients themselves (raw), all of a model in one swarm (joint), with a velocity update that
has neither inertia nor constriction (original). Each of the three can be changed by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from armscope.core.types import unheard
from armscope.errormodels.basis import BasisKind
from armscope.errormodels.features import ModelSpec
from armscope.errormodels.fitted import Layout, SwarmFit
from armscope.errormodels.swarm_fit import FitProblem, fit_random_search, fit_swarms
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.claims.evidence import Evidence
from armscope.paper.claims.judges import CLOSE_PER_CENT, arrival, cost_ratio
from armscope.paper.claims.table import interval, missing_models
from armscope.paper.measurements import Measurements
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


BASES = tuple(kind.value for kind in BasisKind)
LAYOUTS = tuple(layout.value for layout in (Layout.JOINT, Layout.PER_AXIS))
UPDATES = ("original", "constriction", "inertia")
JUDGED = ("alternative", "iterations", "fourier", "same_outcome")  # The claims whose fate follows from the method

CLAIM_COLUMNS = ["basis", "layout", "update", "key", "true", "robots", "share", "share_low", "share_high"]
PRINTED_BASIS, PRINTED_LAYOUT, PRINTED_UPDATE = BASES[0], LAYOUTS[0], UPDATES[0]


def as_printed(settings: SwarmSettings) -> SwarmSettings:
    """The update as section 5 prints it, with the study's population and iterations and without a threshold."""
    return replace(settings, update=PRINTED_UPDATE, neighbourhood="gbest", velocity_clamp=None, threshold=None)


def method_table(
    measurements: Measurements,
    specs: Sequence[ModelSpec],
    robots: Sequence[str],
    seeds: Sequence[int],
    settings: SwarmSettings,
    progress: Callable[[str], None] = unheard,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Excess over least squares for all combinations, and what becomes of the claims about the swarm.

    Args:
        measurements: of the robots.
        specs: models to fit.
        robots: which robots.
        seeds: of the swarms.
        settings: population and iterations.
        progress: told after each combination.

    Returns:
        (method, claims). Method has columns basis, layout, update ("random search" for the baseline), model, swarms,
        excess_median, excess_low, excess_high (%, 5 and 95 % of the swarms), close (share of the fits within 1 %),
        iterations (median over the fits until all their swarms are; infinite: never), cost (evaluations until then, as
        multiples of the arithmetic of least squares). Claims has columns basis, layout, update, key, true, robots,
        share, share_low, share_high (exact 95 % interval).
    """
    problems = measurements.fit_problems(tuple(specs), list(robots))
    tables, judged = [], []
    for basis, layout, update in product(BASES, LAYOUTS, UPDATES):
        chosen = replace(as_printed(settings), update=update)
        fits = fit_swarms(problems, seeds, chosen, basis, layout=layout)
        where = {"basis": basis, "layout": layout, "update": update}
        tables += [{**where, **row} for row in _by_model(fits)]
        judged += [{**where, **row} for row in _judged(Evidence.of(measurements, fits))]
        progress(f"{basis}, {layout}, {update}")
    blind = fit_random_search(problems, seeds, as_printed(settings), PRINTED_BASIS, PRINTED_LAYOUT)
    where = {"basis": PRINTED_BASIS, "layout": PRINTED_LAYOUT, "update": RANDOM_SEARCH}
    tables += [{**where, **row} for row in _by_model(blind)]
    return pd.DataFrame(tables), pd.DataFrame(judged, columns=CLAIM_COLUMNS)


def _by_model(fits: Sequence[SwarmFit]) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for model in dict.fromkeys(fit.name for fit in fits):
        mine = [fit for fit in fits if fit.name == model]
        excess = np.concatenate([fit.excess_percent.ravel() for fit in mine])
        low, median, high = np.quantile(excess, [0.05, 0.5, 0.95])
        iterations = np.quantile([arrival(fit) for fit in mine], 0.5, method="nearest")
        cost = np.quantile([cost_ratio(fit) for fit in mine], 0.5, method="nearest")
        close = np.mean([fit.excess_percent.max() <= CLOSE_PER_CENT for fit in mine])
        rows.append(
            {
                "model": model,
                "swarms": len(excess),
                "excess_median": median,
                "excess_low": low,
                "excess_high": high,
                "close": float(close),
                "iterations": float(iterations),
                "cost": float(cost),
            }
        )
    return rows


def _judged(evidence: Evidence) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for claim in CLAIMS:
        if claim.key in JUDGED and not missing_models(claim, evidence):
            outcome = claim.judge(evidence)
            if outcome is not None:
                true, robots = int(outcome.per_robot.sum()), len(outcome.per_robot)
                low, high = interval(true, robots)
                share = {"share": true / robots, "share_low": low, "share_high": high}
                rows.append({"key": claim.key, "true": true, "robots": robots, **share})
    return rows
