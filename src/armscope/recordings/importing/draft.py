"""A draft of mapping.yaml from a foreign table: delimiter, decimal sign, columns and units, each guess labelled."""

from __future__ import annotations

import itertools
import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

from armscope.core.inputs import InputError, validate
from armscope.core.types import Array
from armscope.recordings.importing.constants import DRAFT, LIMITS
from armscope.recordings.importing.draft_columns import (
    BESIDE,
    FILL_IN,
    JOINT,
    filled_in,
    in_a_row,
    largest_of,
    motor_columns,
    numbered_columns,
    points_of,
    unit_of,
    ur_joints,
    words_of,
)
from armscope.recordings.importing.draft_orientations import orientation_lines
from armscope.recordings.importing.first_table import ForeignTable, column_list, first_table, printable, quoted
from armscope.recordings.importing.formats import TextFormat
from armscope.recordings.importing.mapping import Mapping
from armscope.recordings.importing.stated_units import ANGLE_UNITS, LENGTH_UNITS, SPEED_UNITS, TORQUE_UNITS
from armscope.recordings.numbered_points import number_the_rows
from armscope.recordings.other_formats import by_hand

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


def _time_stamps(table: ForeignTable, taken: Collection[int]) -> str:
    """The mapping's line of a column of time stamps; "" where none reads as stamps that rise."""
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


RUNS = r"(run|session|series|campaign|lauf|serie|messreihe|sitzung)([\s_]?(id|name|no|nr|number))?"
LOADS = "payload|load|last|nutzlast|traglast|charge|charge utile|carga|carga útil|carga util|carico|负载"
SCALARS = {
    "payload": rf"({LOADS})([\s_.\[(]*kg)?[\])]?",
    "temperature": r"(temp|temperatur|temperature|température|temperatura)([\s_.\[(]*(°?c|degc))?[\])]?",
}


def draft_mapping(path: Path | str) -> str:
    """The text of a mapping.yaml that reads this file, with a comment on every guess. Raises InputError: it is no
    text table, or no columns look like motor angles and points (or a motion's torques)."""
    path = Path(path)
    table = first_table(path)
    columns = list(_guess_columns(path, table))
    angles = motor_columns(table)
    reflectors = points_of(table, taken=angles)
    needed = [*angles, *(reflectors[0] if len(reflectors) == 1 else [])]
    unused = [name for name in table.names if table.header and not any(quoted(name) in line for line in columns)]
    needed += _closed_by_words(table, [table.names.index(name) for name in unused])
    lines = [*format_lines(table), "columns:", *columns, *row_lines(table, needed)]
    if unused:
        shown = ", ".join(quoted(printable(name)) for name in unused[: LIMITS.unused_named])
        lines += [f"# not used: {shown}{', ...' * (len(unused) > LIMITS.unused_named)}"]
    text = "\n".join([HEAD.format(printable(path.name), "recordings.csv"), *lines, ""])
    validate(Mapping, yaml.safe_load(filled_in(text)), path)
    return text


OTHER_ENCODING = "The text is not UTF-8: if names look wrong, save it as `CSV UTF-8`. "
HEAD = (
    "# A draft for {}: read every guess, mend it where it is wrong, then\n"
    "# armscope import TABLE --mapping mapping.yaml -o {}"
)


def _closed_by_words(table: ForeignTable, columns: Sequence[int]) -> list[int]:
    """Those of some columns that hold numbers but in closing lines: a line of means has numbers like any row."""
    known = np.isfinite(table.values)
    lacking = len(known) - known.sum(axis=0)
    few = min(DRAFT.most_closing, len(known) // 2)
    return [column for column in columns if 0 < lacking[column] <= few and not known[-lacking[column] :, column].any()]


def format_lines(table: ForeignTable) -> Iterator[str]:
    """How the table is cut, as a mapping says it."""
    cut = table.cut
    parts = [f"kind: workbook, sheet: {quoted(cut.sheet)}"] if cut.sheet else [f'delimiter: "{cut.delimiter}"']
    parts += [f'decimal: "{cut.decimal}"'] if not cut.sheet or cut.decimal != "." else []
    parts += [f'thousands: "{cut.thousands}"'] if cut.thousands else []
    parts += ["header: false"] if not table.header else []
    parts += [f"skip_lines: {table.skip}"] if table.skip else []
    parts += ["below_header: 1"] if table.units else []
    parts += [f"encoding: {cut.encoding}"] if cut.encoding not in ("", "utf-8-sig") else []
    of_numbers = np.flatnonzero(2 * np.isfinite(table.values).sum(axis=0) > len(table.values))
    words = table.words(of_numbers.tolist())
    words = [word for word in words if word.isprintable() and word not in TextFormat().missing]
    listed = ", ".join(quoted(word) for word in (*TextFormat().missing, *words[: LIMITS.unused_named]))
    parts += [f"missing: [{listed}]"] if words else []
    why = f"; {', '.join(quoted(printable(word)) for word in words[: LIMITS.unused_named])}: no value" if words else ""
    how = "most lines are cut alike by it"
    if cut.sheet:
        others = ", ".join(quoted(printable(name)) for name in cut.other_sheets[: LIMITS.unused_named])
        how = "the first sheet with a table" + (f"; others: {others}" if others else "")
    yield f"format: {{{', '.join(parts)}}}   # guessed: {how}{why}"


def row_lines(table: ForeignTable, needed: Sequence[int]) -> Iterator[str]:
    """Rows without angles or points are left out, and which is said."""
    lacking = np.isnan(table.values[:, needed])
    if lacking.any():
        listed = column_list(table, [needed[column] for column in np.unique(np.argwhere(lacking)[:, 1]).tolist()])
        yield "rows:"
        yield f"- drop_missing: {listed}   # guessed: {lacking.any(axis=1).sum()} rows have none there"


def _guess_columns(path: Path, table: ForeignTable) -> Iterator[str]:
    angles = motor_columns(table)
    reflectors = points_of(table, taken=angles)
    points = [column for point in reflectors for column in point]
    for what, found in (("the motor angles", angles), ("measured x, y, z", points)):
        if not found:
            seen, line = ", ".join(table.names[: LIMITS.unused_named]), f"line {table.skip + 1}"
            rule = f"no columns look like {what}, nor like time, angles and torques or currents of a motion"
            cure = by_hand(table.names, str(path))
            cure = OTHER_ENCODING + cure if table.cut.encoding == "latin-1" else cure
            raise InputError(path, line, seen, rule, cure)
    largest = largest_of(table.values[:, angles])
    stated, why = unit_of(table, angles, ANGLE_UNITS)
    unit = stated or ("rad" if largest <= DRAFT.radians_up_to else "deg")
    why = why or f"guessed: none is beyond {largest:.4g}"
    why = "guessed: Grad is German for degrees" if "grad" in words_of(table.names[angles[0]]) else why
    unnumbered = table.header and not any(JOINT.fullmatch(table.names[column].strip()) for column in angles[:1])
    of_ur = angles == ur_joints(table)
    why += "; the joints of a UR, from the base on" if of_ur else ""
    why += "; no numbers in the names: in the table's order" if unnumbered and not of_ur else ""
    yield f"  angles: {{columns: {column_list(table, angles)}, unit: {unit}}}   # {why}; columns by likeness of names"
    largest = largest_of(table.values[:, points])
    stated, why = unit_of(table, points, LENGTH_UNITS)
    unit = stated or ("m" if largest <= DRAFT.metres_up_to else "mm")
    why = why or f"guessed: none is beyond {largest:.4g}"
    why += "; columns by likeness of names"
    if len(reflectors) == 1:
        yield f"  position: {{columns: {column_list(table, points)}, unit: {unit}}}   # {why}"
    else:
        targets = ", ".join(f"p{n}: {column_list(table, point)}" for n, point in enumerate(reflectors, 1))
        why += "; guessed: reflectors of one tool, all seen at each pose. Else say position: {columns: [x, y, z]}"
        yield f"  reflectors: {{targets: {{{targets}}}, unit: {unit}}}   # {why}"
    yield from _further(table, len(angles), {*angles, *points}, of_one_point=len(reflectors) == 1)


def _further(table: ForeignTable, n_motors: int, taken: set[int], of_one_point: bool) -> Iterator[str]:
    """Context by names alone; several reflectors have names already, and no orientation each."""
    if not table.header:
        return
    for group, columns in _per_motor(table, n_motors, taken).items():
        yield _of_motors(table, group, columns)
    small = {name.strip().lower(): column for column, name in enumerate(table.names) if column not in taken}
    if of_one_point:
        yield from orientation_lines(table, taken)
    singles = {
        "temperature": (SCALARS["temperature"], "temperature: {{column: {}}}"),
        "payload": (SCALARS["payload"], "payload: {{column: {}}}"),
        "time": (r"(time|zeit|t|timestamp)([\s_.\[(]*s)?[\])]?", "time: {{column: {}, unit: s}}"),
        "target": (r"(target|reflector|smr|point)([\s_]?(id|name|no))?", "target: {{column: {}}}"),
    }
    run = next((column for name, column in small.items() if re.fullmatch(RUNS, name)), None)
    if run is not None and not _all_different(table.values[:, run]):
        yield f"  run: {{column: {quoted(table.names[run])}}}   # guessed by name: of which run each row is"
    for what, (pattern, line) in singles.items():
        match = next((column for name, column in small.items() if re.fullmatch(pattern, name)), None)
        if what == "target" and not of_one_point:
            continue
        if what == "target" and match is not None and number_the_rows([row[match] for row in table.cells]):
            yield f"  # no target: {quoted(printable(table.names[match]))}, which differs from row to row"
            continue
        if match is not None and (what == "target" or np.isfinite(table.values[:, match]).any()):
            yield f"  {line.format(quoted(table.names[match]))}   # guessed by name"
        elif what == "time" and (stamps := _time_stamps(table, taken)):
            yield stamps


def _of_motors(table: ForeignTable, group: str, columns: list[int]) -> str:
    """The line of speeds, torques or sides of approach; torques in another unit than N m are not taken."""
    listed = column_list(table, columns)
    if group == "speed":
        unit, why = unit_of(table, columns, SPEED_UNITS)
        said = why or "unit guessed: rad/s"
        return f"  speed: {{columns: {listed}, unit: {unit or 'rad/s'}}}   # guessed by name; {said}"
    if group == "torque" and unit_of(table, columns, TORQUE_UNITS)[0] == FILL_IN:
        return f"  # torque: {{columns: {listed}}}   # guessed: not taken, the table states another unit than N m"
    say = {"torque": "N m, positive along gravity's pull: check the sign"}
    return f"  {group}: {{columns: {listed}}}   # guessed by name; {say.get(group, '-1, +1')}"


def _all_different(numbers: Array) -> bool:
    """Whether these are numbers that count rows."""
    return bool(np.isfinite(numbers).all()) and len(np.unique(numbers)) == len(numbers)


def _per_motor(table: ForeignTable, n_motors: int, taken: set[int]) -> dict[str, list[int]]:
    found: dict[str, list[int]] = {}
    for word, group in numbered_columns(table).items():
        parts = set(re.findall(r"[^\W\d_]+", word))
        columns = in_a_row(group)
        for name, words in BESIDE.items():
            if parts & set(words) and len(columns) == n_motors and not taken & set(columns):
                found.setdefault(name, columns)
    return found
