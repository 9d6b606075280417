"""Rows foretold where nobody measured: whole regions are left out, not rows among the others as in a random split.

Who calibrates an arm uses it elsewhere, too: farther out, higher up, on its other side, and later. A model that only
draws smooth lines between the rows it knows does well on a random split and fails here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pandas as pd

from armscope.calibration.constants import CALIBRATING
from armscope.calibration.held_out import residuals_on
from armscope.calibration.model import LEVELS, Level, set_up
from armscope.calibration.splits import foretold
from armscope.core.averages import rms_distance
from armscope.core.grouping import named_configuration
from armscope.core.sampling import spread_evenly
from armscope.core.types import Array, Indices, unheard
from armscope.diagnosis import Settings, diagnose
from armscope.physics.model import predict
from armscope.real.protocol import ARMSCOPE
from armscope.real.reference import ReferenceRun
from armscope.recordings import Recordings
from armscope.robot import Arm, chain

COLUMNS = ("run", "region", "model", "train", "test", "rms_mm", "median_mm")


def regions(arm: Arm, recordings: Recordings) -> Iterator[tuple[str, Indices, Indices]]:
    """Parts of a table that are left out, each 30 % of the configurations: name, rows to learn from, rows left out.

    Args:
        arm: the nominal arm, by which points lie far out or high up.

    Returns:
        The last rows, the farthest from the base's axis, the highest, and those at the largest angles of joint 1.
    """
    tool = chain(arm, recordings.motor_angles).tool
    along = {
        "the last": np.arange(len(recordings), dtype=np.float64),
        "the farthest out": np.linalg.norm(tool[:, :2], axis=1),
        "the highest": tool[:, 2],
        "one side (joint 1)": recordings.motor_angles[:, 0],
    }
    configuration = named_configuration(recordings.run, recordings.id)
    for name, values in along.items():
        mean = np.bincount(configuration, values) / np.bincount(configuration)
        near = np.argsort(mean, kind="stable")[: int(CALIBRATING.train_share * len(mean))]
        inside = np.isin(configuration, near)
        yield name, np.flatnonzero(inside), np.flatnonzero(~inside)


def measure_regions(
    arm: Arm, recordings: Recordings, reference: ReferenceRun, tell: Callable[[str], None] = unheard
) -> pd.DataFrame:
    """How well plain calibrations and the diagnosis foretell regions that took no part; all see points alone.

    Args:
        arm: the nominal arm.
        recordings: all runs of a set.
        reference: which rows.
        tell: hears what is being done.

    Returns:
        A row per region and model: run, region, model, train, test (rows), rms_mm and median_mm of the 3D distance.
    """
    table = recordings.of_runs([reference.run], reference.first_id)
    rows = set_up(arm, table, one_base=False, tool_per_run=False)
    levels: list[Level] = [level for level in LEVELS if level != "compliance" or rows.loads is not None]
    found = []
    for region, train, outside in regions(arm, table):
        test = foretold(rows, train, outside)
        few = train[spread_evenly(len(train), reference.most_rows or len(train))]
        left: dict[str, Array] = {str(level): each for level, each in residuals_on(rows, levels, few, test).items()}
        verdict = diagnose(arm, table.rows(train), Settings(resamples=0, cross_validation=False, orientation=False))
        others = table.rows(test)
        left[ARMSCOPE] = predict(verdict.model, others) - others.positions
        for model, missed in left.items():
            distance = 1e3 * np.linalg.norm(missed, axis=1)
            sizes = (len(train), len(test), 1e3 * rms_distance(missed), float(np.median(distance)))
            found.append((reference.name, region, model, *sizes))
        tell(f"{reference.name}: without {region}, {ARMSCOPE} {found[-1][-2]:.3f} mm in {verdict.seconds:.0f} s")
    return pd.DataFrame(found, columns=list(COLUMNS))
