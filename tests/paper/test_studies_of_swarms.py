"""Convergence, sweeps and the coefficients' table, against least squares and against each other."""

import numpy as np
import pytest

from armscope.errormodels.features import FDP_CI, SDP_AI
from armscope.errormodels.swarm_fit import FitProblem, fit_swarms
from armscope.paper.beside_printed import coefficient_table
from armscope.paper.method import RANDOM_SEARCH, convergence, iterations_needed
from armscope.swarm.settings import SwarmSettings


@pytest.fixture(scope="module")
def problems():
    """Rows whose errors follow the printed Eqs. (15)-(17) and some noise."""
    rng = np.random.default_rng(4)
    points, angles = rng.uniform(-1500, 1500, (85, 3)), rng.uniform(-1, 1, (85, 6))
    gradient = np.array([[-0.00130, 0.00089, -0.00151], [-0.00130, -0.00126, 0.00171], [0.00134, -0.00183, -0.00146]])
    errors = points @ gradient.T + [0.7312, -0.4195, 3.0] + 0.2 * rng.normal(size=(85, 3))
    return [FitProblem(FDP_CI, points, errors, "arm"), FitProblem(SDP_AI, angles, errors, "arm")]


@pytest.fixture(scope="module")
def history(problems):
    return convergence(problems, range(4), SwarmSettings(), "qr")


def test_constriction_arrives_and_the_update_as_printed_does_not(history):
    needed = iterations_needed(history).set_index(["model", "rule"])
    for model in ("FDP(CI)", "SDP(AI)"):
        assert needed.loc[(model, "constriction"), "iterations"] < 100
        assert needed.loc[(model, "constriction"), "share_reached"] == 1
        assert np.isnan(needed.loc[(model, "original"), "iterations"])
        assert needed.loc[(model, RANDOM_SEARCH), "final_excess_percent"] > 1


def test_the_best_so_far_never_gets_worse(history):
    for _, curve in history.groupby(["rule", "model"]):
        assert (np.diff(curve["median"]) <= 0).all()
        assert (curve["low"] <= curve["high"]).all()


def test_fitted_coefficients_stand_beside_the_printed_ones_of_their_equation(problems):
    table = coefficient_table(fit_swarms(problems[:1], range(3)))
    assert sorted(table["equation"].unique()) == [15, 16, 17]
    slopes = table[table["term"] != "const"]
    assert np.abs(slopes["median"] - slopes["printed"]).max() < 5e-5  # 0.2 mm noise on 85 rows of +-1500 mm
    assert np.abs(table["median"] - table["least_squares"]).max() < 1e-6
