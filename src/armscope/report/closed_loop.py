"""The closed loop on the paper's virtual robot: each model's commands, followed by the arm that it was fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.compensation.black_box import ErrorModel, domain_of, error_model
from armscope.compensation.closed_loop import (
    Candidate,
    MeasuredPath,
    black_box_candidate,
    left_over,
    physical_candidate,
)
from armscope.compensation.physical import identified_on
from armscope.diagnosis import Settings, diagnose
from armscope.errormodels import FittedModel, ModelSpec
from armscope.errormodels.products import fit_products
from armscope.paper.measurements import Measurements, PoseSet
from armscope.physics.model import Base
from armscope.recordings.table import as_recordings
from armscope.robot import Arm
from armscope.world.tolerances import geometric_errors

Array = NDArray[np.float64]

DIAGNOSED = "Diagnosed physics"


def paper_closed_loop(
    arm: Arm,
    measurements: Measurements,
    fits: Sequence[FittedModel],
    errors: Array,
    products: Sequence[ModelSpec] = (),
    diagnosed: bool = True,
) -> pd.DataFrame:
    """What is left at every point by model, trajectory and stage, for the first robot of a study; see `left_over`.

    Args:
        arm: the nominal arm.
        measurements: of the virtual robots.
        fits: of the first robot; of each model the swarm with the smallest residual counts.
        errors: (K,) its true geometric errors, m and rad, in the order of `geometric_errors`.
        products: add models with a sparse choice of products, by least squares.
        diagnosed: add physics diagnosed from the identification rows.
    """
    truth = geometric_errors(arm)
    identification = measurements.identification
    candidates: dict[str, Candidate] = {
        fit.name: black_box_candidate(error_model(arm, fit, identification.motor_angles))
        for fit in fits
        if fit.label == measurements.robots[0]
    }
    for spec in products:
        model = _with_products(arm, spec, identification)
        candidates[model.name] = black_box_candidate(model)
    if diagnosed:
        candidates[DIAGNOSED] = _diagnosed(arm, identification)
    return left_over(
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


def _diagnosed(arm: Arm, identification: PoseSet) -> Candidate:
    columns = {f"q{motor}_rad": angles for motor, angles in enumerate(identification.motor_angles.T, start=1)}
    measured = identification.nominal_mm + identification.errors_mm[0]
    columns |= {f"{axis}_mm": measured[:, n] for n, axis in enumerate("xyz")}
    recordings = replace(as_recordings(pd.DataFrame(columns)), source="identification")
    verdict = diagnose(arm, recordings, Settings(0, False, 0, False))
    return physical_candidate(verdict.model, identified_on(arm, recordings))
