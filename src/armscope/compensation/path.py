"""What a user wants: a table of Cartesian points or of joint angles, with whatever context the model follows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from armscope.compensation.constants import REFUSED
from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.recordings import Recordings
from armscope.recordings.table import as_recordings
from armscope.recordings.textfile import read_text_table
from armscope.robot import Arm

if TYPE_CHECKING:
    import pandas as pd  # slow to import

Frame = Literal["base", "measurement"]


@dataclass(frozen=True, eq=False)
class WantedPath:
    """N rows of a path."""

    # the rows as recordings without measurements: angles (where given), context, runs, targets, orientations
    table: Recordings
    # (N, 3) wanted points, m, in `frame`; None for a joint path: where the nominal arm's tool would be
    points: Array | None
    has_angles: bool  # whether the table gives motor angles: the wanted posture, or the branch to solve on

    def __len__(self) -> int:
        return len(self.table)

    @property
    def context(self) -> dict[str, Array]:
        """(N,) columns of load, temperature and sides of approach, by name: what a command is for."""
        table = self.table
        sides = () if table.approach is None else table.approach.T
        told = {"payload_kg": table.payload, "temperature_c": table.temperature}
        told |= {f"approach{motor}": side for motor, side in enumerate(sides, start=1)}
        return {name: values for name, values in told.items() if values is not None}


def read_path(path: Path | str, arm: Arm) -> WantedPath:
    """Read a path table: x_mm, y_mm, z_mm (or _m), or q1_rad ... (or _deg), or both.

    With both, the points are wanted and the angles say on which branch (elbow up or down, wrist flipped or not).

    Raises:
        InputError: names file, row, column, the value found, the rule and the cure.
    """
    return as_path(read_text_table(Path(path), lambda header: _given(header, path)), path, arm)


def as_path(table: pd.DataFrame, source: Path | str, arm: Arm) -> WantedPath:
    """A table as a path; see `read_path`.

    Args:
        table: with points x_mm, y_mm, z_mm, or motor angles, and context.
        source: where it was read, for errors.
        arm: the nominal arm.

    Returns:
        The wanted path.

    Raises:
        InputError: as `read_path`.
    """
    has_angles, has_points = _given(table.columns, source)
    if not has_angles:
        table = table.assign(**{f"q{motor}_rad": 0.0 for motor in range(1, arm.n_motors + 1)})
    rows = as_recordings(table, source, arm.n_motors, measured=has_points)
    rows = replace(rows, number=np.full(len(rows), np.nan))  # a path is of now
    return WantedPath(rows, rows.positions if has_points else None, has_angles)


def _given(columns: Iterable[str], source: Path | str) -> tuple[bool, bool]:
    """Whether a table has motor angles, and whether it has points."""
    names = list(map(str, columns))
    has_angles = any(f"q{motor}_{unit}" in names for motor in range(1, 10) for unit in ("rad", "deg"))
    has_points = any(f"{axis}_{unit}" in names for axis in "xyz" for unit in ("mm", "m"))
    if not has_angles and not has_points:
        rule = "a path has x_mm, y_mm, z_mm (or _m), or q1_rad, q2_rad, ... (or _deg)"
        found = ", ".join(names[: REFUSED.columns_named])
        raise InputError(source, "line 1", found, rule, "The unit is part of the column's name.")
    return has_angles, has_points


def unit_doubt(points: Array, reach: float) -> str:
    """A hint that lengths may be in another unit than the column's name says; "" without doubt."""
    far = float(np.median(np.linalg.norm(points, axis=1)))
    if far > REFUSED.far * reach:
        return f"; the points lie {far:.4g} m away: are they millimetres in columns called _m?"
    if far < reach / REFUSED.near:
        return f"; the points lie {far * 1e3:.3g} mm from the base: are they metres in columns called _mm?"
    return ""
