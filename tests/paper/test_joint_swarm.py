"""One swarm for all axes: the same objective as its parts, and the coefficients of a fit, axis by axis."""

import numpy as np
import pytest

from armscope.errormodels.features import FDP_AI
from armscope.errormodels.fitted import Layout, SwarmFit
from armscope.errormodels.swarm_fit import fit_swarms
from armscope.swarm.settings import SwarmSettings


@pytest.fixture(scope="module")
def joint(study):
    problems = study.measurements.fit_problems((FDP_AI,), ["anchored", "ensemble 1"])
    return fit_swarms(problems, [0, 1], SwarmSettings(), "raw", layout="joint")


def test_a_joint_swarm_minimises_the_error_vector(study, joint):
    rows = study.measurements.identification
    fit = joint[1]
    left = rows.errors_mm[1] - fit.predict_all(rows.motor_angles)[1]
    assert fit.layout is Layout.JOINT
    assert fit.history_mm.shape == (2, 1, 201)
    assert fit.history_mm[1, 0, -1] == pytest.approx(np.sqrt(np.mean(np.sum(left**2, axis=1))))
    assert fit.fitness_mm[1] == pytest.approx(np.sqrt(np.mean(left**2, axis=0)))
    assert fit.excess_percent.shape == (2, 1)


def test_a_joint_swarm_reaches_the_same_optimum_as_one_per_axis(joint):
    for fit in joint:
        assert fit.excess_percent.max() < 0.1
        assert fit.coefficients[0] == pytest.approx(fit.least_squares, abs=0.05)


def test_a_joint_fit_survives_its_file(joint):
    again = SwarmFit.from_dict(joint[0].to_dict(history=True))
    assert again.layout is Layout.JOINT
    assert again.history_mm == pytest.approx(joint[0].history_mm, rel=1e-6)
    assert again.excess_percent == pytest.approx(joint[0].excess_percent)
