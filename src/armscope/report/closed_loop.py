"""The closed loop on the paper's virtual robot: each model's commands, followed by the arm that it was fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.compensation.black_box import error_model
from armscope.compensation.closed_loop import (
    Candidate,
    MeasuredPath,
    black_box_candidate,
    cross_table,
    physical_candidate,
)
from armscope.compensation.physical import identified_on
from armscope.diagnosis import Settings, diagnose
from armscope.errormodels import FittedModel, ModelSpec
from armscope.errormodels.regions import blended, compare_regions, divide, fit_regions, halvings_of
from armscope.paper.measurements import Measurements, PoseSet
from armscope.recordings.table import as_recordings
from armscope.robot import Arm
from armscope.world.tolerances import geometric_errors

Array = NDArray[np.float64]

DIAGNOSED = "Diagnosed physics"


def paper_closed_loop(
    arm: Arm, measurements: Measurements, fits: Sequence[FittedModel], errors: Array, diagnosed: bool = True
) -> pd.DataFrame:
    """The cross-table model by trajectory by stage for the first robot of a study; see `cross_table`.

    Args:
        arm: the nominal arm.
        measurements: of the virtual robots.
        fits: of the first robot; of each model the swarm with the smallest residual counts.
        errors: (K,) its true geometric errors, m and rad, in the order of `geometric_errors`.
        diagnosed: add physics diagnosed from the identification rows.
    """
    truth = geometric_errors(arm)
    identification = measurements.identification
    candidates: dict[str, Candidate] = {
        fit.name: black_box_candidate(error_model(arm, fit, identification.motor_angles))
        for fit in fits
        if fit.label == measurements.robots[0]
    }
    if diagnosed:
        candidates[DIAGNOSED] = _diagnosed(arm, identification)
    return cross_table(
        arm,
        candidates,
        _measured(identification),
        {each.name: _measured(each) for each in measurements.held_out},
        lambda angles: truth.positions(angles, errors / truth.sigmas)[0],
    )


def _measured(poses: PoseSet) -> MeasuredPath:
    return MeasuredPath(poses.motor_angles, poses.nominal_mm, poses.errors_mm[0])


def _diagnosed(arm: Arm, identification: PoseSet) -> Candidate:
    columns = {f"q{motor}_rad": angles for motor, angles in enumerate(identification.motor_angles.T, start=1)}
    measured = identification.nominal_mm + identification.errors_mm[0]
    columns |= {f"{axis}_mm": measured[:, n] for n, axis in enumerate("xyz")}
    recordings = replace(as_recordings(pd.DataFrame(columns)), source="identification")
    verdict = diagnose(arm, recordings, Settings(0, False, 0, False))
    return physical_candidate(verdict.model, identified_on(arm, recordings))


def paper_regions(
    measurements: Measurements, specs: Sequence[ModelSpec], seed: int = 0, most_halvings: int = 4
) -> pd.DataFrame:
    """Error against the number of blended regions, for the first robot of a study.

    Returns:
        Columns model, regions, fit_rms_mm, held_out_rms_mm, stderr_mm, chosen (see `compare_regions`), and one per test
        path: the RMS of the error vector that the blended model leaves there, mm.
    """
    identification = measurements.identification
    errors, parts = identification.errors_mm[0], []
    for spec in specs:
        inputs = identification.inputs(spec)
        table = compare_regions(spec, inputs, errors, np.random.default_rng(seed), most_halvings)
        for path in measurements.held_out:
            table[path.name] = [_left_by_regions(spec, identification, path, int(n)) for n in table["regions"]]
        parts.append(table.assign(model=spec.name))
    table = pd.concat(parts, ignore_index=True)
    return table[["model", *table.columns.drop("model")]]


def _left_by_regions(spec: ModelSpec, identification: PoseSet, path: PoseSet, regions: int) -> float:
    inputs, features = identification.inputs(spec), spec.features(identification.inputs(spec))
    cut = divide(inputs, halvings_of(regions))
    coefficients = fit_regions(features, cut, inputs, identification.errors_mm[0])
    left = path.errors_mm[0] - blended(features, cut, coefficients, path.inputs(spec))
    return float(np.sqrt(np.mean(np.sum(left**2, axis=1))))
