"""The method as printed, and what makes it work: every basis, layout and update rule, beside least squares.

The paper searches the coefficients themselves (raw), all of a model in one swarm (joint), with a velocity update that
has neither inertia nor constriction (original). Each of the three can be changed by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
import pandas as pd

from armscope.core.types import unheard
from armscope.errormodels.basis import BasisKind
from armscope.errormodels.features import ModelSpec
from armscope.errormodels.fitted import Layout, SwarmFit
from armscope.errormodels.swarm_fit import fit_random_search, fit_swarms
from armscope.paper.claims.catalogue import CLAIMS
from armscope.paper.claims.evidence import Evidence
from armscope.paper.claims.judges import CLOSE_PER_CENT, arrival, cost_ratio
from armscope.paper.claims.table import interval, missing_models
from armscope.paper.convergence import RANDOM_SEARCH
from armscope.paper.measurements import Measurements
from armscope.swarm.settings import SwarmSettings

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
