"""Names of points that are no reflectors' names: numbers that run with the rows."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.core.types import Array
from armscope.recordings.constants import READING


def number_the_rows(names: Sequence[str] | Array) -> bool:
    """Whether what should name the reflector of each row names the row."""
    different = len(set(names))
    return different >= READING.fewest_names and different >= READING.names_per_row * len(names)


def told_of_names(names: Sequence[str] | Array) -> str:
    """What is found in such a column."""
    return f"{len(set(names))} different names in {len(names)} rows"


CURE = (
    "Each gets a tool offset of its own - is it the point's number? Then leave the column out of the table, or "
    "`target` out of mapping.yaml."
)
