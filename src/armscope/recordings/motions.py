"""motions.csv: one row per sample of an arm in motion, units in the column names, checked once when it is read."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array, Indices
from armscope.recordings.blank_cells import payload_held, temperature_between
from armscope.recordings.column_reader import ColumnReader
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.first_lines import DRIVE_COLUMN
from armscope.recordings.textfile import read_text_table

MOTION_COLUMN = (
    DRIVE_COLUMN + r"|q[1-9]\d*_(rad|deg|m)|dq[1-9]\d*_(rad|deg|m)_s|ddq[1-9]\d*_(rad|deg|m)_s2"
    r"|q[1-9]\d*_(cmd|link)_(rad|deg|m)|temperature[1-9]\d*_c"
)
PLAIN = ("run", "time_s", "payload_kg", "temperature_c")
SCALE = {"rad": 1.0, "deg": np.pi / 180, "m": 1.0}


@dataclass(frozen=True, eq=False)
class Motions:
    """N samples of an arm with m motors; SI units; NaN where a value was not recorded."""

    time: Array  # (N,) s, from any start in each run
    q: Array  # (N, m) motor positions, rad or m
    effort: Array  # (N, m) motor torque, N m (N for a sliding joint), or current, A: see ``kind``
    kind: Literal["torque", "current"]  # whether effort is torque or current
    sliding: NDArray[np.bool_]  # (m,) whether a position is a length
    run: NDArray[np.str_]  # (N,) text; "" where the table has no such column
    # dq, ddq, command: (N, m) recorded velocity, acceleration, commanded position; each or None
    dq: Array | None = None
    ddq: Array | None = None
    command: Array | None = None
    # (N,) kg; temperature: (N, m) deg C; each or None; NaN only in runs that have none at all
    payload: Array | None = None
    temperature: Array | None = None
    # (N, m) positions of the links behind their drives, rad or m; NaN where none is recorded; or None
    link: Array | None = None
    notes: tuple[str, ...] = ()  # what a user should know about how the table was read
    source: str = ""  # the file's name, for messages

    def __len__(self) -> int:
        return len(self.time)

    @property
    def n_motors(self) -> int:
        """Number of motors."""
        return int(self.q.shape[1])

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs in the order of their first row."""
        names, first = np.unique(self.run, return_index=True)
        return tuple(str(names[k]) for k in np.argsort(first))

    def rows(self, which: NDArray[np.bool_] | Indices | slice) -> Motions:
        """The samples of some rows, in that order."""
        per_row: dict[str, Any] = {
            name: value[which]
            for name, value in vars(self).items()
            if isinstance(value, np.ndarray) and name != "sliding"
        }
        return replace(self, **per_row)

    def at_times(self, time: Array) -> Motions:
        """The same samples at other times (N,), s."""
        return replace(self, time=time)


def read_motions(path: Path | str, n_motors: int | None = None, measured: bool = True) -> Motions:
    """Read motions.csv (``.gz`` allowed).

    Args:
        path: the file.
        n_motors: how many motors the arm has; None accepts as many as there are.
        measured: whether torques or currents must be present; False reads a motion whose torques are to be predicted.

    Returns:
        The samples in their order, SI units, with notes on what was passed over.

    Raises:
        InputError: names file, line, column, the value found, the rule and the cure.
    """
    path = Path(path)
    return as_motions(read_text_table(path), path, n_motors, measured)


def as_motions(
    table: pd.DataFrame, source: Path | str = "table", n_motors: int | None = None, measured: bool = True
) -> Motions:
    """A table with the columns of motions.csv as `Motions`; see `read_motions`.

    Args:
        table: every column as text or numbers.
        source: where it was read, for errors.
        n_motors: how many motors the arm has; None accepts as many as there are.
        measured: whether torques or currents must be present; where not, they are not looked at and NaN.

    Returns:
        The samples in their order.

    Raises:
        InputError: as `read_motions`.
    """
    reader = _Reader(table, source)
    if "time_s" not in table:
        rule = "the time of every sample stands in time_s"
        raise InputError(source, "line 1", "no column time_s", rule, nearest("time_s", table.columns))
    q, units = reader.drive_positions(n_motors)
    count = len(units)
    sliding = np.array([unit == "m" for unit in units])
    kind, effort = reader.effort(sliding, measured)
    unknown = [name for name in table.columns if name not in PLAIN and not _is_of_motors(name, count)]
    notes = [f"columns not used: {', '.join(unknown)}"] if unknown else []
    temperature = reader.optional(["temperature_c"], 1.0, squeeze=True)
    own = reader.optional([f"temperature{j}_c" for j in range(1, count + 1)], 1.0)
    if own is None and temperature is not None:
        own = np.repeat(temperature[:, None], count, axis=1)
    time, run = reader.required("time_s"), reader.text("run")
    payload = reader.optional(["payload_kg"], 1.0, squeeze=True)
    if payload is not None:
        payload, told = payload_held(payload, run)
        notes += told
    if own is not None:
        own, told = temperature_between(own, time, run)
        notes += told
    return Motions(
        time=time,
        q=q,
        effort=effort,
        kind=kind,
        sliding=sliding,
        run=run,
        dq=reader.per_motor(units, "dq{}_{}_s"),
        ddq=reader.per_motor(units, "ddq{}_{}_s2"),
        command=reader.per_motor(units, "q{}_cmd_{}"),
        payload=payload,
        temperature=own,
        link=reader.links(units),
        notes=tuple(notes),
        source=str(source),
    )


def _is_of_motors(column: str, count: int) -> bool:
    """Whether a column is a quantity of one of so many motors."""
    return bool(re.fullmatch(MOTION_COLUMN, column)) and all(
        int(j) <= count for j in re.findall(r"^[a-z]+(\d+)_", column)
    )


def torque_columns(sliding: NDArray[np.bool_]) -> list[str]:
    """Names of the motors' torques: tau1_nm ..., f1_n of a sliding joint."""
    return [f"f{j}_n" if slides else f"tau{j}_nm" for j, slides in enumerate(sliding, start=1)]


class OtherMotors(InputError):
    """A table of more motors, or fewer, than the arm has."""


class _Reader(ColumnReader):
    """Takes the columns of motions.csv out of a table, each checked as it is taken."""

    def required(self, column: str) -> Array:
        """(N,) a column that holds a number in every row."""
        return self._numbers(column, required=True)

    def drive_positions(self, n_motors: int | None) -> tuple[Array, list[str]]:
        """(N, m) positions in rad or m, and each column's unit."""
        matches = (re.fullmatch(r"q([1-9]\d*)_(rad|deg|m)", name) for name in self.table.columns)
        found: dict[int, str] = {}
        for m in matches:
            if m is not None:
                if int(m[1]) in found:
                    raise InputError(self.source, "line 1", m[0], f"motor {m[1]} has a position already", "Keep one.")
                found[int(m[1])] = m[2]
        count = n_motors if n_motors is not None else max(found, default=1)
        for motor in range(1, count + 1):
            if motor not in found:
                rule = f"the arm has motors q1 ... q{count}, each with its position (_rad, _deg; sliding: _m)"
                others = [name for name in self.table.columns if not re.match(r"q[1-9]\d*_", str(name))]
                slip = any(re.search(rf"q\D?{motor}(?!\d)", str(name), re.IGNORECASE) for name in others)
                fewer = not slip and sorted(found) == list(range(1, motor)) and motor > 1
                of_table = f"The table has {motor - 1} of them: is this the right robot for the recordings?"
                cure = of_table if fewer else nearest(f"q{motor}_rad", others)
                error = OtherMotors if fewer else InputError
                raise error(self.source, "line 1", f"no column q{motor}_rad", rule, cure)
        if max(found) > count:
            extra = f"q{max(found)}_{found[max(found)]}"
            cure = "Is this the right robot for the table?"
            raise OtherMotors(self.source, "line 1", extra, f"the arm has {count} motors", cure)
        units = [found[motor] for motor in range(1, count + 1)]
        return np.column_stack([self._position(j, unit) for j, unit in enumerate(units, start=1)]), units

    def _position(self, motor: int, unit: str) -> Array:
        column = f"q{motor}_{unit}"
        values = self.required(column) * SCALE[unit]
        largest = POSSIBLE.slide_m if unit == "m" else POSSIBLE.turn_rad
        beyond = np.flatnonzero(np.abs(values) > largest)
        if len(beyond):
            cure = (
                f"Are these degrees? Then call the column q{motor}_deg." if unit == "rad" else "Are these millimetres?"
            )
            row = int(beyond[0])
            rule = f"a position lies within {largest:.4g} {'m' if unit == 'm' else 'rad'}"
            raise self._error(row, column, self.table[column].iloc[row], rule, cure)
        return values

    def effort(self, sliding: NDArray[np.bool_], measured: bool) -> tuple[Literal["torque", "current"], Array]:
        """What the motors did: torque or current, all motors in one; NaN where that is not asked for."""
        if not measured:
            return "torque", np.full((len(self.table), len(sliding)), np.nan)
        torque = torque_columns(sliding)
        current = [f"current{j}_a" for j in range(1, len(sliding) + 1)]
        kinds: tuple[tuple[Literal["torque", "current"], list[str]], ...] = (("torque", torque), ("current", current))
        for kind, columns in kinds:
            if any(name in self.table for name in columns):
                missing = [name for name in columns if name not in self.table]
                if missing:
                    self._refuse_other_kind(missing[0], sliding)
                    rule = f"{', '.join(columns)} come together"
                    cure = nearest(missing[0], [name for name in self.table.columns if name not in columns])
                    raise InputError(self.source, "line 1", f"no column {missing[0]}", rule, cure)
                return kind, np.column_stack([self.required(name) for name in columns])
        rule = f"what the motors did stands in {torque[0]} ... or {current[0]} ..."
        cure = nearest(torque[0], self.table.columns)
        raise InputError(self.source, "line 1", f"no column {torque[0]}", rule, cure)

    def _refuse_other_kind(self, missing: str, sliding: NDArray[np.bool_]) -> None:
        """Tell a joint whose position is a length and whose effort is a torque, or the other way round."""
        for j, slides in enumerate(sliding, start=1):
            own, other = (f"f{j}_n", f"tau{j}_nm") if slides else (f"tau{j}_nm", f"f{j}_n")
            if missing == own and other in self.table:
                found = f"{other} beside q{j}_{'m' if slides else 'rad'}"
                rule = "a joint that turns has q_rad (or _deg) and tau_nm, one that slides q_m and f_n"
                raise InputError(self.source, "line 1", found, rule, f"Rename one of them: what does joint {j} do?")

    def links(self, units: list[str]) -> Array | None:
        """(N, m) positions of the links, NaN of joints where none is recorded; None where there are none at all.

        Args:
            units: of the motors' positions; a link may be recorded in the other unit of an angle.

        Returns:
            rad or m.
        """
        found = np.full((len(self.table), len(units)), np.nan)
        for j, unit in enumerate(units, start=1):
            allowed = ("m",) if unit == "m" else ("rad", "deg")
            present = [u for u in SCALE if f"q{j}_link_{u}" in self.table]
            for each in present:
                if each not in allowed or len(present) > 1:
                    rule = f"one position of link {j}, in {' or '.join(allowed)} as its motor moves"
                    raise InputError(self.source, "line 1", f"q{j}_link_{each}", rule, "Keep one, in that unit.")
                found[:, j - 1] = self.required(f"q{j}_link_{each}") * SCALE[each]
        return None if np.isnan(found).all() else found

    def per_motor(self, units: list[str], name: str) -> Array | None:
        """(N, m) an optional quantity of every motor, in the unit of its position."""
        columns = [name.format(j, unit) for j, unit in enumerate(units, start=1)]
        values = self.optional(columns, 1.0)
        return None if values is None else values * np.array([SCALE[unit] for unit in units])
