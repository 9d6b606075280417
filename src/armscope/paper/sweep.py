"""Sweeps over the swarm and the models: a table of variants, each fitted with many seeds and judged on all sets."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import pandas as pd
import pydantic
from pydantic import Field

from armscope.errormodels import FitProblem, ModelSpec, fit_swarms
from armscope.inputs import InputError, Strict, nearest
from armscope.paper.measurements import Measurements
from armscope.paper.residuals import SPATIAL, residual_table
from armscope.swarm import SwarmSettings

VARIED = {"particles": "particles", "iterations": "iterations", "update": "update", "harmonics": "order"}
"""What is on the horizontal axis of a sweep, by the first word of its name; all others vary the model's order."""


class Variant(Strict):
    """One row of a sweep's table."""

    id: str = Field(pattern=r"^\w+$")
    sweep: str
    family: Literal["polynomial", "fourier"]
    order: int = Field(ge=1)
    space: Literal["cartesian", "angular"]
    particles: int = Field(ge=2)
    iterations: int = Field(ge=0)
    update: Literal["constriction", "inertia", "original"]
    neighbourhood: Literal["gbest", "ring"]
    seeds: int = Field(ge=1)

    @property
    def spec(self) -> ModelSpec:
        """The error model."""
        return ModelSpec(self.family, self.order, self.space)

    @property
    def varied(self) -> str | int:
        """Where the variant stands on the sweep's horizontal axis."""
        value: str | int = getattr(self, VARIED.get(self.sweep.split()[0], "order"))
        return value


def read_variants(path: Path | str) -> list[Variant]:
    """The variants of a sweep's table (CSV).

    Raises:
        InputError: a column, value or id that can't be; it names row, column, rule.
    """
    table = pd.read_csv(path)
    for column in table.columns:
        if column not in Variant.model_fields:
            raise InputError(path, "line 1", column, "no such column", nearest(column, Variant.model_fields))
    variants = []
    for number, row in enumerate(table.to_dict("records"), start=2):
        try:
            variants.append(Variant.model_validate(row))
        except pydantic.ValidationError as error:
            problem = error.errors()[0]
            place = f"row {number}, column {problem['loc'][0]}"
            raise InputError(path, place, problem["input"], problem["msg"].lower()) from error
    twice = table["id"][table["id"].duplicated()]
    if len(twice):
        raise InputError(path, f"row {twice.index[0] + 2}, column id", twice.iloc[0], "ids must differ")
    return variants


def run_variant(measurements: Measurements, variant: Variant, first_seed: int, basis: str, engine: str) -> pd.DataFrame:
    """What a variant leaves of the first robot's errors.

    Returns:
        Columns id, sweep, varied, model, trajectory, seed, rms_mm (3D), least_squares_mm (3D, of the same model),
        excess_percent (of the fit's RMS over least squares on the identification rows, the worst axis).
    """
    robot = measurements.robots[0]
    rows = measurements.identification
    problem = FitProblem(variant.spec, rows.inputs(variant.spec), rows.errors_mm[0], robot)
    settings = SwarmSettings(variant.particles, variant.iterations, variant.update, variant.neighbourhood)
    (fit,) = fit_swarms([problem], range(first_seed, first_seed + variant.seeds), settings, basis, engine)
    table = residual_table(measurements, [fit])
    spatial = table[(table["axis"] == SPATIAL) & (table["robot"] == robot)]
    optimum = spatial[spatial["method"] == "least squares"].set_index("trajectory")["rms_mm"]
    swarms = spatial[spatial["method"] == fit.method][["model", "trajectory", "seed", "rms_mm"]].copy()
    swarms["least_squares_mm"] = optimum.reindex(swarms["trajectory"]).to_numpy()
    worst = pd.Series(fit.excess_percent.max(axis=1), index=list(fit.seeds))
    swarms["excess_percent"] = worst.reindex(swarms["seed"]).to_numpy()
    swarms.insert(0, "id", variant.id)
    swarms.insert(1, "sweep", variant.sweep)
    swarms.insert(2, "varied", variant.varied)
    return swarms
