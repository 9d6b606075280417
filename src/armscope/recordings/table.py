"""recordings.csv: one row per measured point, units in the column names, checked once when it is read."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError, nearest
from armscope.core.told import InWords
from armscope.core.types import Array, Indices
from armscope.recordings.column_reader import ColumnReader
from armscope.recordings.columns import Names, as_in_contract, column_named, name_meant_by
from armscope.recordings.textfile import read_text_table

if TYPE_CHECKING:
    import pandas as pd  # slow to import


NO_RUNS = "The table names no runs (column run): without --run all of its rows are taken."


@dataclass(frozen=True, eq=False, repr=False)
class Recordings(InWords):
    """N measured points of an arm with m motors; SI units; NaN where a context value was not recorded."""

    motor_angles: Array  # (N, m) commanded, rad
    positions: Array  # (N, 3) measured tool points in the measurement frame, m; NaN for poses without a measurement
    # run, target, id: (N,) text; "" where the table has no such column (``id``: the row's number)
    run: NDArray[np.str_]
    target: NDArray[np.str_]
    id: NDArray[np.str_]
    orientation: Array | None = None  # (N, 4) unit quaternions (w, x, y, z), measurement frame from tool frame, or None
    time: Array | None = None  # (N,) s; temperature: (N,) deg C; payload: (N,) kg at the tool point; each or None
    temperature: Array | None = None
    payload: Array | None = None
    approach: Array | None = None  # (N, m) -1 or +1, sign of each motor's last motion, or None
    speed: Array | None = None  # (N, m) rad/s; torque: (N, m) N m; each or None
    torque: Array | None = None
    sigma: Array | None = None  # (N, 3) stated 1-sigma uncertainty per axis, m, or None
    # (N,) of each row in the order of the table as it was read: its id where ids are numbers that rise in every run,
    # else counted from 1. NaN for a pose of now, after all that was recorded: what jumped at some row has jumped, where
    # a wander in the order of rows stands is not known
    number: Array = field(default_factory=lambda: np.empty(0))
    extra: pd.DataFrame | None = None  # the table's other columns, as read
    notes: tuple[str, ...] = ()  # what a user should know about how the table was read
    source: str = ""  # the file's name, for messages
    # whether nobody recorded ``approach``: it is what the order of the rows tells, if they were measured in it
    sides_by_order: bool = False

    def __post_init__(self) -> None:
        if len(self.number) != len(self):
            object.__setattr__(self, "number", _numbered(self.id, self.run))

    def __len__(self) -> int:
        return len(self.motor_angles)

    def sentences(self) -> tuple[str, ...]:
        """Rows, motors, runs, what was recorded, and who takes it."""
        points = int(np.isfinite(self.positions).all(axis=1).sum())
        counts = [(points, "with a point"), (int(self.oriented.sum()), "with an orientation")]
        context = ("time", "temperature", "payload", "approach", "speed", "torque")
        there = [name for name in context if getattr(self, name) is not None]
        runs, targets = (len(set(each.tolist())) for each in (self.run, self.target))
        return (
            f"{self.source or 'recordings'}: {len(self)} rows of {self.n_motors} motor angles"
            + "".join(f", {count} {what}" for count, what in counts if count) + ".",
            f"Runs: {runs}; targets: {targets}; also recorded: {', '.join(there) or 'nothing'}.",
            *(f"Note: {note}." for note in self.notes),
            "Next: armscope.check(recordings, robot)." if points else "Next: armscope.predict(model, poses).",
        )  # fmt: skip

    @property
    def quaternions(self) -> Array:
        """(N, 4) orientations (w, x, y, z), NaN where not measured."""
        return np.full((len(self), 4), np.nan) if self.orientation is None else self.orientation

    @property
    def oriented(self) -> NDArray[np.bool_]:
        """(N,) rows that hold an orientation."""
        return np.asarray(np.isfinite(self.quaternions).all(axis=1))

    @property
    def n_motors(self) -> int:
        """Number of motor angles per row."""
        return int(self.motor_angles.shape[1])

    def check_motors(self, arm: str, count: int) -> None:
        """Refuse the table of another arm than the one of this name and number of motors. Raises InputError: it has
        another number of motor angles."""
        if self.n_motors != count:
            rule = f"{arm} has {count} motors"
            cure = "Is this the right robot for the table?"
            raise InputError(self.source, "line 1", f"{self.n_motors} motor angles", rule, cure)

    def rows(self, which: NDArray[np.bool_] | Indices | slice) -> Recordings:
        """The recordings of some rows, in that order."""
        per_row: dict[str, Any] = {
            name: value[which]
            for name, value in vars(self).items()
            if isinstance(value, np.ndarray) and len(value) == len(self)
        }
        extra = None if self.extra is None else self.extra.iloc[which].reset_index(drop=True)
        return replace(self, **per_row, extra=extra)

    def of_runs(self, runs: Collection[str], first_id: int | None = None) -> Recordings:
        """The rows of some runs (none named: of all), from an id on. Raises InputError: a run that no row has, or
        nothing left."""
        known = set(self.run.tolist())
        for run in runs:
            if run not in known:
                cure = nearest(run, known) or NO_RUNS
                raise InputError(self.source, "column run", run, "no row has this run", cure)
        kept = np.isin(self.run, [*runs]) if runs else np.ones(len(self), dtype=bool)
        if first_id is not None:
            kept &= [text.isdecimal() and int(text) >= first_id for text in self.id]
            if not kept.any():
                raise InputError(self.source, "column id", first_id, "no row has this id or a later one")
        return self.rows(kept)


def _numbered(ids: NDArray[np.str_], runs: NDArray[np.str_]) -> Array:
    """(N,) numbers of a whole table's rows: what is cut from it keeps them.

    Ids in another order than the rows name poses, not moments.
    """
    counted = np.arange(1.0, len(ids) + 1)
    try:
        numbers = ids.astype(np.float64)
    except ValueError:
        return counted
    rise = all(np.all(np.diff(numbers[runs == run]) >= 0) for run in np.unique(runs))
    return numbers if rise and np.isfinite(numbers).all() else counted


def unmeasured(motor_angles: Array, run: str = "") -> Recordings:
    """Poses (N, m) rad of now, without measurements, all of one run."""
    count = len(motor_angles)
    none, now = np.full(count, ""), np.full(count, np.nan)
    ids = np.arange(1, count + 1).astype(str)
    return Recordings(motor_angles, np.full((count, 3), np.nan), np.full(count, run), none, ids, number=now)


def read_recordings(path: Path | str, n_motors: int | None = None, measured: bool = True) -> Recordings:
    """Read a recordings table (CSV, ``.gz`` allowed).

    Args:
        path: the file.
        n_motors: how many motor angles the arm has; None accepts as many as there are.
        measured: whether positions must be present; False reads poses to be predicted, of now where they have no ids.

    Returns:
        The rows in their order, SI units, with notes on what was passed over.

    Raises:
        InputError: names file, line, column, the value found, the rule and the cure.
    """
    path = Path(path)

    def check(header: list[str]) -> None:
        renamed = as_in_contract(header)
        names = Names([renamed.get(name, name) for name in header], path)
        names.motor_angles(n_motors)
        names.positions(measured)

    return as_recordings(read_text_table(path, check), path, n_motors, measured)


def as_recordings(
    table: pd.DataFrame, source: Path | str = "table", n_motors: int | None = None, measured: bool = True
) -> Recordings:
    """A table with the columns of the contract as `Recordings`; see `read_recordings`.

    Args:
        table: every column as text or numbers.
        source: where it was read, for errors.
        n_motors: how many motor angles the arm has; None accepts as many as there are.
        measured: whether positions must be present; without them, and without ids, the poses are of now.

    Returns:
        The rows in their order.

    Raises:
        InputError: as `read_recordings`.
    """
    renamed = as_in_contract(table.columns)
    table = table.rename(columns=renamed) if renamed else table
    repeated = table.columns[table.columns.duplicated()]
    if len(repeated):
        raise InputError(str(source), "", str(repeated[0]), "column names must differ, this one stands twice")
    reader = ColumnReader(table, source)
    angles = reader.motor_angles(n_motors)
    positions = reader.positions(measured)
    count = angles.shape[1]
    recordings = Recordings(
        motor_angles=angles,
        positions=positions,
        run=reader.text("run"),
        target=reader.text("target"),
        id=reader.text("id") if "id" in table else np.arange(1, len(table) + 1).astype(str),
        orientation=reader.orientation(),
        time=reader.optional(["time_s"], 1.0, squeeze=True),
        temperature=reader.optional(["temperature_c"], 1.0, squeeze=True),
        payload=reader.optional(["payload_kg"], 1.0, squeeze=True),
        approach=reader.approach(count),
        speed=reader.optional([f"dq{j}_rad_s" for j in range(1, count + 1)], 1.0),
        torque=reader.optional([f"tau{j}_nm" for j in range(1, count + 1)], 1.0),
        sigma=reader.sigma(),
        number=np.full(0 if measured or "id" in table else len(table), np.nan),
        source=str(source),
    )
    reader.check_duplicates(recordings.id)
    unknown = [name for name in table.columns if column_named(str(name)) is None]
    likened = [_with_likeness(str(name), table.columns) for name in unknown]
    told = [f"columns kept but not used: {', '.join(likened)}"] if unknown else []
    told += [f"columns read as {', '.join(renamed.values())}: {', '.join(renamed)}"] if renamed else []
    return replace(recordings, extra=table[unknown] if unknown else None, notes=tuple(told))


def _with_likeness(name: str, there: Iterable[str]) -> str:
    """A column that is not known, with the one that it may be a misspelling of, unless that is there, too."""
    meant = name_meant_by(name)
    return f"{name} (did you mean {meant}?)" if meant and meant not in there else name
