"""recordings.csv: one row per measured point, units in the column names, checked once when it is read."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from armscope.core.inputs import InputError, nearest
from armscope.core.types import Array
from armscope.recordings.textfile import WORDS, read_text_table

LARGEST_ANGLE_RAD = 4 * np.pi
"""Beyond two turns either way no arm's joint stands, so a larger number is not in radians."""

LARGEST_POSITION_M = 1e4
"""No instrument sees further, and tables with ten digits hold less than a micrometre up to here."""

LARGEST_NUMBER = 1e15
"""No recorded quantity reaches it in its unit; what lies beyond stands for no value, or overflows when squared."""

ABSOLUTE_ZERO_C = -273.15

UNITS: dict[str, float] = {"rad": 1.0, "deg": np.pi / 180, "mm": 1e-3, "m": 1.0}
CONTEXT = r"q[1-9]\d*_(rad|deg)|approach[1-9]\d*|dq[1-9]\d*_rad_s|tau[1-9]\d*_nm"
PLAIN = [
    "id",
    "run",
    "target",
    "x_mm",
    "y_mm",
    "z_mm",
    "x_m",
    "y_m",
    "z_m",
    "qw",
    "qx",
    "qy",
    "qz",
    "time_s",
    "temperature_c",
    "payload_kg",
    "sigma_mm",
    "sigma_x_mm",
    "sigma_y_mm",
    "sigma_z_mm",
]


@dataclass(frozen=True, eq=False)
class Recordings:
    """N measured points of an arm with m motors; SI units; NaN where a context value was not recorded.

    Attributes:
        motor_angles: (N, m) commanded, rad.
        positions: (N, 3) measured tool points in the measurement frame, m; NaN for poses without a measurement.
        run, target, id: (N,) text; "" where the table has no such column (``id``: the row's number).
        orientation: (N, 4) unit quaternions (w, x, y, z), measurement frame from tool frame, or None.
        time: (N,) s; temperature: (N,) deg C; payload: (N,) kg at the tool point; each or None.
        approach: (N, m) -1 or +1, sign of each motor's last motion, or None.
        speed: (N, m) rad/s; torque: (N, m) N m; each or None.
        sigma: (N, 3) stated 1-sigma uncertainty per axis, m, or None.
        extra: the table's other columns, as read.
        notes: what a user should know about how the table was read.
        source: the file's name, for messages.
    """

    motor_angles: Array
    positions: Array
    run: NDArray[np.str_]
    target: NDArray[np.str_]
    id: NDArray[np.str_]
    orientation: Array | None = None
    time: Array | None = None
    temperature: Array | None = None
    payload: Array | None = None
    approach: Array | None = None
    speed: Array | None = None
    torque: Array | None = None
    sigma: Array | None = None
    extra: pd.DataFrame | None = None
    notes: tuple[str, ...] = ()
    source: str = ""

    def __len__(self) -> int:
        return len(self.motor_angles)

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

    def rows(self, which: NDArray[np.bool_] | NDArray[np.intp] | slice) -> Recordings:
        """The recordings of some rows, in that order."""
        per_row: dict[str, Any] = {
            name: value[which]
            for name, value in vars(self).items()
            if isinstance(value, np.ndarray) and len(value) == len(self)
        }
        extra = None if self.extra is None else self.extra.iloc[which].reset_index(drop=True)
        return replace(self, **per_row, extra=extra)


def read_recordings(path: Path | str, n_motors: int | None = None, measured: bool = True) -> Recordings:
    """Read a recordings table (CSV, ``.gz`` allowed).

    Args:
        path: the file.
        n_motors: how many motor angles the arm has; None accepts as many as there are.
        measured: whether positions must be present; False reads poses to be predicted.

    Returns:
        The rows in their order, SI units, with notes on what was passed over.

    Raises:
        InputError: names file, row (line of the file), column, the value found, the rule and the cure.
    """
    path = Path(path)
    return as_recordings(read_text_table(path), path, n_motors, measured)


def as_recordings(
    table: pd.DataFrame, source: Path | str = "table", n_motors: int | None = None, measured: bool = True
) -> Recordings:
    """A table with the columns of the contract as `Recordings`; see `read_recordings`.

    Args:
        table: every column as text or numbers.
        source: where it was read, for errors.
        n_motors: how many motor angles the arm has; None accepts as many as there are.
        measured: whether positions must be present.

    Returns:
        The rows in their order.

    Raises:
        InputError: as `read_recordings`.
    """
    reader = _Reader(table, source)
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
        temperature=reader.at_least("temperature_c", ABSOLUTE_ZERO_C, "no temperature is below absolute zero"),
        payload=reader.at_least("payload_kg", 0.0, "a payload is not negative"),
        approach=reader.approach(count),
        speed=reader.optional([f"dq{j}_rad_s" for j in range(1, count + 1)], 1.0),
        torque=reader.optional([f"tau{j}_nm" for j in range(1, count + 1)], 1.0),
        sigma=reader.sigma(),
        source=str(source),
    )
    reader.check_duplicates(recordings)
    unknown = [name for name in table.columns if name not in PLAIN and not re.fullmatch(CONTEXT, name)]
    notes = (f"columns kept but not used: {', '.join(unknown)}",) if unknown else ()
    return replace(recordings, extra=table[unknown] if unknown else None, notes=notes)


class TableColumns:
    """Takes columns out of a table, each checked as it is taken; errors name file, row and column.

    Args:
        table: every column as text or numbers.
        source: where it was read, for errors.
    """

    def __init__(self, table: pd.DataFrame, source: Path | str) -> None:
        self.table, self.source = table, source

    def error(self, row: int, column: str, found: object, rule: str, cure: str = "") -> InputError:
        """What is wrong in a row.

        Args:
            row: from 0.
            column: its name.
            found: the value there.
            rule: what is allowed.
            cure: how to mend it.

        Returns:
            The error, to be raised.
        """
        return InputError(self.source, f"row {row + 2}, column {column}", found, rule, cure)

    def numbers(self, column: str, required: bool) -> Array:
        """A column of finite numbers.

        Args:
            column: its name.
            required: whether every row must hold one.

        Returns:
            (N,); NaN where it is empty.

        Raises:
            InputError: something else stands there.
        """
        values = self.table[column]
        if not pd.api.types.is_numeric_dtype(values) or pd.api.types.is_bool_dtype(values):
            parsed = pd.to_numeric(values, errors="coerce")
            wrong = np.flatnonzero(parsed.isna() & values.notna())
            if len(wrong):
                found = values.iloc[wrong[0]]
                cure = "Use a decimal point." if "," in str(found) else ""
                if str(found).strip() == column:
                    cure = "The header stands here a second time: remove this line."
                raise self.error(int(wrong[0]), column, str(found), "this must be a number", cure)
            values = parsed
        numbers = values.to_numpy(dtype=float)
        beyond = np.flatnonzero(np.abs(numbers) > LARGEST_NUMBER)
        if len(beyond):
            value = float(numbers[beyond[0]])
            rule = (
                "this must be a finite number" if np.isinf(value) else f"no recorded value reaches {LARGEST_NUMBER:g}"
            )
            raise self.error(int(beyond[0]), column, f"{value:g}", rule, "Leave it empty where there is no value.")
        if required and np.isnan(numbers).any():
            row = int(np.flatnonzero(np.isnan(numbers))[0])
            raise self.error(
                row, column, "nothing", "this value is required in every row", "Remove the row or fill it in."
            )
        return numbers

    def text(self, column: str) -> NDArray[np.str_]:
        """(N,) a column of words; "" where there is none."""
        if column not in self.table:
            return np.full(len(self.table), "")
        return self.table[column].fillna("").astype(str).to_numpy(dtype=str)

    def at_least(self, column: str, low: float, rule: str) -> Array | None:
        """An optional quantity with a least value.

        Args:
            column: its name.
            low: the least value.
            rule: what to say of one below.

        Returns:
            (N,), or None where there is no such column.

        Raises:
            InputError: a value lies below.
        """
        values = self.optional([column], 1.0, squeeze=True)
        if values is not None and (values < low).any():
            row = int(np.argmax(values < low))
            raise self.error(row, column, values[row], rule)
        return values

    def optional(self, columns: list[str], scale: float, squeeze: bool = False) -> Array | None:
        """Columns that come together.

        Args:
            columns: their names.
            scale: by which they are multiplied.
            squeeze: whether a single column comes as (N,).

        Returns:
            (N, k), or None where there are none of them.

        Raises:
            InputError: only some of them are there.
        """
        present = [name for name in columns if name in self.table]
        if not present:
            return None
        if len(present) < len(columns):
            missing = next(name for name in columns if name not in present)
            raise InputError(self.source, "line 1", f"no column {missing}", f"{', '.join(columns)} come together")
        values = np.column_stack([self.numbers(name, required=False) for name in columns]) * scale
        if np.isnan(values).all():
            return None
        return values[:, 0] if squeeze else values


class _Reader(TableColumns):
    """Takes the columns of the contract out of a table."""

    def motor_angles(self, n_motors: int | None) -> Array:
        found = {
            int(m[1]): m[0]
            for m in (re.fullmatch(r"q([1-9]\d*)_(?:rad|deg)", name) for name in self.table.columns)
            if m
        }
        count = n_motors if n_motors is not None else max(found, default=0)
        if count == 0:
            raise InputError(
                self.source,
                "line 1",
                "no column q1_rad",
                "motor angles stand in q1_rad, q2_rad, ... (or _deg)",
                nearest("q1_rad", self.table.columns),
            )
        for motor in range(1, count + 1):
            self._check_one_unit(f"q{motor}_rad", f"q{motor}_deg")
            if motor not in found:
                fewer = sorted(found) == list(range(1, motor))
                cure = f"The table has {motor - 1} motor angles: is this the right robot for the recordings?"
                raise InputError(
                    self.source,
                    "line 1",
                    f"no column q{motor}_rad",
                    f"the arm has motors q1 ... q{count}",
                    cure if fewer and motor > 1 else nearest(f"q{motor}_rad", self.table.columns),
                )
        if max(found) > count:
            raise InputError(
                self.source,
                "line 1",
                found[max(found)],
                f"the arm has {count} motors",
                "Is this the right robot for the recordings?",
            )
        columns = [self._angles(found[motor]) for motor in range(1, count + 1)]
        return np.column_stack(columns)

    def _check_one_unit(self, one: str, other: str) -> None:
        if one in self.table and other in self.table:
            raise InputError(
                self.source, "line 1", f"{one} and {other}", "one column per quantity", "Remove one of them."
            )

    def _angles(self, column: str) -> Array:
        values = self.numbers(column, required=True) * UNITS[column.rsplit("_", 1)[1]]
        beyond = np.flatnonzero(np.abs(values) > LARGEST_ANGLE_RAD)
        if len(beyond):
            row = int(beyond[0])
            cure = (
                f"Are these degrees? Then call the column {column.replace('_rad', '_deg')}."
                if column.endswith("_rad")
                else ""
            )
            raise self.error(
                row, column, self.table[column].iloc[row], "a joint angle lies within two turns (12.57 rad)", cure
            )
        return values

    def positions(self, measured: bool) -> Array:
        for axis in "xyz":
            self._check_one_unit(f"{axis}_mm", f"{axis}_m")
        for unit in ("mm", "m"):
            columns = [f"{axis}_{unit}" for axis in "xyz"]
            present = [name for name in columns if name in self.table]
            if len(present) == 3:
                return np.column_stack([self._lengths(name, measured) for name in columns])
            if present:
                missing = next(name for name in columns if name not in present)
                raise InputError(
                    self.source,
                    "line 1",
                    f"no column {missing}",
                    "x, y and z come together, in one unit",
                    nearest(missing, self.table.columns),
                )
        if measured:
            raise InputError(
                self.source,
                "line 1",
                "no column x_mm",
                "measured positions stand in x_mm, y_mm, z_mm (or _m)",
                nearest("x_mm", self.table.columns),
            )
        return np.full((len(self.table), 3), np.nan)

    def _lengths(self, column: str, required: bool) -> Array:
        values = self.numbers(column, required) * UNITS[column.rsplit("_", 1)[1]]
        beyond = np.flatnonzero(np.abs(values) > LARGEST_POSITION_M)
        if len(beyond):
            row = int(beyond[0])
            rule = f"a measured point lies within {LARGEST_POSITION_M / 1e3:g} km of its frame's origin"
            raise self.error(row, column, self.table[column].iloc[row], rule, "Subtract what all points share.")
        return values

    def orientation(self) -> Array | None:
        quaternion = self.optional(["qw", "qx", "qy", "qz"], 1.0)
        if quaternion is None:
            return None
        known = np.isfinite(quaternion).sum(axis=1)
        partly = np.flatnonzero((known > 0) & (known < 4))
        if len(partly):
            row = int(partly[0])
            raise self.error(row, "qw ... qz", f"{known[row]} of 4 values", "an orientation is whole or left out")
        norm = np.linalg.norm(quaternion, axis=1)
        wrong = np.flatnonzero(np.abs(norm - 1) > 0.01)
        if len(wrong):
            raise self.error(
                int(wrong[0]),
                "qw ... qz",
                quaternion[wrong[0]].tolist(),
                "a quaternion has length 1",
                f"Its length is {norm[wrong[0]]:.4g}.",
            )
        unit: Array = quaternion / norm[:, None]
        return unit

    def approach(self, count: int) -> Array | None:
        columns = [f"approach{j}" for j in range(1, count + 1)]
        approach = self.optional(columns, 1.0)
        if approach is None:
            return None
        wrong = np.argwhere(~np.isin(approach, [-1, 0, 1]) & ~np.isnan(approach))
        if len(wrong):
            row, column = wrong[0]
            raise self.error(int(row), columns[column], approach[row, column], "the side of approach is -1 or +1")
        return approach

    def sigma(self) -> Array | None:
        self._check_one_unit("sigma_mm", "sigma_x_mm")
        isotropic = self.optional(["sigma_mm"], UNITS["mm"])
        sigma = self.optional([f"sigma_{axis}_mm" for axis in "xyz"], UNITS["mm"])
        if sigma is None and isotropic is not None:
            sigma = np.repeat(isotropic, 3, axis=1)
        if sigma is not None and ((sigma < 0) | (sigma > LARGEST_POSITION_M)).any():
            row, axis = np.argwhere((sigma < 0) | (sigma > LARGEST_POSITION_M))[0]
            column = "sigma_mm" if "sigma_mm" in self.table else f"sigma_{'xyz'[axis]}_mm"
            rule = f"an uncertainty is not negative, and at most {LARGEST_POSITION_M / 1e3:g} km"
            raise self.error(int(row), column, sigma[row, axis] * 1e3, rule)
        return sigma

    def check_duplicates(self, recordings: Recordings) -> None:
        if "id" not in self.table:
            return
        named = np.flatnonzero(recordings.id != "")
        keys = self.table[[name for name in WORDS if name in self.table]].iloc[named]
        twice = keys.duplicated().to_numpy()
        if twice.any():
            row = int(named[twice.argmax()])
            group = keys.groupby(list(keys.columns), dropna=False).ngroup().to_numpy()
            first = int(named[np.argmax(group == group[twice.argmax()])])
            raise self.error(
                row,
                "id",
                recordings.id[row],
                f"an id stands once per run and target, row {first + 2} has it, too",
                "Number the rows, or name the repeats' runs differently.",
            )
