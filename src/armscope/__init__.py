"""armscope: see where a robot arm misses its target, and why."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

    from armscope.diagnosis import Diagnosis, Settings
    from armscope.recordings import Recordings
    from armscope.robot import Arm

__all__ = ["diagnose"]


def diagnose(
    robot: Arm | Path | str, recordings: Recordings | pd.DataFrame | Path | str, settings: Settings | None = None
) -> Diagnosis:
    """Find where simulation and recordings differ, and which physics was left out: `armscope diagnose` for notebooks.

    Args:
        robot: an arm, or the path of its robot.yaml.
        recordings: a recordings table, a data frame with its columns, or the path of one.
        settings: see `armscope.diagnosis.Settings`.

    Returns:
        The verdict.

    Raises:
        InputError: something that can't be used; it says what, where, and how to mend it.
    """
    from threadpoolctl import threadpool_limits

    from armscope.diagnosis import diagnose as diagnose_arm
    from armscope.recordings import Recordings, as_recordings, read_recordings
    from armscope.robot import Arm, load_arm

    arm = robot if isinstance(robot, Arm) else load_arm(robot)
    if isinstance(recordings, str | Path):
        recordings = read_recordings(recordings, arm.n_motors)
    elif not isinstance(recordings, Recordings):
        recordings = as_recordings(recordings, "data frame", arm.n_motors)
    with threadpool_limits(1):  # small matrices: threads of BLAS would only wait for each other
        return diagnose_arm(arm, recordings, settings)
