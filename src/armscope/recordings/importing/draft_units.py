"""The unit of a draft's columns: as the table states it, else guessed; one stated that is not known is left open."""

from __future__ import annotations

from collections.abc import Sequence

from armscope.core.inputs import InputError
from armscope.recordings.importing.first_table import ForeignTable, below_name, printable
from armscope.recordings.importing.stated_units import stated_unit, unknown_unit

FILL_IN = "FILL_IN"  # What no mapping takes for a unit: `armscope import` asks for one


def unit_of(table: ForeignTable, columns: Sequence[int], units: dict[str, str]) -> tuple[str | None, str]:
    """The unit that a table states for the columns of one quantity, and how it is known.

    Args:
        table: the table.
        columns: those of the quantity.
        units: what mappings call each word for one.

    Returns:
        The unit and the words of a comment; `FILL_IN` where the table states one that is not known, None and no word
        where it states none.

    Raises:
        InputError: the columns state several units.
    """
    cells = [(table.names[column] if table.header else "", below_name(table, column)) for column in columns]
    if unknown := next((word for cell in cells if (word := unknown_unit(*cell, units))), ""):
        known = ", ".join(dict.fromkeys(units.values()))
        return FILL_IN, f"to fill in: the table says {printable(unknown)!r}, which is none of {known}"
    stated = list(dict.fromkeys(unit for cell in cells if (unit := stated_unit(*cell, units))))
    if len(stated) > 1:
        names = ", ".join(table.names[column] for column in columns)
        rule = f"the columns of one quantity have one unit, these have {' and '.join(stated)}"
        raise InputError(table.file, f"line {table.skip + 1}", names, rule, "Convert the columns of one of them.")
    return (stated[0], "stated by the table") if stated else (None, "")


def filled_in(text: str) -> str:
    """A draft with any known unit where one is left open, to see whether all else of it holds."""
    kinds = {"position": "mm", "reflectors": "mm", "speed": "rad/s", "speeds": "rad/s", "time": "s"}
    lines = []
    for line in text.split("\n"):
        unit = kinds.get(line.strip().partition(":")[0], "rad")
        lines.append(line.replace(f"unit: {FILL_IN}", f"unit: {unit}").replace(f"scale: {FILL_IN}", "scale: 1"))
    return "\n".join(lines)
