"""An arm and a table of it with nothing wrong."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armscope.robot import chain
from tests.calibration.worlds import far_away, measured, planted, poses, ur_like

TOOL = {"": [0.05, 0.1, 0.2]}


@pytest.fixture
def arm():
    return ur_like()


@pytest.fixture
def sound(arm):
    """A table with nothing wrong: an arm of usual tolerances, an instrument far away, orientations included."""
    rng = np.random.default_rng(1)
    real, base, angles = planted(arm, rng), far_away(rng), poses(rng, 80, 6)
    recordings = measured(real, angles, base, TOOL, 5e-5, rng)
    turned = Rotation.from_matrix(base[0] @ chain(real, angles).tool_rotation) * Rotation.from_rotvec([0.3, -1.0, 0.5])
    return replace(recordings, orientation=np.roll(turned.as_quat(), 1, axis=1))
