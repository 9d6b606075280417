"""What effects follow that a table may hold beside angles: approach, speed, temperature, time, rows, runs, targets.

A driver is zero where it was not recorded, so that a missing value neither helps nor hurts.
"""

from __future__ import annotations

import numpy as np

from armscope.core.inputs import InputError
from armscope.core.types import Array
from armscope.physics.loaded_arm import LoadedArm
from armscope.physics.terms import DriverKind

REFERENCE_TEMPERATURE_C = 20.0
"""Lengths hold at this temperature."""
SECONDS_PER_HOUR = 3600.0
ROWS_PER_UNIT = 1000.0
COLUMNS = {
    "payload": "payload_kg",
    "temperature": "temperature_c",
    "time": "time_s",
    "approach": "approach",
    "speed": "dq_rad_s",
}
"""Context: field of the recordings, and the column (one per motor for the last two) that it comes from."""


def recorded(scene: LoadedArm, context: str, motor: int = 0) -> Array:
    """A context field of the scene's recordings ("temperature", ...), or one motor's column of it, NaN where unknown.

    Args:
        scene: N rows.
        context: name of the field.
        motor: its number, from 1, where the field has a column per motor; 0 for the field as it is.

    Returns:
        (N,) in the field's unit.

    Raises:
        InputError: it was not recorded.
    """
    values: Array | None = getattr(scene.recordings, context)
    if values is not None:
        return values[:, motor - 1] if motor else values
    column = COLUMNS[context].replace("dq_", f"dq{motor or ''}_")
    raise InputError(
        scene.recordings.source,
        "line 1",
        f"no column {column}{motor if motor and column == context else ''}",
        "an effect in the model follows this column",
        "Add it to the table.",
    )


def side_of_approach(scene: LoadedArm, j: int) -> Array:
    """(N,) side from which motor j came, -1 or 1; 0 where it was not recorded."""
    return np.nan_to_num(recorded(scene, "approach", j))


def _speed(scene: LoadedArm, j: int) -> Array:
    return np.nan_to_num(recorded(scene, "speed", j))


def _carrying(scene: LoadedArm) -> Array:
    """1 where a payload is stated, 0 where none is carried, or nobody knows."""
    return np.asarray(np.nan_to_num(recorded(scene, "payload")) > 0, dtype=np.float64)


def _warmth(scene: LoadedArm) -> Array:
    """Temperature above the reference, K."""
    return np.nan_to_num(recorded(scene, "temperature") - REFERENCE_TEMPERATURE_C)


def _hours(scene: LoadedArm, start: float) -> Array:
    """Hours since ``start`` (s)."""
    return np.nan_to_num((recorded(scene, "time") - start) / SECONDS_PER_HOUR)


def _rows(scene: LoadedArm) -> Array:
    """Thousands of rows since the table's beginning."""
    return np.nan_to_num(scene.recordings.number / ROWS_PER_UNIT)


def _after_time(scene: LoadedArm, start: float, run: str, *later: str) -> Array:
    """From a time of a run on, and in later runs."""
    return np.where(_in_run(scene, run), recorded(scene, "time") >= start, _in_run(scene, *later))


def _after_row(scene: LoadedArm, first_row: float, run: str, *later: str) -> Array:
    """From a row of a run on, and in later runs, and now; counted as `Recordings.number` says."""
    before = scene.recordings.number < first_row
    return np.where(_in_run(scene, run), ~before, _in_run(scene, *later))


def _in_run(scene: LoadedArm, *runs: str) -> Array:
    return np.asarray(np.isin(scene.recordings.run, runs))


def _after_pause(scene: LoadedArm, first_row: float, run: str, *later: str) -> Array:
    """What a pause adds to what follows the order of rows; like that, zero where a row's number is not known."""
    return np.where(np.isnan(scene.recordings.number), 0.0, _after_row(scene, first_row, run, *later))


def _rows_in_run(scene: LoadedArm, *runs: str) -> Array:
    """In a run, what belongs to a wave in the order of rows; like that, zero where a row's number is not known."""
    return np.where(np.isnan(scene.recordings.number), 0.0, _in_run(scene, *runs))


def _now_in_run(scene: LoadedArm, *runs: str) -> Array:
    """In a run, where a row's number is not known: how the last row left what follows the order of rows."""
    return np.where(np.isnan(scene.recordings.number), _in_run(scene, *runs), 0.0)


def _slow_wave(scene: LoadedArm, waves: int, first: float, last: float) -> Array:
    """Cosine of so many half waves from the first time (s) to the last, standing still before and after.

    Where no time is given, it is now: as the recording's end left it.
    """
    time = np.full(len(scene), np.nan) if scene.recordings.time is None else scene.recordings.time
    return _half_waves(np.where(np.isnan(time), last, time), waves, first, last)


def _slow_wave_of_rows(scene: LoadedArm, waves: int, first: float, last: float) -> Array:
    """The same along the order of rows."""
    return np.nan_to_num(_half_waves(scene.recordings.number, waves, first, last))


def _half_waves(at: Array, waves: int, first: float, last: float) -> Array:
    along = np.clip((at - first) / max(last - first, 1e-9), 0.0, 1.0)
    return np.asarray(np.cos(np.pi * waves * along))


def _on_target(scene: LoadedArm, target: str) -> Array:
    return np.asarray(scene.recordings.target == target)


def _on_target_in_run(scene: LoadedArm, target: str, run: str) -> Array:
    return np.asarray((scene.recordings.target == target) & (scene.recordings.run == run))


_RUN = frozenset({"run"})

RECORDED: dict[str, DriverKind] = {
    "approach": DriverKind(side_of_approach, needs="approach"),
    "speed": DriverKind(_speed, needs="speed"),
    "carrying": DriverKind(_carrying, needs="payload", follows=frozenset({"payload"})),
    "warmth": DriverKind(_warmth, needs="temperature", follows=_RUN, unit="K above 20 C"),
    "hours": DriverKind(_hours, needs="time", follows=_RUN, unit="h"),
    "rows": DriverKind(_rows, follows=_RUN),
    "after time": DriverKind(_after_time, needs="time", follows=_RUN),
    "after row": DriverKind(_after_row, follows=_RUN),
    "after pause": DriverKind(_after_pause, follows=_RUN),
    "in run": DriverKind(_in_run, follows=_RUN),
    "during run": DriverKind(_in_run, follows=_RUN),  # the same, of what is no free frame
    "rows in run": DriverKind(_rows_in_run, follows=_RUN),
    "now in run": DriverKind(_now_in_run, follows=_RUN),
    "slow wave": DriverKind(_slow_wave, follows=_RUN),
    "slow wave of rows": DriverKind(_slow_wave_of_rows, follows=_RUN),
    "on target": DriverKind(_on_target),
    "on target in run": DriverKind(_on_target_in_run),
}
"""Kinds of drivers by name."""
