"""Regions that took no part lie beyond all that did, and an arm whose physics is known is foretold there, too."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from armscope.real.protocol import COLUMNS, measure_regions, regions
from armscope.real.reference import ReferenceRun
from armscope.recordings import as_recordings
from armscope.robot import chain
from tests.real.recorded import arm, table

NOISE_MM = 0.02
RUN = ReferenceRun(name="one", run="one", splits=1, figures_mm={"nominal": (1.5, 0.1)})


def offsets(angles, rng):
    return np.tile([0.0, 2e-3, -1e-3, 0, 1e-3, 0], (len(angles), 1))


def test_a_region_lies_beyond_all_rows_that_are_learned_from():
    rows = as_recordings(table(100), "made up", 6)
    tool = chain(arm(), rows.motor_angles).tool
    along = [np.arange(100), np.linalg.norm(tool[:, :2], axis=1), tool[:, 2], rows.motor_angles[:, 0]]
    for (_, train, test), values in zip(regions(arm(), rows), along, strict=True):
        assert (len(train), len(test)) == (70, 30)
        assert values[train].max() < values[test].min()


def test_all_targets_of_a_configuration_stay_together():
    one = table(40)
    rows = as_recordings(pd.concat([one.assign(target=name) for name in "ab"], ignore_index=True), "made up", 6)
    for name, train, test in regions(arm(), rows):
        assert not set(rows.id[train]) & set(rows.id[test]), name
        assert len(train) == 2 * 28


@pytest.fixture(scope="module")
def found():
    return measure_regions(arm(), as_recordings(table(120, NOISE_MM, error_rad=offsets), "made up", 6), RUN)


@pytest.mark.long
def test_known_physics_holds_where_nobody_measured(found):
    assert list(found.columns) == list(COLUMNS)
    assert found["region"].nunique() == 4
    by_model = found.pivot(index="region", columns="model", values="rms_mm")
    floor = NOISE_MM * np.sqrt(3)
    assert (by_model["nominal"] > 10 * floor).all()
    # zeros found in a part of the workspace leave a little more than the noise in another
    assert (by_model["armscope"] < 2 * floor).all()
    assert (by_model["armscope"] > 0.7 * floor).all()


@pytest.mark.long
def test_the_median_is_of_the_distances_whose_rms_stands_beside_it(found):
    assert (found["median_mm"] < found["rms_mm"]).all()
