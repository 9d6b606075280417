"""Which column of a foreign table holds time stamps: by its name, and because they can be read and rise.

Without a time nothing that drifts can be told from other errors, and an instrument's export has stamps as a rule.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection

import pandas as pd

from armscope.recordings.importing.draft_motors import words_of
from armscope.recordings.importing.first_table import ForeignTable, quoted

WORDS = {
    "time", "timestamp", "datetime", "date", "clock", "zeit", "zeitstempel", "uhrzeit", "datum", "heure", "horodatage",
    "hora", "fecha", "ora", "data",
}  # fmt: skip
"""Of which one at least stands in the column's name."""
DAYS = ("%Y-%m-%d", "%d.%m.%Y", "%d.%m.%y", "%Y/%m/%d", "%d/%m/%Y", "%m/%d/%Y", "%d-%m-%Y", "%Y%m%d")
CLOCKS = ("%H:%M:%S", "%H:%M:%S.%f", "%H:%M:%S,%f", "%H:%M", "%I:%M:%S %p", "%H:%M:%S%z", "%H:%M:%S.%f%z")
FORMATS = (*("".join(parts) for parts in itertools.product(DAYS, (" ", "T", ", "), CLOCKS)), *CLOCKS, *DAYS)
"""How a stamp is written: a day and a clock's time, or one of these. Where a day and a month look alike, the day is
first."""


def time_stamps(table: ForeignTable, taken: Collection[int]) -> str:
    """The mapping's line of a column of time stamps; "" where none reads as stamps that rise.

    Returns:
        The line, with a comment that it is a guess.
    """
    for column, name in enumerate(table.names):
        if column not in taken and WORDS & set(words_of(name)):
            written = _format_of([row[column].strip() for row in table.cells])
            if written:
                why = "guessed by name: time stamps that rise, seconds from the first one on"
                return f"  time: {{column: {quoted(name)}, format: {quoted(written)}}}   # {why}"
    return ""


def _format_of(cells: list[str]) -> str:
    """The format in which all cells that are not empty are stamps that rise; "" for none."""
    filled = pd.Series([cell for cell in cells if cell], dtype=object)
    if len(filled) < 2 or len(filled) < len(cells) / 2:
        return ""
    for written in FORMATS:
        if pd.isna(pd.to_datetime(filled.iloc[:1], format=written, errors="coerce", utc=True)).any():
            continue
        stamps = pd.to_datetime(filled, format=written, errors="coerce", utc=True)
        if stamps.notna().all() and stamps.is_monotonic_increasing and stamps.iloc[-1] > stamps.iloc[0]:
            return written
    return ""
