"""Figures 1-11 of the paper in its arrangement, for whichever models are configured."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from armscope.core.types import Array
from armscope.errormodels.fitted import SwarmFit
from armscope.paper.bands import TRUE, band_of
from armscope.paper.measurements import Measurements
from armscope.paper.printed import PRINTED_MODELS
from armscope.report.figures.paper_arm import arm_with_frames, measuring_setup
from armscope.report.figures.paper_estimation import Band, estimation_performance
from armscope.report.figures.paper_paths import trajectory
from armscope.report.figures.paper_positions import errors_of_positions, modelling_performance
from armscope.robot import Arm

ARM_FIGURES = ("fig01", "fig02")
TEST_FIGURES = {"fig05": "test 1", "fig08": "test 2", "fig09": "test 3"}
ESTIMATION_FIGURES = {
    "fig06": ("test 1", "cartesian"),
    "fig07": ("test 1", "angular"),
    "fig10": ("test 2", "cartesian"),
    "fig11": ("test 2", "angular"),
}
FIGURES = ("fig01", "fig02", "fig03", "fig04", "fig05", "fig06", "fig07", "fig08", "fig09", "fig10", "fig11")
MOST_COLUMNS = 2
"""So many models of one kind of input are drawn beside each other, as in the paper."""


@dataclass(frozen=True, eq=False)
class PaperResults:
    """What figures are drawn from.

    Attributes:
        measurements: of the study; its first robot is drawn.
        fits: of that robot, one per model.
        bands: ranges of the drawn robots (see `armscope.paper.bands`); empty for real arms.
        arm: the nominal arm, for Figs. 1 and 2.
        tracker_mm: (3,) where it is measured from, for Fig. 2.
    """

    measurements: Measurements
    fits: Sequence[SwarmFit]
    bands: pd.DataFrame
    arm: Arm | None = None
    tracker_mm: Array | None = None

    @property
    def by_model(self) -> dict[str, SwarmFit]:
        """The fits of the first robot."""
        return {fit.name: fit for fit in self.fits if fit.label == self.measurements.robots[0]}

    def band(self, trajectory: str, model: str) -> Band | None:
        """Range of the drawn robots' errors on a trajectory, true or estimated."""
        return band_of(self.bands, trajectory, model)


def draw(name: str, shown: PaperResults) -> Figure:
    """One of `FIGURES`. Raises ValueError: a figure whose models are not configured, or of an arm that is not given."""
    measurements, models = shown.measurements, shown.by_model
    if name in ARM_FIGURES:
        if shown.arm is None or shown.tracker_mm is None:
            raise ValueError(f"{name} needs the arm and the tracker's place")
        if name == "fig01":
            return arm_with_frames(shown.arm)
        return measuring_setup(shown.arm, measurements.identification, shown.tracker_mm)
    if name == "fig03":
        rows = measurements.identification
        return errors_of_positions(rows.errors_mm[0], *(shown.band(rows.name, TRUE) or (None, None)))
    if name == "fig04":
        rows = measurements.identification
        return modelling_performance(rows.errors_mm[0], _predictions(models, modelled(models), rows.inputs))
    if name in TEST_FIGURES:
        path = measurements[TEST_FIGURES[name]]
        return trajectory(path.nominal_mm, path.motor_angles)
    set_name, space = ESTIMATION_FIGURES[name]
    chosen = estimated(models, space)
    if not chosen:
        raise ValueError(f"{name} needs a model of {space} input, and none is configured")
    path = measurements[set_name]
    bands = {model: band for model in chosen if (band := shown.band(set_name, model)) is not None}
    return estimation_performance(
        path.errors_mm[0], _predictions(models, chosen, path.inputs), shown.band(set_name, TRUE), bands
    )


def modelled(models: Mapping[str, SwarmFit]) -> list[str]:
    """The models of Fig. 4: the paper's four as far as they are there, else the first four."""
    return [name for name in PRINTED_MODELS if name in models] or list(models)[:4]


def estimated(models: Mapping[str, SwarmFit], space: str) -> list[str]:
    """The models of one kind of input that Figs. 6, 7, 10, 11 show: the first two."""
    return [name for name, fit in models.items() if fit.features.spec.space == space][:MOST_COLUMNS]


def _predictions(fits: Mapping[str, SwarmFit], models: Sequence[str], inputs: Callable[..., Array]) -> dict[str, Array]:
    """By model, the median of the seeds' predictions (N, 3), mm."""
    return {model: np.median(fits[model].predict_all(inputs(fits[model].features.spec)), axis=0) for model in models}
