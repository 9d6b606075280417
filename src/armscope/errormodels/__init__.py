"""The paper's black-box models of positioning errors: polynomials and Fourier series, fitted by swarm."""

from armscope.errormodels.basis import Basis, BasisKind, make_basis
from armscope.errormodels.features import (
    FDP_AI,
    FDP_CI,
    FOURIER_2_AI,
    PAPER_MODELS,
    POLYNOMIAL_4_AI,
    SDP_AI,
    SDP_CI,
    FeatureSet,
    ModelSpec,
)
from armscope.errormodels.fitted import Layout, SwarmFit
from armscope.errormodels.least_squares import fit_least_squares
from armscope.errormodels.swarm_fit import FitProblem, fit_random_search, fit_swarms

__all__ = [
    "FDP_AI",
    "FDP_CI",
    "FOURIER_2_AI",
    "PAPER_MODELS",
    "POLYNOMIAL_4_AI",
    "SDP_AI",
    "SDP_CI",
    "Basis",
    "BasisKind",
    "FeatureSet",
    "FitProblem",
    "Layout",
    "ModelSpec",
    "SwarmFit",
    "fit_least_squares",
    "fit_random_search",
    "fit_swarms",
    "make_basis",
]
