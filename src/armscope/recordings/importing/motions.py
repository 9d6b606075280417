"""mapping.yaml of arms in motion (`table: motions`): raw files become motions.csv, one row per sample."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, Self

import numpy as np
import pandas as pd
import pydantic

from armscope.core.inputs import Strict, read_keys, validate
from armscope.core.types import Array
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.importing.checked_values import required, scalar
from armscope.recordings.importing.conversion import Clock, as_columns, runs_of_rows
from armscope.recordings.importing.formats import Format, RowFilter, TextFormat, Time
from armscope.recordings.importing.mapping import (
    Groups,
    Mapping,
    PerMotor,
    RunColumn,
    RunFiles,
    Scalar,
    refuse_runs_of_one_name,
)
from armscope.recordings.importing.pieces import Piece
from armscope.recordings.motions import SCALE, torque_columns


class MotorPositions(PerMotor):
    """Motor positions; m of joints that slide."""

    unit: Literal["rad", "deg", "m"]


class Velocities(PerMotor):
    """Motor speeds."""

    unit: Literal["rad/s", "deg/s", "m/s"]


class Efforts(PerMotor):
    """Motor torque, N m (N of joints that slide), or current, A, once the numbers are multiplied by ``scale``.

    Positive along the motion that it drives.
    """

    scale: float = 1.0


class MotionColumns(Groups):
    """Where the columns of motions.csv come from."""

    time: Time | None = None
    positions: MotorPositions | None = None
    speeds: Velocities | None = None
    torque: Efforts | None = None
    current: Efforts | None = None
    payload: Scalar | None = None
    temperature: Scalar | None = None
    temperatures: PerMotor | None = None
    run: RunColumn | None = None

    def check(self, of_run: str) -> None:
        """Make sure that nothing needed is missing. Raises ValueError: it is."""
        if self.time is None or self.positions is None:
            raise ValueError(f"a motion needs `time` and `positions`{of_run}")
        if (self.torque is None) == (self.current is None):
            raise ValueError(f"what the motors did is `torque` or `current`, one of the two{of_run}")
        if self.temperature is not None and self.temperatures is not None:
            raise ValueError(f"`temperature` is the arm's, `temperatures` has one per motor: one of the two{of_run}")
        motors = len(self.positions.columns)
        for name in ("speeds", "torque", "current", "temperatures"):
            group = getattr(self, name)
            if group is not None and len(group.columns) != motors:
                raise ValueError(f"`{name}` names {len(group.columns)} columns for {motors} motors{of_run}")


class MotionRun(RunFiles):
    """One run of a table of motions, with groups of its own."""

    columns: MotionColumns = MotionColumns()


class MotionMapping(Strict):
    """mapping.yaml of motions as a whole. Without ``runs`` every raw file becomes a run, named by its stem."""

    table: Literal["motions"]
    description: str = ""
    format: Format = TextFormat()
    columns: MotionColumns
    rows: tuple[RowFilter, ...] = ()
    runs: tuple[MotionRun, ...] = ()

    @pydantic.model_validator(mode="after")
    def _complete(self) -> Self:
        for run in self.runs or (MotionRun(run="", file=""),):
            self.columns.with_own(run.columns).check(f" (run {run.run!r})" if run.run else "")
        refuse_runs_of_one_name(self.runs)
        return self

    def table_columns(self) -> list[str]:
        """Those of motions.csv that any run has, in the contract's order."""
        stated = [self.columns.with_own(run.columns) for run in self.runs] or [self.columns]
        names: dict[str, None] = {}
        for columns in stated:
            names |= dict.fromkeys(motion_columns(columns))
        last = [name for name in names if name == "payload_kg" or name.startswith("temperature")]
        return [*(name for name in names if name not in last), *sorted(last, key=lambda name: name != "payload_kg")]


def motion_columns(columns: MotionColumns) -> list[str]:
    """Names of the columns that a run's groups become."""
    assert columns.positions is not None
    motors, unit = range(1, len(columns.positions.columns) + 1), columns.positions.unit.replace("deg", "rad")
    names = ["run", "time_s", *(f"q{j}_{unit}" for j in motors)]
    if columns.speeds is not None:
        names += [f"dq{j}_{unit}_s" for j in motors]
    sliding = np.full(len(motors), unit == "m")
    names += torque_columns(sliding) if columns.torque is not None else [f"current{j}_a" for j in motors]
    names += ["payload_kg"] * (columns.payload is not None)
    names += ["temperature_c"] * (columns.temperature is not None)
    return names + [f"temperature{j}_c" for j in motors] * (columns.temperatures is not None)


class MotionConverter:
    """The columns of motions.csv from those of a run."""

    def __init__(self, columns: MotionColumns, run: str) -> None:
        self.columns, self.run, self.clock = columns, run, Clock()

    def table(self, piece: Piece) -> pd.DataFrame:
        """A piece in the columns of motions.csv that the run has."""
        columns = self.columns
        assert columns.time is not None
        assert columns.positions is not None
        effort = columns.torque or columns.current
        assert effort is not None
        runs = runs_of_rows(piece, columns.run, self.run)
        values = [self.clock.time(piece, columns.time, runs)[:, None], _scaled(piece, columns.positions)]
        if columns.speeds is not None:
            values.append(_scaled(piece, columns.speeds))
        values.append(required(piece, effort.columns) * effort.scale)
        if columns.payload is not None:
            values.append(scalar(piece, columns.payload, 0.0, "a payload is not negative")[:, None])
        if columns.temperature is not None:
            rule = "no temperature is below absolute zero"
            values.append(scalar(piece, columns.temperature, POSSIBLE.coldest_c, rule)[:, None])
        for column in () if columns.temperatures is None else columns.temperatures.columns:
            rule = "no temperature is below absolute zero"
            values.append(scalar(piece, Scalar(column=column), POSSIBLE.coldest_c, rule)[:, None])
        return pd.DataFrame({"run": runs} | as_columns(motion_columns(columns)[1:], np.hstack(values)))


def _scaled(piece: Piece, group: MotorPositions | Velocities) -> Array:
    return required(piece, group.columns) * SCALE[group.unit.removesuffix("/s")]


def load_any_mapping(path: Path | str) -> Mapping | MotionMapping:
    """Read mapping.yaml of points or, where it says `table: motions`, of motions. Raises InputError: a key, unit or
    group that can't be; it names the place, the rule and the nearest known key."""
    content = read_keys(path)
    return validate(MotionMapping, content, path) if "table" in content else validate(Mapping, content, path)
