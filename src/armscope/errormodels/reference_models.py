"""The paper's polynomial and Fourier models on the rows of a diagnosis, for comparison on held-out rows."""

from __future__ import annotations

import numpy as np

from armscope.core.averages import rms
from armscope.core.grouping import random_parts, same_configuration
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices
from armscope.errormodels.features import PAPER_MODELS, ModelSpec, fit_least_squares
from armscope.errormodels.folds import FOLDS
from armscope.recordings import Recordings
from armscope.robot import Arm, forward_kinematics

MOST_ROWS = 4000  # Longer tables are thinned: the comparison does not need more


def held_out_rms(arm: Arm, recordings: Recordings, residual: Array) -> list[tuple[str, float]]:
    """What the paper's models leave on held-out rows, by cross-validation in five folds of whole configurations.

    Args:
        arm: the nominal arm, whose tool points the Cartesian models take.
        recordings: the rows.
        residual: (N, 3) what is to be modelled, mm: measured minus nominal after the free frames.

    Returns:
        (model, RMS per axis in mm) for each model that has rows enough.
    """
    rows = spread_evenly(len(residual), MOST_ROWS)
    angles = recordings.motor_angles[rows]
    inputs = {"cartesian": 1e3 * forward_kinematics(arm, angles), "angular": angles}
    folds = random_parts(same_configuration(angles), FOLDS, np.random.default_rng(0))
    found = []
    for spec in PAPER_MODELS:
        rms = _cross_validated(spec, inputs[spec.space], residual[rows], folds)
        if rms is not None:
            found.append((spec.name, rms))
    return found


def _cross_validated(spec: ModelSpec, inputs: Array, residual: Array, folds: Indices) -> float | None:
    """None where a fold has fewer rows than the model has terms."""
    left = np.empty_like(residual)
    for fold in range(FOLDS):
        held_out = folds == fold
        features = spec.features(inputs[~held_out])
        if np.count_nonzero(~held_out) <= len(features.term_names):
            return None
        coefficients, _ = fit_least_squares(features, inputs[~held_out], residual[~held_out])
        left[held_out] = residual[held_out] - features.matrix(inputs[held_out]) @ coefficients.T
    return rms(left)
