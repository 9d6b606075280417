"""Sweeps over the swarm and the models: a table of variants, each fitted with many seeds and judged on all sets."""

from __future__ import annotations

import pandas as pd

from armscope.core.variants import Variant
from armscope.errormodels.features import ModelSpec
from armscope.errormodels.swarm_fit import FitProblem, fit_swarms
from armscope.paper.measurements import Measurements
from armscope.paper.residuals import SPATIAL, residual_table
from armscope.swarm.settings import SwarmSettings


def run_variant(
    measurements: Measurements, variant: Variant, first_seed: int, basis: str, layout: str, engine: str
) -> pd.DataFrame:
    """What a variant leaves of the first robot's errors; basis and layout where the variant does not say.

    Args:
        measurements: of a study; the first robot counts.
        variant: of the swarm or the model.
        first_seed: of as many as the variant asks for.
        basis: the coordinates that are searched, where the variant does not say.
        layout: see `fit_swarms`; where the variant does not say.
        engine: see `minimise_least_squares`.

    Returns:
        Columns id, sweep, varied, model, trajectory, seed, rms_mm (3D), least_squares_mm (3D, of the same model),
        excess_percent (of rms_mm over least_squares_mm; below zero on rows that a worse fit happens to meet better).
    """
    robot = measurements.robots[0]
    rows = measurements.identification
    spec = ModelSpec(variant.family, variant.order, variant.space)
    problem = FitProblem(spec, rows.inputs(spec), rows.errors_mm[0], robot)
    settings = SwarmSettings(variant.particles, variant.iterations, variant.update, variant.neighbourhood)
    seeds = range(first_seed, first_seed + variant.seeds)
    basis, layout = variant.basis or basis, variant.layout or layout
    (fit,) = fit_swarms([problem], seeds, settings, basis, engine, layout)
    table = residual_table(measurements, [fit])
    spatial = table[(table["axis"] == SPATIAL) & (table["robot"] == robot)]
    optimum = spatial[spatial["method"] == "least squares"].set_index("trajectory")["rms_mm"]
    swarms = spatial[spatial["method"] == fit.method][["model", "trajectory", "seed", "rms_mm"]].copy()
    swarms["least_squares_mm"] = optimum.reindex(swarms["trajectory"]).to_numpy()
    swarms["excess_percent"] = 100 * (swarms["rms_mm"] / swarms["least_squares_mm"] - 1)
    swarms.insert(0, "id", variant.id)
    swarms.insert(1, "sweep", variant.sweep)
    swarms.insert(2, "varied", variant.varied)
    return swarms
