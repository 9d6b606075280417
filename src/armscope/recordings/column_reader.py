"""The columns of a recordings table, each checked as it is taken out."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.recordings.columns import QUATERNION, UNITS, Names, column_named
from armscope.recordings.constants import POSSIBLE
from armscope.recordings.textfile import WORDS, cell_as_written

if TYPE_CHECKING:
    import pandas as pd  # slow to import, and many a table is refused by its first line


_UNITS = r"mm|cm|m|rad|deg|°|s|kg|n ?m|°?c|degc|rad/s|-"
_IN_GENERAL = "Correct it, or remove the row."
_CURES = (
    (rf"[\[(]?({_UNITS})?[\])]?", "If this line holds units, remove it: a column's name says its unit."),
    (
        r"[-+]?\d{1,3}(['’ \u00a0\u202f_]\d{3})+([.,]\d+)?|[-+]?\d{1,3}(,\d{3})+\.\d+",
        "Write it without signs between thousands, and with a decimal point.",
    ),
    (r".*\0.*", "These are zero bytes, as a copy that was broken off leaves: save the table again."),
    (r"\d+\s*[°d]\s*\d+\s*['’′m].*", "Write degrees, minutes and seconds as one decimal number."),
    (r"['’`].*", "Remove the apostrophe, by which spreadsheets mark text."),
    (r".*(?![0-9])\d.*", "Write digits 0 to 9 of the narrow kind."),
    (r".*,.*", "Use a decimal point."),
    (r"[-+]?[\d.]+d[-+]?\d+", "Write the exponent with E."),
    (
        r"\d{1,2}[. -][a-z]{3}\.?|\d{1,2}[.-]\d{1,2}[.-](\d\d){1,2}|[a-z]{3}-\d\d",
        "A spreadsheet took a number for a date: give the column the format of numbers, and save it as CSV again.",
    ),
    (r"(\d{4}-\d\d-\d\d[t ])?\d{1,2}:\d\d.*", "Write seconds, from any start: from the first row, say."),
    (r"#.*", "A formula of the spreadsheet failed: correct it, or remove the row."),
    (
        r"[-+]?[\d.]+(e[-+]?\d+)?\s*[^\W\d_]+|[-+]?[\d.]+\s*[°%]",
        "Write the number alone: a column's name says its unit.",
    ),
    (r"[−–].*", "Write the minus as a hyphen (-)."),
)
"""What a word looks like, in small letters, and what to do about it; the first that fits."""


def how_to_mend(word: str, column: str) -> str:
    """How to mend a word that stands in a column where a number must."""
    if word == column:
        return "The header stands here a second time: remove this line."
    return next((cure for looks, cure in _CURES if re.fullmatch(looks, word, re.IGNORECASE | re.DOTALL)), _IN_GENERAL)


def how_to_scale(numbers: Array) -> str:
    """What to do about four numbers (4,) that are no quaternion of length 1."""
    length = f"Its length is {np.linalg.norm(numbers):.4g}"
    if np.abs(numbers).max() > POSSIBLE.unscaled:
        return f"{length}. Are these angles? `armscope import` reads Euler angles: its mapping says so."
    return f"{length}: divide all four by it." if numbers.any() else f"{length}: leave all four empty."


class ColumnReader:
    """Takes the columns of the contract out of a table, each checked as it is taken."""

    def __init__(self, table: pd.DataFrame, source: Path | str) -> None:
        self.table, self.source = table, source
        self.names = Names([str(name) for name in table.columns], source)

    def _error(self, row: int, column: str, found: object, rule: str, cure: str = "") -> InputError:
        return InputError(self.source, f"line {row + 2}, column {column}", found, rule, cure)

    def _numbers(self, column: str, required: bool) -> Array:
        import pandas as pd

        values = self.table[column]
        if not pd.api.types.is_numeric_dtype(values) or pd.api.types.is_bool_dtype(values):
            words = values.where(values.isna(), values.astype(str))  # whole numbers of any length would not fit a float
            parsed = pd.to_numeric(words, errors="coerce")
            wrong = np.flatnonzero(parsed.isna() & values.notna())
            if len(wrong):
                found = values.iloc[wrong[0]]
                cure = how_to_mend(str(found).strip(), column)
                raise self._error(int(wrong[0]), column, str(found), "this must be a number", cure)
            values = parsed
        numbers = values.to_numpy(dtype=float)
        beyond = np.flatnonzero(np.abs(numbers) > POSSIBLE.number)
        if len(beyond):
            value = float(numbers[beyond[0]])
            rule = (
                "this must be a finite number" if np.isinf(value) else f"no recorded value reaches {POSSIBLE.number:g}"
            )
            raise self._error(int(beyond[0]), column, f"{value:g}", rule, "Leave it empty where there is no value.")
        self._check_range(column, numbers)
        if required and np.isnan(numbers).any():
            row = int(np.flatnonzero(np.isnan(numbers))[0])
            word = cell_as_written(self.source, row, list(self.table.columns).index(column))
            found = f"nothing, written {word!r}" if word else "nothing"
            raise self._error(
                row, column, found, "this value is required in every row", "Remove the row or fill it in."
            )
        return numbers

    def _check_range(self, column: str, numbers: Array) -> None:
        known = column_named(column)
        if (
            known is None
            or not known.rule
            or known.name.endswith(("_rad", "_deg", "_mm", "_m"))
            or known.name[0] == "q"
        ):
            return  # angles, points and orientations are checked where their cure is known
        beyond = np.flatnonzero((numbers < known.low) | (numbers > known.high))
        if len(beyond):
            rule = f"{known.rule}; allowed is {known.low:g} to {known.high:g} {known.unit}".rstrip()
            raise self._error(int(beyond[0]), column, float(numbers[beyond[0]]), rule)

    def text(self, column: str) -> NDArray[np.str_]:
        """(N,) words; empty where there is no such column."""
        if column not in self.table:
            return np.full(len(self.table), "")
        told = self.table[column].astype(object)  # text has no room in a column of numbers
        return told.where(told.notna(), "").astype(str).to_numpy(dtype=str)

    def optional(self, columns: list[str], scale: float, squeeze: bool = False) -> Array | None:
        """A quantity that may be left out.

        Args:
            columns: that come together.
            scale: SI units per unit of the columns.
            squeeze: whether one column comes back as (N,).

        Returns:
            (N, columns) with NaN where nothing was recorded; None where nothing ever was.

        Raises:
            InputError: some of the columns are there and others are not, or a value can't be.
        """
        present = [name for name in columns if name in self.table]
        if not present:
            return None
        if len(present) < len(columns):
            missing = next(name for name in columns if name not in present)
            raise InputError(self.source, "line 1", f"no column {missing}", f"{', '.join(columns)} come together")
        values = np.column_stack([self._numbers(name, required=False) for name in columns]) * scale
        if np.isnan(values).all():
            return None
        return values[:, 0] if squeeze else values

    def motor_angles(self, n_motors: int | None) -> Array:
        """(N, m) commanded angles, rad, of ``n_motors`` motors, or of as many as there are."""
        return np.column_stack([self._angles(name) for name in self.names.motor_angles(n_motors)])

    def _angles(self, column: str) -> Array:
        values = self._numbers(column, required=True) * UNITS[column.rsplit("_", 1)[1]]
        beyond = np.flatnonzero(np.abs(values) > POSSIBLE.angle_rad)
        if len(beyond):
            row = int(beyond[0])
            cure = (
                f"Are these degrees? Then call the column {column.replace('_rad', '_deg')}."
                if column.endswith("_rad")
                else ""
            )
            raise self._error(
                row, column, self.table[column].iloc[row], "a joint angle lies within two turns (12.57 rad)", cure
            )
        return values

    def positions(self, measured: bool) -> Array:
        """(N, 3) measured points, m; where they need not be ``measured``, NaN without."""
        columns = self.names.positions(measured)
        if not columns:
            return np.full((len(self.table), 3), np.nan)
        return np.column_stack([self._lengths(name, measured) for name in columns])

    def _lengths(self, column: str, required: bool) -> Array:
        values = self._numbers(column, required) * UNITS[column.rsplit("_", 1)[1]]
        beyond = np.flatnonzero(np.abs(values) > POSSIBLE.position_m)
        if len(beyond):
            row = int(beyond[0])
            rule = f"a measured point lies within {POSSIBLE.position_m / 1e3:g} km of its frame's origin"
            raise self._error(row, column, self.table[column].iloc[row], rule, "Subtract what all points share.")
        return values

    def orientation(self) -> Array | None:
        """(N, 4) unit quaternions (w, x, y, z), or None."""
        quaternion = self.optional(QUATERNION, 1.0)
        if quaternion is None:
            return None
        known = np.isfinite(quaternion).sum(axis=1)
        partly = np.flatnonzero((known > 0) & (known < 4))
        if len(partly):
            row = int(partly[0])
            raise self._error(row, "qw ... qz", f"{known[row]} of 4 values", "an orientation is whole or left out")
        norm = np.linalg.norm(quaternion, axis=1)
        wrong = np.flatnonzero(np.abs(norm - 1) > POSSIBLE.off_unit)
        if len(wrong):
            raise self._error(
                int(wrong[0]),
                "qw ... qz",
                quaternion[wrong[0]].tolist(),
                "a quaternion has length 1",
                how_to_scale(quaternion[wrong[0]]),
            )
        unit: Array = quaternion / norm[:, None]
        return unit

    def approach(self, count: int) -> Array | None:
        """(N, m) -1, 0 or +1, or None."""
        columns = [f"approach{j}" for j in range(1, count + 1)]
        approach = self.optional(columns, 1.0)
        if approach is None:
            return None
        wrong = np.argwhere(~np.isin(approach, [-1, 0, 1]) & ~np.isnan(approach))
        if len(wrong):
            row, column = wrong[0]
            raise self._error(int(row), columns[column], approach[row, column], "the side of approach is -1 or +1")
        return approach

    def sigma(self) -> Array | None:
        """(N, 3) stated uncertainty per axis, m, or None."""
        self.names.check_one_unit("sigma_mm", "sigma_x_mm")
        isotropic = self.optional(["sigma_mm"], UNITS["mm"])
        sigma = self.optional([f"sigma_{axis}_mm" for axis in "xyz"], UNITS["mm"])
        if sigma is None and isotropic is not None:
            sigma = np.repeat(isotropic, 3, axis=1)
        impossible = (
            None if sigma is None else ((sigma < POSSIBLE.least_sigma_m) & (sigma != 0)) | (sigma > POSSIBLE.position_m)
        )
        if sigma is not None and impossible is not None and impossible.any():
            row, axis = np.argwhere(impossible)[0]
            column = "sigma_mm" if "sigma_mm" in self.table else f"sigma_{'xyz'[axis]}_mm"
            least, most = f"{POSSIBLE.least_sigma_m * 1e3:g} mm (an atom)", f"{POSSIBLE.position_m / 1e3:g} km"
            rule = f"an uncertainty is not negative: 0 where it is not known, else {least} to {most}"
            raise self._error(int(row), column, sigma[row, axis] * 1e3, rule)
        return sigma

    def check_duplicates(self, ids: NDArray[np.str_]) -> None:
        """Refuse an id that stands twice in a run and target."""
        if "id" not in self.table:
            return
        named = np.flatnonzero(ids != "")
        keys = self.table[[name for name in WORDS if name in self.table]].iloc[named]
        twice = keys.duplicated().to_numpy()
        if twice.any():
            row = int(named[twice.argmax()])
            group = keys.groupby(list(keys.columns), dropna=False).ngroup().to_numpy()
            first = int(named[np.argmax(group == group[twice.argmax()])])
            raise self._error(
                row,
                "id",
                ids[row],
                f"an id stands once per run and target, line {first + 2} has it, too",
                "Number the rows, or name the repeats' runs differently.",
            )
