"""One small study for all tests of this folder: anchored robot and a few more, measured on the printed paths."""

import numpy as np
import pandas as pd
import pytest

from armscope.errormodels.features import FDP_AI, FDP_CI, FOURIER_2_AI, POLYNOMIAL_4_AI, SDP_AI, SDP_CI
from armscope.errormodels.swarm_fit import fit_swarms
from armscope.paper.residuals import residual_table
from armscope.paper.virtual import PlannedPaths, PlannedPoses, identification_poses, measure_virtual, trajectory_poses
from armscope.robot import load_arm
from armscope.world.of_the_paper import Tracker
from armscope.world.tolerances import geometric_errors
from tests.robot.arms import SK120

CORNERS_MM = [[1100, 800, 600], [1100, -800, 600], [1500, -800, 1400], [1500, 800, 1400]]
STARTS_MM = [[1200, -600, 600], [500, 500, 1400]]
ENSEMBLE = 12
SPECS = (FDP_CI, FDP_AI, SDP_CI, SDP_AI, POLYNOMIAL_4_AI, FOURIER_2_AI)


@pytest.fixture(scope="session")
def arm():
    return load_arm(SK120)


@pytest.fixture(scope="session")
def errors(arm):
    return geometric_errors(arm)


@pytest.fixture(scope="session")
def trajectories(arm):
    return trajectory_poses(arm, PlannedPaths(CORNERS_MM, 50, STARTS_MM, 20, 5, 200, 400).by_name())


@pytest.fixture(scope="session")
def identification(errors, trajectories):
    return identification_poses(errors, trajectories, PlannedPoses(85, 1000, 0.1, 3.1), seed=1)


@pytest.fixture(scope="session")
def study(errors, trajectories, identification):
    poses = pd.concat([identification[0], trajectories], ignore_index=True)
    return measure_virtual(errors, poses, Tracker((4.0, 0.0, 1.5)), ENSEMBLE, seed=2)


@pytest.fixture(scope="session")
def fits(study):
    measurements = study.measurements
    anchored = fit_swarms(measurements.fit_problems(SPECS, ["anchored"]), seeds=range(4))
    return anchored + fit_swarms(measurements.fit_problems(SPECS, list(measurements.robots[1:])), seeds=[0])


@pytest.fixture(scope="session")
def residuals(study, fits):
    return residual_table(study.measurements, fits)


def rss(values):
    return np.sqrt(np.sum(np.square(values), axis=0))
