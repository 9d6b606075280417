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
from armscope.errormodels import FeatureSet, FittedModel, ModelSpec
from armscope.errormodels.products import ProductFeatures, fit_products
from armscope.errormodels.regions import Cut, blended, divide, fit_regions, halvings_of, weights
from armscope.paper.measurements import Measurements, PoseSet
from armscope.physics.model import Base
from armscope.recordings.table import as_recordings
from armscope.robot import Arm
from armscope.world.tolerances import geometric_errors

DIAGNOSED = "Diagnosed physics"


def paper_closed_loop(
    arm: Arm,
    measurements: Measurements,
    fits: Sequence[FittedModel],
    errors: Array,
    products: Sequence[ModelSpec] = (),
    regions: Sequence[tuple[ModelSpec, int]] = (),
    diagnosed: bool = True,
) -> pd.DataFrame:
    """What is left at every point by model, trajectory and stage, for a study's first robot; see `remaining_errors`.

    Args:
        arm: the nominal arm.
        measurements: of the virtual robots.
        fits: of the first robot; of each model the swarm with the smallest residual counts.
        errors: (K,) its true geometric errors, m and rad, in the order of `geometric_errors`.
        products: add models with a sparse choice of products, by least squares.
        regions: add models of so many blended regions, by least squares.
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
    for spec in products:
        model = _with_products(arm, spec, identification)
        candidates[model.name] = black_box_candidate(model)
    for spec, count in regions:
        candidates[f"{spec.name}, {count} regions"] = black_box_candidate(
            _with_regions(arm, spec, count, identification)
        )
    if diagnosed:
        candidates[DIAGNOSED] = _diagnosed(arm, identification)
    return remaining_errors(
        arm,
        candidates,
        _measured(identification),
        {each.name: _measured(each) for each in measurements.held_out},
        lambda angles: truth.positions(angles, errors / truth.sigmas)[0],
    )


def _measured(poses: PoseSet) -> MeasuredPath:
    return MeasuredPath(poses.motor_angles, poses.nominal_mm, poses.errors_mm[0])


def _with_products(arm: Arm, spec: ModelSpec, identification: PoseSet) -> ErrorModel:
    inputs, errors = identification.inputs(spec), identification.errors_mm[0]
    features, coefficients, _ = fit_products(spec, inputs, errors, np.random.default_rng(0))
    rms_mm = np.sqrt(np.mean((errors - features.matrix(inputs) @ coefficients.T) ** 2, axis=0))
    base = Base(np.eye(3), np.zeros(3))
    domain = domain_of(arm, spec, identification.motor_angles)
    return ErrorModel(arm, features, coefficients[None], "least squares", rms_mm, base, domain)


def _with_regions(arm: Arm, spec: ModelSpec, count: int, identification: PoseSet) -> ErrorModel:
    inputs, errors = identification.inputs(spec), identification.errors_mm[0]
    features, cut = spec.features(inputs), divide(inputs, halvings_of(count))
    coefficients = fit_regions(features, cut, inputs, errors)
    rms_mm = np.sqrt(np.mean((errors - blended(features, cut, coefficients, inputs)) ** 2, axis=0))
    base = Base(np.eye(3), np.zeros(3))
    domain = domain_of(arm, spec, identification.motor_angles)
    return ErrorModel(arm, features, coefficients, "least squares", rms_mm, base, domain, cut)


def real_left_over(
    measurements: Measurements,
    fits: Sequence[FittedModel],
    products: Sequence[ModelSpec] = (),
    regions: Sequence[tuple[ModelSpec, int]] = (),
) -> pd.DataFrame:
    """What is left at every point of a real arm's recordings, by model: fitted rows and held-out rows, by prediction.

    Such an arm can't be sent anywhere: what is left of its held-out errors is what a correction would leave, to first
    order.

    Args:
        measurements: of the arm.
        fits: the paper's models.
        products: models of products to fit, too.
        regions: models with their number of regions to fit, too.

    Returns:
        As `remaining_errors`, with the stages "fit" and "prediction" only.
    """
    rows = measurements.identification
    found: dict[str, Callable[[PoseSet], Array]] = {NO_MODEL: lambda each: np.zeros_like(each.errors_mm[0])}
    for fit in fits:
        found[fit.name] = _best_of(fit)
    for spec in products:
        features, coefficients, _ = fit_products(spec, rows.inputs(spec), rows.errors_mm[0], np.random.default_rng(0))
        found[features.name] = _predictor(spec, features, None, coefficients[None])
    for spec, count in regions:
        inputs = rows.inputs(spec)
        sums, cut = spec.features(inputs), divide(inputs, halvings_of(count))
        found[f"{spec.name}, {count} regions"] = _predictor(
            spec, sums, cut, fit_regions(sums, cut, inputs, rows.errors_mm[0])
        )
    return pd.concat(
        [
            vectors(name, each.name, "fit" if each is rows else "prediction", each.errors_mm[0] - predict(each))
            for name, predict in found.items()
            for each in measurements.sets
        ],
        ignore_index=True,
    )


def _best_of(fit: FittedModel) -> Callable[[PoseSet], Array]:
    """Of each axis the swarm with the smallest residual."""
    coefficients = fit.coefficients[fit.best_seeds, np.arange(len(fit.axes))]
    return _predictor(fit.features.spec, fit.features, None, coefficients[None])


def _predictor(
    spec: ModelSpec, features: FeatureSet | ProductFeatures, cut: Cut | None, coefficients: Array
) -> Callable[[PoseSet], Array]:
    def predict(poses: PoseSet) -> Array:
        inputs = poses.inputs(spec)
        shares = weights(cut, inputs)
        predicted: Array = np.einsum("nr,nt,rat->na", shares, features.matrix(inputs), coefficients)
        return predicted

    return predict


def _diagnosed(arm: Arm, identification: PoseSet) -> Corrector:
    columns = {f"q{motor}_rad": angles for motor, angles in enumerate(identification.motor_angles.T, start=1)}
    measured = identification.nominal_mm + identification.errors_mm[0]
    columns |= {f"{axis}_mm": measured[:, n] for n, axis in enumerate("xyz")}
    recordings = replace(as_recordings(pd.DataFrame(columns)), source="identification")
    verdict = diagnose(arm, recordings, Settings(0, False, 0, False))
    return physical_candidate(verdict.model, identified_on(arm, verdict.recordings))
