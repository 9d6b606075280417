"""The study of full poses on a made-up robot: it measures what the true arm does, in mm and mrad."""

import numpy as np
import pytest

from armscope.compensation.closed_loop import NO_MODEL
from armscope.errormodels.features import FDP_CI, FOURIER_2_AI
from armscope.errormodels.fitted import ModelSet
from armscope.paper.full_pose import BENT_WRIST, paper_full_pose
from armscope.paper.measurements import Measurements, PoseSet
from armscope.robot import chain
from armscope.robot.inverse import follow_path
from armscope.world.tolerances import geometric_errors
from tests.compensation.arms import identification_angles, sk120


@pytest.fixture(scope="module")
def table():
    arm, truth = sk120(), geometric_errors(sk120())
    errors = np.random.default_rng(2).normal(size=len(truth.names)) * truth.sigmas
    path = identification_angles(2, 4)
    path = path[0] + np.linspace(0, 1, 20)[:, None] * (path[1] - path[0])
    sets = []
    for name, angles in (("identification", identification_angles(85, 6)), ("test 1", path)):
        nominal = chain(arm, angles).tool * 1e3
        sets.append(PoseSet(name, angles, nominal, np.zeros((1, *nominal.shape))))
    measurements = Measurements(("anchored",), tuple(sets))
    models = ModelSet((FDP_CI,), (FOURIER_2_AI,), ((FDP_CI, 2),))
    found = paper_full_pose(arm, measurements, errors, models, seed=1, diagnosed=False)
    return found, measurements, errors


def test_every_family_corrects_position_and_orientation_in_closed_loop(table):
    found = table[0].query("stage == 'closed loop'").set_index("model")
    assert list(found.index) == [NO_MODEL, "FDP(CI)", "Fourier 2 (AI) with products", "FDP(CI), 2 regions"]
    assert (found["refused"] == 0).all()
    for model in found.index[1:]:
        assert found.loc[model, "rms_mm"] < 0.3 * found.loc[NO_MODEL, "rms_mm"]
        assert found.loc[model, "rms_mrad"] < 0.3 * found.loc[NO_MODEL, "rms_mrad"]


def test_uncompensated_errors_are_those_of_the_true_arm(table):
    """Once more by the arm's chain with all errors as twists of their own, at the poses that the study follows."""
    found, measurements, errors = table
    arm, truth = sk120(), geometric_errors(sk120())
    start = np.zeros(6)
    start[[3, 4]] = BENT_WRIST[4], BENT_WRIST[5]
    points = measurements["test 1"].nominal_mm * 1e-3
    angles = follow_path(arm, points, start, BENT_WRIST).require_all("path")
    true = truth.positions(angles, errors / truth.sigmas)[0]
    row = found.query(f"model == '{NO_MODEL}' and stage == 'closed loop'").iloc[0]
    assert row["rms_mm"] == pytest.approx(np.sqrt(np.mean(np.sum((true - points) ** 2, axis=1))) * 1e3)
