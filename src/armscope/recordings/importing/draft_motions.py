"""A draft of mapping.yaml from a foreign table of points or, where it has time and torques or currents, of a motion."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import yaml

from armscope.core.inputs import validate
from armscope.recordings.importing.constants import DRAFT
from armscope.recordings.importing.draft import HEAD, RUNS, SCALARS, draft_mapping, format_lines
from armscope.recordings.importing.draft_columns import (
    BESIDE,
    FILL_IN,
    filled_in,
    in_a_row,
    motor_columns,
    numbered_columns,
    points_of,
    unit_of,
)
from armscope.recordings.importing.first_table import ForeignTable, column_list, first_table, printable, quoted
from armscope.recordings.importing.motions import MotionMapping
from armscope.recordings.importing.stated_units import MOTION_ANGLES, SPEED_UNITS, TORQUE_UNITS
from armscope.recordings.numbered_points import number_the_rows

EFFORTS = {
    "torque": (*BESIDE["torque"], "m", "mom", "drehmoment", "nm"),
    "current": ("current", "curr", "i", "amp", "strom"),
}
"""What columns of torques and currents are called, as far as they are numbered by motor."""
WARMTH = ("temp", "temperature", "temperatur")
TIME = r"(time|zeit|t|timestamp|clock)([\s_.\[(]*(s|ms|sec|seconds))?[\])]?"
TIME_UNITS = {"s": "s", "sec": "s", "seconds": "s", "ms": "ms"}
CURRENT_UNITS = {"a": "A", "amp": "A", "amps": "A", "ampere": "A", "ma": "mA"}
MOTION_RUNS = rf"{RUNS}|bahn|path|trajectory|motion|fahrt"


def draft_any_mapping(path: Path | str) -> str:
    """The text of a mapping.yaml that reads this file, of points or of a motion, with a comment on every guess.
    Raises InputError: it is no text table, or its columns look like neither."""
    path = Path(path)
    table = first_table(path)
    columns = list(_of_a_motion(table))
    if not columns:
        return draft_mapping(path)
    unused = [name for name in table.names if not any(quoted(name) in line for line in columns)]
    lines = [
        HEAD.format(printable(path.name), "motions.csv"),
        "table: motions",
        *format_lines(table),
        "columns:",
        *columns,
    ]
    lines += ["# not used: " + ", ".join(quoted(printable(name)) for name in unused)] if unused else []
    text = "\n".join([*lines, ""])
    validate(MotionMapping, yaml.safe_load(filled_in(text)), path)
    return text


def _of_a_motion(table: ForeignTable) -> Iterator[str]:
    """The groups of a motion's mapping; none where the table has points, or lacks time, angles or efforts."""
    angles = motor_columns(table) if table.header else []
    names = {name.strip().lower(): column for column, name in enumerate(table.names)}
    time = _called(names, TIME)
    efforts = {name: columns for name, words in EFFORTS.items() if (columns := _beside(table, words, angles))}
    if not angles or time is None or not efforts or points_of(table, taken=angles):
        return
    step = float(np.nanmedian(np.diff(table.values[:, time]))) if len(table.values) > 1 else 0.0
    stated, why = unit_of(table, [time], TIME_UNITS)
    why = why or f"guessed: samples are {step:.3g} apart"
    unit = stated or ("s" if step <= DRAFT.seconds_up_to else "ms")
    yield f"  time: {{column: {quoted(table.names[time])}, unit: {unit}}}   # {why}"
    numbers = table.values[:, angles]
    largest = float(np.nanmax(np.abs(numbers))) if np.isfinite(numbers).any() else 0.0
    stated, why = unit_of(table, angles, MOTION_ANGLES)
    why = why or f"guessed: none is beyond {largest:.4g}"
    unit = stated or ("rad" if largest <= DRAFT.radians_up_to else "deg")
    listed = column_list(table, angles)
    yield f"  positions: {{columns: {listed}, unit: {unit}}}   # {why}; columns by likeness of names"
    speeds = _beside(table, BESIDE["speed"], angles)
    if speeds:
        of_speed, why = unit_of(table, speeds, SPEED_UNITS)
        of_speed = of_speed or ("rad/s" if unit == FILL_IN else f"{unit}/s")
        listed = column_list(table, speeds)
        yield f"  speeds: {{columns: {listed}, unit: {of_speed}}}   # guessed by name; {why or 'its unit is guessed'}"
    yield _efforts(table, *next(iter(efforts.items())))
    if warm := _beside(table, WARMTH, angles):
        yield f"  temperatures: {{columns: {column_list(table, warm)}}}   # guessed by name: degrees Celsius"
    run = _called(names, MOTION_RUNS)
    if run is not None and not number_the_rows([row[run] for row in table.cells]):
        yield f"  run: {{column: {quoted(table.names[run])}}}   # guessed by name: of which motion each row is"
    for group, pattern in SCALARS.items():
        if group == "temperature" and warm:
            continue
        if (column := _called(names, pattern)) is not None and np.isfinite(table.values[:, column]).any():
            yield f"  {group}: {{column: {quoted(table.names[column])}}}   # guessed by name"


def _efforts(table: ForeignTable, kind: str, columns: list[int]) -> str:
    """The line of torques or currents; where the table states another unit, with a scale that is left open."""
    known = TORQUE_UNITS if kind == "torque" else CURRENT_UNITS
    unit, why = unit_of(table, columns, known)
    say = {"torque": "N m; positive along the motion that it drives: check the sign", "current": "A; else say scale"}
    listed, scale, said = column_list(table, columns), "", f"guessed by name: {say[kind]}"
    if unit == FILL_IN:
        scale, said = f", scale: {FILL_IN}", f"{why}: what to multiply by"
    elif unit == "mA":
        scale, said = ", scale: 0.001", f"{why}: mA"
    return f"  {kind}: {{columns: {listed}{scale}}}   # {said}"


def _called(names: dict[str, int], pattern: str) -> int | None:
    return next((column for name, column in names.items() if re.fullmatch(pattern, name)), None)


def _beside(table: ForeignTable, words: tuple[str, ...], angles: list[int]) -> list[int]:
    """The columns of these words that are numbered by motor, beside the angles; none where there are others."""
    for word, group in numbered_columns(table).items():
        columns = in_a_row(group)
        parts = set(re.split(r"[^a-z]+", word))
        if parts & set(words) and len(columns) == len(angles) and not set(columns) & set(angles):
            return columns
    return []
