"""The least-squares fit: the optimum that a swarm can reach at best, by a route of its own (SVD instead of QR)."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.errormodels.basis import BasisKind, make_basis
from armscope.errormodels.features import FeatureSet


def fit_least_squares(features: FeatureSet, inputs: Array, errors_mm: Array) -> tuple[Array, Array]:
    """Raw coefficients (axes x terms) and RMS residual (axes, mm) of the least-squares fit.

    Args:
        features: the model's terms.
        inputs: N x k, mm or rad.
        errors_mm: N x axes.

    Returns:
        Coefficients, axes x terms, in the terms' own units, and RMS residuals (axes,), mm.
    """
    columns = features.matrix(inputs)
    basis = make_basis(BasisKind.STANDARDISED, columns, features.term_names)
    # columns of similar size keep the SVD's cut-off away from terms like px^4, of 1e12 mm^4
    independent = columns @ basis.to_raw
    coordinates: Array = np.linalg.lstsq(independent, errors_mm, rcond=None)[0].astype(float)
    residuals = errors_mm - independent @ coordinates
    return basis.raw_coefficients(coordinates.T), np.sqrt(np.mean(np.square(residuals), axis=0))
