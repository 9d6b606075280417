"""Cells of a motion that were left empty: the same run says what stands there, and that is told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from armscope.core.types import Array


def payload_held(payload: Array, run: NDArray[np.str_]) -> tuple[Array, list[str]]:
    """Payloads (N,), kg, of rows in runs (N,), each held until the next one of its run; and what a user should know.

    Before the first that a run has, that one holds. NaN stays in runs that have none.
    """
    found, held, unknown = payload.copy(), 0, []
    for name in dict.fromkeys(run.tolist()):
        rows = np.flatnonzero(run == name)
        stated = np.isfinite(payload[rows])
        if not stated.any():
            unknown.append(name)
            continue
        last = np.maximum.accumulate(np.where(stated, np.arange(len(rows)), int(np.argmax(stated))))
        found[rows] = payload[rows[last]]
        held += int(np.sum(~stated))
    notes = []
    if held:
        notes.append(f"payload_kg is empty in {held} rows: the value before it in the same run was taken to hold")
    if unknown:
        notes.append(
            f"payload_kg is empty in {_named(unknown)}: what the arm carries there is not known. It is taken to carry "
            "nothing, and a load that its motion shows is told as more than stated"
        )
    return found, notes


def temperature_between(temperature: Array, time: Array, run: NDArray[np.str_]) -> tuple[Array, list[str]]:
    """Temperatures with those between recorded ones of the same run, and what a user should know.

    Args:
        temperature: (N, m) deg C; NaN where not recorded.
        time: (N,) s.
        run: (N,) of each row.

    Returns:
        (N, m), NaN only of runs in which none was recorded, and sentences.
    """
    found, unknown = temperature.copy(), []
    for name in dict.fromkeys(run.tolist()):
        rows = np.flatnonzero(run == name)
        for own in range(temperature.shape[1]):
            values = temperature[rows, own]
            there = np.isfinite(values)
            if there.any() and not there.all():
                found[rows, own] = np.interp(time[rows], time[rows][there], values[there])
            elif not there.any() and name not in unknown:
                unknown.append(name)
    filled, notes = int(np.sum((np.isnan(temperature) & np.isfinite(found)).any(axis=1))), []
    if filled:
        notes.append(f"temperature is empty in {filled} rows: it was interpolated within their runs")
    if unknown:
        notes.append(f"temperature is empty in {_named(unknown)}: nothing that follows it can be told of this table")
    return found, notes


def _named(runs: Sequence[str]) -> str:
    """Runs as a sentence has them; without names, the table is one."""
    return f"run{'s' if len(runs) > 1 else ''} {', '.join(runs)}" if all(runs) else "the table"
