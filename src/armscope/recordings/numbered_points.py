"""Names of points that are no reflectors' names: numbers that run with the rows."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.core.types import Array

FEWEST_NAMES = 10
"""Names from which they may number the rows: nobody puts so many reflectors on a tool."""
OF_THE_ROWS = 0.5
"""Names per row from which they number rows: fewer than two rows each leave nothing but tool offsets to fit."""


def number_the_rows(names: Sequence[str] | Array) -> bool:
    """Whether what should name the reflector of each row names the row."""
    different = len(set(names))
    return different >= FEWEST_NAMES and different >= OF_THE_ROWS * len(names)


def told_of_names(names: Sequence[str] | Array) -> str:
    """What is found in such a column."""
    return f"{len(set(names))} different names in {len(names)} rows"


CURE = (
    "Each gets a tool offset of its own - is it the point's number? Then leave the column out of the table, or "
    "`target` out of mapping.yaml."
)
