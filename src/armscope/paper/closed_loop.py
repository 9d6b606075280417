"""The closed loop on the paper's virtual robot: each model's commands, followed by the arm that it was fitted to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from armscope.compensation.black_box import ErrorModel, domain_of, error_model
from armscope.compensation.closed_loop import (
    NO_MODEL,
    Corrector,
    MeasuredPath,
    black_box_candidate,
    physical_candidate,
    remaining_errors,
    vectors,
)
from armscope.compensation.physical import identified_on
from armscope.core.types import Array
from armscope.diagnosis import Settings, diagnose
from armscope.errormodels.fitted import ExtendedModel, ModelSet, SwarmFit, with_products, with_regions
from armscope.paper.measurements import Measurements, PoseSet
from armscope.physics.model import Base
from armscope.recordings import Recordings
from armscope.recordings.columns import angle_columns
from armscope.recordings.table import as_recordings
from armscope.robot import Arm
from armscope.world.tolerances import geometric_errors

DIAGNOSED = "Diagnosed physics"
NO_MORE = ModelSet()


def paper_closed_loop(
    arm: Arm,
    measurements: Measurements,
    fits: Sequence[SwarmFit],
    errors: Array,
    models: ModelSet = NO_MORE,
    diagnosed: bool = True,
) -> pd.DataFrame:
    """What is left at every point by model, trajectory and stage, for a study's first robot; see `remaining_errors`.

    Args:
        arm: the nominal arm.
        measurements: of the virtual robots.
        fits: of the first robot; of each model the swarm with the smallest residual counts.
        errors: (K,) its true geometric errors, m and rad, in the order of `geometric_errors`.
        models: further ones, with products or regions, by least squares.
        diagnosed: add physics diagnosed from the identification rows.

    Returns:
        Columns model, trajectory, stage, point, and the error's three components, mm.
    """
    truth = geometric_errors(arm)
    identification = measurements.identification
    candidates: dict[str, Corrector] = {
        fit.name: black_box_candidate(error_model(arm, fit, identification.motor_angles))
        for fit in fits
        if fit.label == measurements.robots[0]
    }
    for model in _extended(models, identification):
        candidates[model.name] = black_box_candidate(_error_model(arm, model, identification))
    if diagnosed:
        candidates[DIAGNOSED] = diagnosed_candidate(arm, _recordings(identification))
    return remaining_errors(
        arm,
        candidates,
        _measured(identification),
        {each.name: _measured(each) for each in measurements.held_out},
        lambda angles: truth.positions(angles, errors / truth.sigmas)[0],
    )


def _extended(models: ModelSet, rows: PoseSet) -> list[ExtendedModel]:
    """The extended models, fitted to the first robot's errors."""
    errors = rows.errors_mm[0]
    return [
        *(with_products(spec, rows.inputs(spec), errors, np.random.default_rng(0))[0] for spec in models.products),
        *(with_regions(spec, rows.inputs(spec), errors, count) for spec, count in models.regions),
    ]


def _measured(poses: PoseSet) -> MeasuredPath:
    return MeasuredPath(poses.motor_angles, poses.nominal_mm, poses.errors_mm[0])


def _error_model(arm: Arm, model: ExtendedModel, rows: PoseSet) -> ErrorModel:
    spec, base = model.features.spec, Base(np.eye(3), np.zeros(3))
    rms_mm = np.sqrt(np.mean((rows.errors_mm[0] - model.predict(rows.inputs(spec))) ** 2, axis=0))
    domain = domain_of(arm, spec, rows.motor_angles)
    return ErrorModel(arm, model.features, model.coefficients, "least squares", rms_mm, base, domain, model.cut)


def real_left_over(measurements: Measurements, fits: Sequence[SwarmFit], models: ModelSet = NO_MORE) -> pd.DataFrame:
    """What is left at every point of a real arm's recordings, by model: fitted rows and held-out rows, by prediction.

    Such an arm can't be sent anywhere: what is left of its held-out errors is what a correction would leave, to first
    order.

    Args:
        measurements: of the arm.
        fits: the paper's models; of each axis the swarm with the smallest residual counts.
        models: further ones, with products or regions, by least squares.

    Returns:
        As `remaining_errors`, with the stages "fit" and "prediction" only.
    """
    rows = measurements.identification
    found: dict[str, Callable[[PoseSet], Array]] = {NO_MODEL: lambda each: np.zeros_like(each.errors_mm[0])}
    fitted: list[SwarmFit | ExtendedModel] = [*fits, *_extended(models, rows)]
    found |= {model.name: _predictor(model) for model in fitted}
    return pd.concat(
        [
            vectors(name, each.name, "fit" if each is rows else "prediction", each.errors_mm[0] - predict(each))
            for name, predict in found.items()
            for each in measurements.sets
        ],
        ignore_index=True,
    )


def _predictor(model: SwarmFit | ExtendedModel) -> Callable[[PoseSet], Array]:
    return lambda poses: model.predict(poses.inputs(model.features.spec))


def _recordings(identification: PoseSet) -> Recordings:
    columns = angle_columns(identification.motor_angles)
    measured = identification.nominal_mm + identification.errors_mm[0]
    columns |= {f"{axis}_mm": measured[:, n] for n, axis in enumerate("xyz")}
    return replace(as_recordings(pd.DataFrame(columns)), source="identification")


def diagnosed_candidate(arm: Arm, recordings: Recordings, pose: bool = False) -> Corrector:
    """Physics as diagnosed on identification rows.

    Args:
        arm: the nominal arm.
        recordings: the rows.
        pose: full poses are corrected.

    Returns:
        The model, to predict and to correct.
    """
    verdict = diagnose(arm, recordings, Settings(0, False, 0, False))
    return physical_candidate(verdict.model, identified_on(arm, verdict.recordings), pose)
