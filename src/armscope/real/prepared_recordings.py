"""Real recordings made ready to conceal something in: which rows, what stands beside them, where the frames are.

All tables of an arm, altered or not, hold the same rows and the same columns. Two columns are not the source's:
`approach` follows from the order of recording (sign of each joint's step from the configuration before), and
`temperature_c` is made up (a slow swing), so that effects which follow them can be concealed and found; nothing in the
real arm follows the latter. Left out are times: rows stand in order.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.calibration.calibrate import calibrate
from armscope.calibration.held_out import random_split
from armscope.core.grouping import named_configuration
from armscope.core.inputs import InputError
from armscope.core.types import Array, Indices
from armscope.real.constants import CONCEALING
from armscope.recordings import Recordings, as_recordings
from armscope.robot import Arm

KEPT = r"id|run|target|q\d+_rad|[xyz]_mm|q[wxyz]|tau\d+_nm|payload_kg|sigma_[xyz]_mm|approach\d+|temperature_c"


@dataclass(frozen=True, eq=False)
class PreparedRecordings:
    """Rows of a real arm with everything that may be seen of them."""

    arm: Arm
    table: pd.DataFrame  # N rows as recordings.csv has them
    recordings: Recordings  # the same, read
    # train, test: numbers of rows for the diagnosis, and of rows that test
    train: Indices
    test: Indices
    configuration: Indices  # (N,) number of each row's configuration in the order of recording
    targets: tuple[str, ...]  # their names; target: (N,) number of each row's
    target: Indices
    tools: Array  # (K, 3) fitted tool points in the last frame, m
    rotations: Array  # (N, 3, 3) fitted, measurement frame from arm base


def of_run(table: pd.DataFrame, run: str | None, first_id: int | None) -> pd.DataFrame:
    """A run's rows, from an id on; all rows where nothing is asked for.

    Args:
        table: as in the file.
        run: which; None takes all.
        first_id: the first row's id; None takes all.

    Returns:
        The rows, numbered from 0.
    """
    if run is not None:
        table = table[table["run"] == run]
    if first_id is not None:
        table = table[table["id"].astype(int) >= first_id]
    return table.reset_index(drop=True)


def with_payload(table: pd.DataFrame) -> pd.DataFrame:
    """The rows whose payload is known; each run's tool counts as a target of its own, since it was taken off."""
    rows = table[table["payload_kg"].notna()] if "payload_kg" in table else table.iloc[:0]
    return rows.assign(target=rows["run"]).reset_index(drop=True)


def prepared_recordings(arm: Arm, table: pd.DataFrame, most_rows: int, source: str = "table") -> PreparedRecordings:
    """Rows of a recording with the columns that all tables have, at most so many, drawn by configuration.

    Args:
        arm: the nominal arm.
        table: the rows as in the file.
        most_rows: larger tables are thinned.
        source: the table's name, for messages.

    Returns:
        The rows and what the virtual worlds' engine needs of them.

    Raises:
        InputError: the arm is that of a URDF, which the virtual worlds' engine does not read.
    """
    if arm.description.dh is None:
        raise InputError(
            arm.description.urdf,
            "",
            "a URDF",
            "effects are concealed in arms of D-H rows",
            "`armscope.robot.denavit_hartenberg.as_dh` makes rows of any chain of hinges.",
        )
    configuration = _configurations(table)
    angles = table[[f"q{j + 1}_rad" for j in range(arm.n_motors)]].to_numpy(dtype=float)
    approach = _approach(angles, configuration)
    table = table.assign(**{f"approach{j + 1}": approach[:, j] for j in range(arm.n_motors)})
    table = _thinned(table, configuration, most_rows)
    configuration = _configurations(table)
    table = table.assign(temperature_c=_temperature(configuration))
    table = table[[name for name in table.columns if re.fullmatch(KEPT, name)]].dropna(axis="columns", how="all")
    recordings = as_recordings(table, source, arm.n_motors)
    calibrated = calibrate(arm, recordings, "geometric", robust=True, tool_per_run=False, orientation=False)
    rows, state = calibrated.set_up, calibrated.state
    train, test = random_split(recordings, 0)
    return PreparedRecordings(
        arm, table, recordings, train, test, configuration, rows.tool_names, rows.tool, state.tools,
        state.rotations[rows.base],
    )  # fmt: skip


def _configurations(table: pd.DataFrame) -> Indices:
    run = table["run"] if "run" in table else pd.Series("", index=table.index)
    return named_configuration(run.to_numpy(str), table["id"].to_numpy(str))


def _approach(angles: Array, configuration: Indices) -> NDArray[np.int64]:
    """(N, m) sign of each joint's step from the configuration before; a joint that stood still keeps its side."""
    first = np.unique(configuration, return_index=True)[1]
    steps = np.diff(angles[first], axis=0, prepend=angles[first][:1])
    side = np.where(np.abs(steps) > CONCEALING.stopped_rad, np.sign(steps), 0).astype(int)
    for row in range(1, len(side)):
        side[row] = np.where(side[row] == 0, side[row - 1], side[row])
    side[side == 0] = 1
    return np.asarray(side[configuration], dtype=np.int64)


def _thinned(table: pd.DataFrame, configuration: Indices, most_rows: int) -> pd.DataFrame:
    """Whole configurations drawn at random, in their order."""
    count = int(configuration.max()) + 1
    wanted = int(most_rows * count / len(table))
    if count <= wanted:
        return table
    kept = np.random.default_rng(0).choice(count, wanted, replace=False)
    return table[np.isin(configuration, kept)].reset_index(drop=True)


def _temperature(configuration: Indices) -> Array:
    """A slow swing over the recording, deg C."""
    phase = 2 * np.pi * CONCEALING.swings * configuration / max(int(configuration.max()), 1)
    return np.asarray((CONCEALING.coolest_c + CONCEALING.swing_k / 2 * (1 + np.sin(phase))).round(2))
