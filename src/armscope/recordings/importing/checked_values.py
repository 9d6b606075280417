"""Numbers of a raw file, refused by file, row and column where they can't be what the mapping says."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array
from armscope.recordings.columns import UNITS
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.importing.formats import Column
from armscope.recordings.importing.mapping import Scalar
from armscope.recordings.importing.pieces import Piece


def required(piece: Piece, columns: tuple[Column, ...]) -> Array:
    """(N, columns) numbers that every row must have. Raises InputError: a row has none."""
    values = piece.stack(columns)
    missing = np.argwhere(np.isnan(values))
    if len(missing):
        row, column = missing[0]
        cure = f"Leave such rows out with `rows: [{{drop_missing: [{columns[column]}]}}]`."
        raise piece.error(int(row), (columns[column],), "nothing", "this value is required in every row", cure)
    return values


def refuse_values(
    piece: Piece, columns: tuple[Column, ...], values: Array, wrong: NDArray[np.bool_], rule: str, cure: str = ""
) -> None:
    """Let no value pass that can't be.

    Args:
        piece: N rows of a raw file.
        columns: where the values stand.
        values: (N, columns) as they stand there.
        wrong: (N, columns) those that can't be.
        rule: what is allowed.
        cure: how to mend it.

    Raises:
        InputError: names the first wrong one.
    """
    if wrong.any():
        row, column = np.argwhere(wrong)[0]
        raise piece.error(int(row), (columns[column],), f"{values[row, column]:g}", rule, cure)


def whole(piece: Piece, columns: tuple[Column, ...], what: str) -> Array:
    """The parts of something that is there as a whole or not at all.

    Args:
        piece: N rows of a raw file.
        columns: where the parts stand.
        what: "a point", "an orientation".

    Returns:
        (N, columns), NaN in all columns where there is none.

    Raises:
        InputError: some parts are there and others are not.
    """
    values = piece.stack(columns)
    missing = np.isnan(values)
    partly = np.flatnonzero(missing.any(axis=1) & ~missing.all(axis=1))
    if len(partly):
        which = tuple(columns[k] for k in np.flatnonzero(missing[partly[0]]))
        raise piece.error(int(partly[0]), which, "nothing", f"{what} is there as a whole or not at all")
    return values


def scalar(piece: Piece, group: Scalar, low: float, rule: str) -> Array:
    """A quantity that is a column, or the same in every row.

    Args:
        piece: N rows.
        group: where it comes from.
        low: least value that is allowed.
        rule: why, for the error.

    Returns:
        (N,) numbers, NaN for none.

    Raises:
        InputError: a value below ``low``.
    """
    constant = group.constant
    values = np.full(len(piece), constant, dtype=float) if group.column is None else piece.numbers(group.column)
    refuse_values(piece, (group.column or "constant",), values[:, None], values[:, None] < low, rule)
    return values


def check_lengths(piece: Piece, columns: tuple[Column, ...], lengths: Array, unit: str) -> None:
    """Refuse points that no instrument sees.

    Args:
        piece: N rows of a raw file.
        columns: where the points stand, along x, y, z.
        lengths: (N, 3), m.
        unit: in which they stand there.

    Raises:
        InputError: a point lies too far from its frame's origin.
    """
    rule = f"a measured point lies within {POSSIBLE.position_m / 1e3:g} km of its frame's origin"
    cure = f"Is its unit really {unit}?"
    refuse_values(piece, columns, lengths / UNITS[unit], np.abs(lengths) > POSSIBLE.position_m, rule, cure)
