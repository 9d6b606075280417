"""The columns of the recordings table from those of a raw file: units, orientations, time stamps, labels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
import pandas as pd

from armscope.core.types import Array
from armscope.recordings.columns import AXES_MM, QUATERNION, UNITS
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.importing.checked_values import check_lengths, refuse_values, required, scalar, whole
from armscope.recordings.importing.constants import DRAFT
from armscope.recordings.importing.formats import Column, Time
from armscope.recordings.importing.mapping import Columns, Label, Orientation, Reflectors, RunColumn
from armscope.recordings.importing.pieces import Piece
from armscope.recordings.orientations import (
    NotARotation,
    from_euler,
    from_matrices,
    from_quaternions,
    from_rotation_vectors,
)

TIME_UNITS = {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}


class Clock:
    """Seconds from a column of times; remembers each run's first time stamp."""

    def __init__(self) -> None:
        self.start: dict[str, pd.Timestamp] = {}

    def time(self, piece: Piece, group: Time, runs: Sequence[str]) -> Array:
        """Seconds of a piece's rows.

        Args:
            piece: the rows.
            group: where their times stand, and in what unit or format.
            runs: (N,) of which run each row is; time stamps count from the run's first one.

        Returns:
            (N,) s.

        Raises:
            InputError: what stands there is no time of that format.
        """
        if group.unit is not None:
            return piece.numbers(group.column) * TIME_UNITS[group.unit]
        words = pd.Series(piece.words(group.column), dtype=object)
        stamps = self._stamps(piece, group, words)
        of_run, seconds = np.array(runs), np.full(len(piece), np.nan)
        for run in dict.fromkeys(runs):
            own = stamps[of_run == run]
            if run not in self.start and own.notna().any():
                self.start[run] = own[own.first_valid_index()]
            if run in self.start:
                seconds[of_run == run] = (own - self.start[run]).dt.total_seconds()
        return seconds

    @staticmethod
    def _stamps(piece: Piece, group: Time, words: pd.Series) -> pd.Series:
        """Time stamps, one zone for all; NaT where there is none."""
        stamps = pd.to_datetime(words, format=group.format, errors="coerce", utc=True)
        wrong = np.flatnonzero(stamps.isna() & (words != ""))
        if len(wrong):
            rule, cure = f"a time stamp is written as {group.format}", "Correct `format`, or leave `time` out."
            raise piece.error(int(wrong[0]), (group.column,), words[wrong[0]], rule, cure)
        return stamps


def runs_of_rows(piece: Piece, group: RunColumn | None, own: str) -> list[str]:
    """Of which run each row of a piece is.

    Args:
        piece: N rows.
        group: the column that says so, if there is one.
        own: the run's name where there is none.

    Returns:
        N names.

    Raises:
        InputError: a row has no name there.
    """
    if group is None:
        return [own] * len(piece)
    runs = piece.words(group.column)
    if "" in runs:
        cure = "Write the run there, or leave such rows out: `rows: [{drop_missing: [...]}]`."
        raise piece.error(runs.index(""), (group.column,), "nothing", "every row is of a run", cure)
    return runs


class Converter:
    """The columns of the recordings table from those of a run; remembers its ids."""

    def __init__(self, columns: Columns, run: str) -> None:
        self.columns, self.run, self.clock = columns, run, Clock()
        self.ids: set[tuple[str, str, str]] = set()

    def table(self, piece: Piece) -> pd.DataFrame:
        """A piece in the columns of the recordings table that the run has."""
        columns = self.columns
        assert columns.angles is not None
        runs = runs_of_rows(piece, columns.run, self.run)
        table: dict[str, object] = {"id": self._ids(piece), "run": runs}
        if columns.target is not None:
            table["target"] = _label(piece, columns.target)
        if columns.id is not None and columns.id.column is not None:
            targets = cast(list[str], table.get("target", [""] * len(piece)))
            self._check_ids(piece, list(zip(cast(list[str], table["id"]), targets, runs, strict=True)))
        table |= as_columns([f"q{j + 1}_rad" for j in range(len(columns.angles.columns))], self._angles(piece))
        table |= self._context(piece, runs)
        if columns.reflectors is not None:
            return _by_reflector(piece, columns.reflectors, pd.DataFrame(table))
        return pd.DataFrame(table | self._measured(piece))

    def _ids(self, piece: Piece) -> list[str]:
        numbers = piece.rows.numbers_of_rows
        identity = self.columns.id
        if identity is not None and identity.row_of is not None:
            numbers = piece.beside[identity.row_of].row_numbers(numbers)
        elif identity is not None and identity.column is not None:
            return piece.words(identity.column)
        return list(numbers.astype(str).tolist())

    def _check_ids(self, piece: Piece, keys: list[tuple[str, str, str]]) -> None:
        assert self.columns.id is not None
        assert self.columns.id.column is not None
        for row, key in enumerate(keys):
            if key in self.ids:
                cure = "Keep one with `rows: [{first_of: [...]}]`, or leave `id` out to number the source's rows."
                rule = "an id stands once per run and target"
                raise piece.error(row, (self.columns.id.column,), key[0], rule, cure)
            self.ids.add(key)

    def _angles(self, piece: Piece) -> Array:
        group = self.columns.angles
        assert group is not None
        angles = required(piece, group.columns) * UNITS[group.unit]
        beyond = np.argwhere(np.abs(angles) > POSSIBLE.angle_rad)
        if len(beyond):
            row, motor = beyond[0]
            cure = "Are these degrees? Then say unit: deg." if group.unit == "rad" else ""
            found = f"{angles[row, motor] / UNITS[group.unit]:g} {group.unit}"
            raise piece.error(int(row), (group.columns[motor],), found, "a joint angle lies within two turns", cure)
        return angles

    def _measured(self, piece: Piece) -> dict[str, Array]:
        columns = self.columns
        if columns.pose is not None:
            matrix = required(piece, columns.pose.matrix).reshape(len(piece), -1, 4)
            self._check_last_row(piece, matrix)
            position = matrix[:, :3, 3] * UNITS[columns.pose.unit]
            orientation: Array | None = self._rotation(
                piece, columns.pose.matrix, lambda: from_matrices(matrix[:, :3, :3])
            )
            check_lengths(piece, tuple(columns.pose.matrix[k] for k in (3, 7, 11)), position, columns.pose.unit)
        else:
            assert columns.position is not None
            position = required(piece, columns.position.columns) * UNITS[columns.position.unit]
            check_lengths(piece, columns.position.columns, position, columns.position.unit)
            orientation = None if columns.orientation is None else self._orientation(piece, columns.orientation)
        measured = as_columns(AXES_MM, position * 1e3)
        return measured if orientation is None else measured | as_columns(QUATERNION, orientation)

    def _check_last_row(self, piece: Piece, matrix: Array) -> None:
        assert self.columns.pose is not None
        if matrix.shape[1] == 4:
            wrong = np.flatnonzero(np.abs(matrix[:, 3] - [0, 0, 0, 1]).max(axis=1) > DRAFT.last_row)
            if len(wrong):
                cure = "Is the matrix written column by column? Then name its columns in the order of the rows."
                found = matrix[wrong[0], 3].tolist()
                rule = "the last row of a homogeneous matrix is 0 0 0 1"
                raise piece.error(int(wrong[0]), self.columns.pose.matrix[12:], found, rule, cure)

    def _orientation(self, piece: Piece, group: Orientation) -> Array:
        if group.quaternion is not None:
            assert group.order is not None
            order = group.order
            values = whole(piece, group.quaternion, "an orientation")
            return self._rotation(piece, group.quaternion, lambda: from_quaternions(values, order))
        if (columns := group.euler or group.rotation_vector) is not None:
            assert group.unit is not None
            angles = whole(piece, columns, "an orientation")
            cure = "Are these degrees? Then say unit: deg." if group.unit == "rad" else ""
            far = np.abs(angles * UNITS[group.unit]) > POSSIBLE.angle_rad
            what = "an Euler angle" if group.euler is not None else "a part of a rotation vector"
            refuse_values(piece, columns, angles, far, f"{what} in {group.unit} lies within two turns", cure)
            turned = angles * UNITS[group.unit]
            return from_rotation_vectors(turned) if group.sequence is None else from_euler(turned, group.sequence)
        assert group.matrix is not None
        matrices = whole(piece, group.matrix, "an orientation").reshape(-1, 3, 3)
        return self._rotation(piece, group.matrix, lambda: from_matrices(matrices))

    def _rotation(self, piece: Piece, columns: tuple[Column, ...], convert: object) -> Array:
        assert callable(convert)
        try:
            return cast(Array, convert())
        except NotARotation as error:
            raise piece.error(error.row, columns, error.found, error.rule, error.cure) from error

    def _context(self, piece: Piece, runs: Sequence[str]) -> dict[str, Array]:
        columns = self.columns
        context: dict[str, Array] = {}
        if columns.torque is not None:
            context |= as_columns(
                [f"tau{j + 1}_nm" for j in range(len(columns.torque.columns))], piece.stack(columns.torque.columns)
            )
        if columns.speed is not None:
            speeds = piece.stack(columns.speed.columns) * UNITS[columns.speed.unit.removesuffix("/s")]
            context |= as_columns([f"dq{j + 1}_rad_s" for j in range(speeds.shape[1])], speeds)
        if columns.approach is not None:
            sides = piece.stack(columns.approach.columns)
            wrong = ~np.isin(sides, [-1, 0, 1]) & ~np.isnan(sides)
            refuse_values(piece, columns.approach.columns, sides, wrong, "the side of approach is -1 or +1")
            context |= as_columns([f"approach{j + 1}" for j in range(sides.shape[1])], sides)
        if columns.payload is not None:
            context["payload_kg"] = scalar(piece, columns.payload, 0.0, "a payload is not negative")
        if columns.time is not None:
            context["time_s"] = self.clock.time(piece, columns.time, runs)
        if columns.temperature is not None:
            rule = "no temperature is below absolute zero"
            context["temperature_c"] = scalar(piece, columns.temperature, POSSIBLE.coldest_c, rule)
        if columns.sigma is not None:
            sigma = piece.stack(columns.sigma.columns) * UNITS[columns.sigma.unit] * 1e3
            rule = "an uncertainty is not negative"
            refuse_values(piece, columns.sigma.columns, sigma, (sigma < 0) | (sigma > POSSIBLE.position_m * 1e3), rule)
            context |= as_columns([f"sigma_{axis}_mm" for axis in "xyz"], sigma)
        return context


def _by_reflector(piece: Piece, reflectors: Reflectors, table: pd.DataFrame) -> pd.DataFrame:
    """A row for each reflector that was seen, those of one raw row together; ``table`` is what else is known of
    rows. Raises InputError: a point is there in part, or too far to be one, or a row shows no reflector."""
    seen = []
    for name, columns in reflectors.targets.items():
        points = whole(piece, columns, "a point") * UNITS[reflectors.unit]
        check_lengths(piece, columns, points, reflectors.unit)
        rows = np.flatnonzero(np.isfinite(points[:, 0]))
        seen.append(table.iloc[rows].assign(target=name, **as_columns(AXES_MM, points[rows] * 1e3)))
    rows_of_all = pd.concat(seen).sort_index(kind="stable")
    unseen = np.setdiff1d(np.arange(len(piece)), rows_of_all.index)
    if len(unseen):
        columns = next(iter(reflectors.targets.values()))
        cure = f"Leave such rows out with `rows: [{{drop_missing: [{columns[0]}]}}]`."
        raise piece.error(int(unseen[0]), columns, "nothing", "a row shows at least one reflector", cure)
    return rows_of_all.reset_index(drop=True)


def as_columns(names: list[str], values: Array) -> dict[str, Array]:
    """Columns of a table by their names."""
    return {name: values[:, column] for column, name in enumerate(names)}


def _label(piece: Piece, group: Label) -> list[str]:
    if group.column is not None:
        return piece.words(group.column)
    if group.cycle is not None:
        return [group.cycle[(row - 1) % len(group.cycle)] for row in piece.rows.numbers_of_rows]
    return [cast(str, group.constant)] * len(piece)
